"""Objectives, the optimisation in its two forms, the contact supervisor."""

from rotctl.control.controller import Controller
from rotctl.control.decision import Decision
from rotctl.control.settings import ControllerSettings
from rotctl.control.targets import Desired

__all__ = ["Controller", "ControllerSettings", "Decision", "Desired"]
