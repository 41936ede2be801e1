"""What tasks aim at: named feedback laws of the state, a closed set.

An aim fills a task's target, velocity and acceleration at one instant; which kinds of task it
serves stands in its docstring.
"""

from math import atan2
from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import support
from rotctl.behaviours.scene import Scene
from rotctl.control.task import Tasks
from rotctl.mechanics import excursion
from rotctl.mechanics.model import Model, body_ids
from rotctl.rotations import dot
from rotctl.settings import STRICT, NonNegative, Positive

UP = np.array([0.0, 0.0, 1.0])


@validated(frozen=True, config=STRICT)
class Hold:
    """Stay as at the begin of the stage: every kind but limits."""

    law: Literal["hold"]

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

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
class Upright:
    """A body stands as in the zero pose, heading along forward: attitude."""

    law: Literal["upright"]

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        forward = scene.axes[0]
        half = 0.5 * atan2(forward[1], forward[0])
        task["target"] = [np.cos(half), 0.0, 0.0, np.sin(half)]


@validated(frozen=True, config=STRICT)
class Turn:
    """Turn to the behaviour's target excursion about left, and keep to that axis: spin.

    Attributes:
        most: of what is missing, that the spring is given at once [rad].
    """

    law: Literal["turn"]
    most: Positive

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        left = scene.axes[1]
        missing = scene.target - scene.turned
        across = _missing(scene, scene.first.angle)
        task["target"][:3] = (
            across - dot(left, across) * left + min(max(missing, -self.most), self.most) * left
        )


@validated(frozen=True, config=STRICT)
class Capture:
    """Keep the capture point over the bodies that stand, and a height: linear.

    The centre of pressure that would bring the capture point back to the middle of the support is
    brought into the support, and the centre of mass accelerates away from it.

    Attributes:
        bodies: that stand.
        gain: of the centre of pressure beyond the capture point, towards where that is [-].
        margin: inside the support that the pressure keeps [m].
        height: of the centre of mass over the ground [m].
    """

    law: Literal["capture"]
    bodies: tuple[str, ...]
    gain: NonNegative
    margin: NonNegative
    height: Positive

    def check(self, model: Model) -> None:
        """Raises InputError for a body that is not there."""
        body_ids(model.mj, self.bodies, "behaviour.stages.tasks.bodies")

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set target and acceleration."""
        model, state = scene.model, scene.state
        standing = body_ids(model.mj, self.bodies, "behaviour.stages.tasks.bodies")
        corners = support.hull(support.ends(model, state, standing))
        rate = support.pendulum_rate(model, state)
        x, y = support.capture_point(state, rate)
        cx, cy = support.middle(corners)
        beyond = (x + self.gain * (x - cx), y + self.gain * (y - cy))
        pressed = support.nearest(beyond, support.shrunk(corners, self.margin))
        task["acceleration"] = support.centre_of_pressure(state, rate, pressed)
        c = state.momentum.com
        level = model.ground.height(float(c[0]), float(c[1]))
        task["target"][:3] = [c[0], c[1], level + self.height]


Aim = Annotated[Hold | Upright | Turn | Capture, Field(discriminator="law")]


def _missing(scene: Scene, angle: np.ndarray) -> np.ndarray:
    return excursion.error(scene.excursion, angle, scene.axes[1], scene.measure)
