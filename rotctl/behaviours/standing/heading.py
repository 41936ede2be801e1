"""How a foot is turned that swings."""

from math import atan2
from typing import Literal

from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.named_bodies import NamesNothing
from rotctl.behaviours.scene import Scene
from rotctl.behaviours.support import FACING, Facing
from rotctl.control.task import Tasks
from rotctl.maths.rotations import about_up
from rotctl.mechanics.bodies import ROOT_BODY
from rotctl.settings.fields import STRICT


@validated(frozen=True, config=STRICT)
class Heading(NamesNothing):
    """Turn a foot that swings to where the pelvis faces; no weight for others: attitude.

    Attributes:
        facing: as for `step`.
    """

    law: Literal["heading"]
    facing: Facing = "front"

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        x, y = FACING[self.facing](scene.state, ROOT_BODY)
        task["target"] = about_up(atan2(y, x))
        if scene.step.swing != int(task["body"]):
            task["weight"] = 0.0
