"""Humanoids of others as characters: ``adopt``."""

from rotctl.adopting.character import Adopted, adopt

__all__ = ["Adopted", "adopt"]
