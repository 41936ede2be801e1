"""Objectives, the optimisation in its two forms, the contact supervisor."""

from rotctl.control.controller import Controller
from rotctl.control.decision import Decision
from rotctl.control.settings import ControllerSettings
from rotctl.control.task import Command

__all__ = ["Command", "Controller", "ControllerSettings", "Decision"]
