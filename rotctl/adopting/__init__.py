"""Humanoids of others as characters: ``adopt``."""

from rotctl.adopting.adoption import Adopted, adopt

__all__ = ["Adopted", "adopt"]
