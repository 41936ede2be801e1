"""What tasks aim at: named feedback laws of the state, a closed set.

An aim fills a task's target, velocity and acceleration at one instant; which kinds of task it
serves stands in its docstring, and in `SERVES`.
"""

from math import atan2, radians, sqrt
from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import support
from rotctl.behaviours.balance import Capture, Lunge
from rotctl.behaviours.launch import Launch, Lean, Whirl
from rotctl.behaviours.poising import Poise, Shift
from rotctl.behaviours.scene import Scene
from rotctl.behaviours.stepping import Heading, Stepping
from rotctl.behaviours.wheeling import Carry, Place, Stride
from rotctl.control.task import Tasks
from rotctl.mechanics import excursion
from rotctl.mechanics.model import Model, body_ids
from rotctl.rotations import about_up, advance, advanced, dot, rotation_between
from rotctl.settings import STRICT, Finite, Fraction, NonNegative, Positive

UP = np.array([0.0, 0.0, 1.0])


@validated(frozen=True, config=STRICT)
class Hold:
    """Stay as at the begin of the stage: linear, spin, point, attitude."""

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
    """A body's up is the world's, whatever its turn about it: attitude."""

    law: Literal["upright"]

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        w, _, _, z = scene.state.data.xquat[int(task["body"])].tolist()
        length = sqrt(w * w + z * z) or 1.0
        task["target"] = [w / length, 0.0, 0.0, z / length]


@validated(frozen=True, config=STRICT)
class Bow:
    """A body faces the way, and bows to it: attitude.

    Attributes:
        angle: from upright about left [deg].
    """

    law: Literal["bow"]
    angle: Finite

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        forward, left, _ = scene.axes
        facing = about_up(atan2(float(forward[1]), float(forward[0])))
        task["target"] = advance(facing, radians(self.angle) * left)


@validated(frozen=True, config=STRICT)
class Face:
    """A body is upright and faces where a turn about up has brought it: attitude.

    Attributes:
        share: of the behaviour's target [-].
    """

    law: Literal["face"]
    share: Fraction

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        forward = scene.axes[0]
        turned = self.share * scene.target
        task["target"] = about_up(atan2(float(forward[1]), float(forward[0])) + turned)


@validated(frozen=True, config=STRICT)
class Plane:
    """A body turns in its plane, as far as it likes: attitude.

    The plane lies across left, or across forward where the behaviour turns about that.
    """

    law: Literal["plane"]

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target: the present attitude, less what turns its axis away."""
        body, column = int(task["body"]), 0 if np.array_equal(scene.turning, scene.axes[0]) else 1
        side = scene.state.data.xmat[body].reshape(3, 3)[:, column]
        across = scene.axes[column]
        task["target"] = advanced(
            scene.state.data.xquat[body].tolist(), rotation_between(side.tolist(), across.tolist())
        )


@validated(frozen=True, config=STRICT)
class Watch:
    """Nothing is wanted: the log's error is the way from the point to the centre of mass: point."""

    law: Literal["watch"]

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target, and no weight."""
        task["target"][:3] = scene.state.momentum.com
        task["weight"] = 0.0


@validated(frozen=True, config=STRICT)
class Pose:
    """A body's joints as the stage's pose has them, and as fast as it has them move: joints."""

    law: Literal["pose"]

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set target and velocity."""
        first, count = scene.model.hinges(int(task["body"]))
        task["target"][:count] = scene.pose[first : first + count]
        task["velocity"][:count] = scene.speed[first : first + count]


@validated(frozen=True, config=STRICT)
class Ground:
    """A point that has left the ground is brought back to it: point.

    Attributes:
        height: of the point above the ground when its body stands [m].
    """

    law: Literal["ground"]
    height: NonNegative

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target; a body that stands has no weight here, its contacts hold it."""
        body = int(task["body"])
        x, y, _ = scene.state.data.xpos[body].tolist()
        task["target"][:3] = [x, y, scene.model.ground.height(x, y) + self.height]
        if body == scene.step.swing or body in scene.state.contacts.body.tolist():
            task["weight"] = 0.0


@validated(frozen=True, config=STRICT)
class Above:
    """The centre of mass comes over the middle of bodies that may bear nothing yet: linear.

    Attributes:
        bodies: seen from above; a name without a side stands for both sides.
        ahead: of their middle, along the way [m].
        height: over the ground [m].
        most: of what is missing, that the spring is given at once [m].
    """

    law: Literal["above"]
    bodies: tuple[str, ...]
    height: Positive
    most: Positive
    ahead: Finite = 0.0

    def check(self, model: Model) -> None:
        """Raises InputError for a body that is not there."""
        body_ids(model.mj, self.bodies, "behaviour.stages.tasks.bodies")

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        model, state, com = scene.model, scene.state, scene.state.momentum.com
        bodies = body_ids(model.mj, self.bodies, "behaviour.stages.tasks.bodies")
        x, y = support.middle(support.ends(model, state.data, bodies))
        missing = np.array([x, y, scene.floor + self.height]) + self.ahead * scene.axes[0] - com
        far = sqrt(dot(missing, missing))
        task["target"][:3] = com + min(1.0, self.most / far if far else 1.0) * missing


@validated(frozen=True, config=STRICT)
class Opposite:
    """A point is put on the ground where the capture point lies between it and a body: point.

    A foot that comes down there leaves nothing to tip the body to a side of the line from the one
    support to the other, however narrow both are.

    Attributes:
        body: the other support.
        ahead: of the capture point, as seen from that body [m].
        height: of the point above the ground when its body stands [m].
    """

    law: Literal["opposite"]
    body: str
    ahead: NonNegative
    height: NonNegative

    def check(self, model: Model) -> None:
        """Raises InputError for a body that is not there."""
        body_ids(model.mj, [self.body], "behaviour.stages.tasks.body")

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        model, state = scene.model, scene.state
        other = body_ids(model.mj, [self.body], "behaviour.stages.tasks.body")
        ox, oy = support.middle(support.ends(model, state.data, other))
        x, y = support.capture_point(state, support.pendulum_rate(model, state))
        far = sqrt((x - ox) ** 2 + (y - oy) ** 2)
        share = self.ahead / far if far else 0.0
        px, py = x + share * (x - ox), y + share * (y - oy)
        task["target"][:3] = [px, py, model.ground.height(px, py) + self.height]


@validated(frozen=True, config=STRICT)
class Turn:
    """Turn to the behaviour's target excursion, and keep to its axis: spin.

    Attributes:
        most: of what is missing, that the spring is given at once [rad].
    """

    law: Literal["turn"]
    most: Positive

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

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
    | Shift
    | Carry
    | Place
    | Stride,
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
    Shift: ("linear",),
    Carry: ("linear",),
    Place: ("point",),
    Stride: ("point",),
}
"""Kinds of task that an aim is for."""


def _missing(scene: Scene, angle: np.ndarray) -> np.ndarray:
    return excursion.error(scene.excursion, angle, scene.turning, scene.measure)
