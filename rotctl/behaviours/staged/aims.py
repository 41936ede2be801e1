"""What tasks aim at: named feedback laws of the state, a closed set.

An aim fills a task's target, velocity and acceleration at one instant; which kinds of task it
serves stands in its docstring, and in `SERVES`.
"""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.aerial.launch import Launch, Lean, Whirl
from rotctl.behaviours.named_bodies import NamesNothing
from rotctl.behaviours.scene import Scene
from rotctl.behaviours.staged.attitudes import Bow, Face, Plane, Upright
from rotctl.behaviours.staged.placing import Above, Ground, Opposite, Watch
from rotctl.behaviours.standing.balance import Capture, Lunge
from rotctl.behaviours.standing.gathering import Beside
from rotctl.behaviours.standing.heading import Heading
from rotctl.behaviours.standing.pivoting import Bring
from rotctl.behaviours.standing.poising import Poise, Shift
from rotctl.behaviours.standing.stepping import Stepping
from rotctl.behaviours.standing.wheeling import Carry, Place, Stride
from rotctl.control.task import Tasks
from rotctl.maths.rotations import dot
from rotctl.mechanics import excursion
from rotctl.settings.fields import STRICT, Positive

UP = np.array([0.0, 0.0, 1.0])


@validated(frozen=True, config=STRICT)
class Hold(NamesNothing):
    """Stay as at the begin of the stage: linear, spin, point, attitude."""

    law: Literal["hold"]

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        body = int(task["body"])
        if kind == "linear":
            task["target"][:3] = scene.begin.com
        elif kind == "spin":
            task["target"][:3] = _missing(scene, scene.begin.excursion.angle)
        elif kind == "attitude":
            task["target"] = scene.begin.orientation[body]
        else:
            task["target"][:3] = scene.begin.place[body]


@validated(frozen=True, config=STRICT)
class Pose(NamesNothing):
    """A body's joints as the stage's pose has them, and as fast as it has them move: joints."""

    law: Literal["pose"]

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set target and velocity."""
        first, count = scene.model.hinges(int(task["body"]))
        task["target"][:count] = scene.pose[first : first + count]
        task["velocity"][:count] = scene.speed[first : first + count]


@validated(frozen=True, config=STRICT)
class Turn(NamesNothing):
    """Turn to the behaviour's target excursion, and keep to its axis: spin.

    Attributes:
        most: of what is missing, that the spring is given at once [rad].
    """

    law: Literal["turn"]
    most: Positive

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        about = scene.turning
        missing = scene.target - scene.turned
        across = _missing(scene, scene.first.angle)
        task["target"][:3] = (
            across - dot(about, across) * about + min(max(missing, -self.most), self.most) * about
        )


Aim = Annotated[
    Hold
    | Upright
    | Bow
    | Face
    | Plane
    | Watch
    | Pose
    | Ground
    | Turn
    | Above
    | Opposite
    | Capture
    | Lunge
    | Stepping
    | Heading
    | Lean
    | Launch
    | Whirl
    | Poise
    | Bring
    | Shift
    | Carry
    | Place
    | Stride
    | Beside,
    Field(discriminator="law"),
]

SERVES: dict[type, tuple[str, ...]] = {
    Hold: ("linear", "spin", "point", "attitude"),
    Upright: ("attitude",),
    Ground: ("point",),
    Turn: ("spin",),
    Above: ("linear",),
    Opposite: ("point",),
    Capture: ("linear",),
    Lunge: ("spin",),
    Stepping: ("point",),
    Heading: ("attitude",),
    Bow: ("attitude",),
    Face: ("attitude",),
    Plane: ("attitude",),
    Watch: ("point",),
    Pose: ("joints",),
    Lean: ("linear",),
    Launch: ("linear",),
    Whirl: ("spin",),
    Poise: ("linear",),
    Bring: ("linear",),
    Shift: ("linear",),
    Carry: ("linear",),
    Place: ("point",),
    Stride: ("point",),
    Beside: ("point",),
}
"""Kinds of task that an aim is for."""


def _missing(scene: Scene, angle: np.ndarray) -> np.ndarray:
    return excursion.error(scene.excursion, angle, scene.turning, scene.measure)
