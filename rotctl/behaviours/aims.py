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
from rotctl.behaviours.launch import Launch, Lean, Whirl
from rotctl.behaviours.scene import Scene
from rotctl.behaviours.stepping import Heading, Stepping
from rotctl.behaviours.support import Point
from rotctl.control.task import Tasks
from rotctl.errors import InputError
from rotctl.linear import solve
from rotctl.mechanics import excursion
from rotctl.mechanics.model import Model, body_ids
from rotctl.rotations import about_up, advance, advanced, dot, rotation_between
from rotctl.settings import STRICT, Finite, NonNegative, Positive

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
class Plane:
    """A body turns in the plane across left, as far as it likes: attitude."""

    law: Literal["plane"]

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target: the present attitude, less what turns its left away."""
        body, left = int(task["body"]), scene.axes[1]
        side = scene.state.data.xmat[body].reshape(3, 3)[:, 1]
        task["target"] = advanced(
            scene.state.data.xquat[body].tolist(), rotation_between(side.tolist(), left.tolist())
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

    The centre of pressure goes beyond the capture point, as seen from the middle of the support,
    as far as the support goes, and the centre of mass accelerates away from it. Where the capture
    point leaves the support, the trunk and the arms are thrown after it (`Lunge`), which for a
    while acts like pressure from beyond the feet.

    Attributes:
        bodies: that stand.
        gain: of the centre of pressure beyond the capture point [-].
        margin: inside the support that the pressure keeps [m].
        height: of the centre of mass over the furthest of the bodies, along the leg [m].
        sink: below that, which keeps the knees from their stops [m].
        lunge: pressure from beyond the feet, as a multiple of how far the capture point is out [-];
            0 throws nothing.
        lunge_margin: inside the support, from which it counts as out [m].
        lunge_most: furthest pressure from beyond the feet [m].
        rise: fastest up to that height [m/s], so that nobody leaps from a crouch; 0 sets no limit.
    """

    law: Literal["capture"]
    bodies: tuple[str, ...]
    gain: NonNegative
    margin: NonNegative
    height: Positive
    sink: NonNegative
    lunge: NonNegative = 0.0
    lunge_margin: NonNegative = 0.0
    lunge_most: NonNegative = 0.0
    rise: NonNegative = 0.0

    def check(self, model: Model) -> None:
        """Raises InputError for a body that is not there."""
        body_ids(model.mj, self.bodies, "behaviour.stages.tasks.bodies")

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set target and acceleration."""
        model, state = scene.model, scene.state
        feet, corners, (mx, my) = self._support(scene)
        rate = support.pendulum_rate(model, state)
        x, y = support.capture_point(state, rate)
        reach = 1.0 + self.gain
        wish = (mx + reach * (x - mx), my + reach * (y - my))
        px, py = support.within(corners, (mx, my), wish, self.margin)
        ex, ey = self.beyond(scene)
        cx, cy, cz = state.momentum.com.tolist()
        task["acceleration"] = [rate * rate * (cx - px - ex), rate * rate * (cy - py - ey), 0.0]
        aside = max((cx - fx) ** 2 + (cy - fy) ** 2 for fx, fy in feet)
        up = sqrt(max(self.height**2 - aside, 0.0))
        goal = model.ground.height(cx, cy) + up - self.sink
        if self.rise:  # so far ahead the spring's pull and the damping are equal at that speed
            goal = min(goal, cz + self.rise * float(task["damping"][2] / task["stiffness"][2]))
        task["target"][:3] = [cx, cy, goal]

    def beyond(self, scene: Scene) -> tuple[float, float]:
        """How far beyond the feet pressure is wanted [m]."""
        _, corners, middle = self._support(scene)
        rate = support.pendulum_rate(scene.model, scene.state)
        x, y = support.capture_point(scene.state, rate)
        ix, iy = support.within(corners, middle, (x, y), self.lunge_margin)
        ex, ey = self.lunge * (x - ix), self.lunge * (y - iy)
        far = sqrt(ex * ex + ey * ey)
        share = min(1.0, self.lunge_most / far) if far > 0.0 else 0.0
        return share * ex, share * ey

    def _support(self, scene: Scene) -> tuple[list[Point], list[Point], Point]:
        """Middles of the bodies, corners of the hull of those on the ground, and its middle."""
        model, state = scene.model, scene.state
        bodies = body_ids(model.mj, self.bodies, "behaviour.stages.tasks.bodies")
        bodies = [body for body in bodies if body != scene.step.swing]
        stand = [body for body in bodies if not support.lifted(model, state, body)]
        ends = support.ends(model, state.data, stand or bodies)
        middles = [support.middle(support.ends(model, state.data, (body,))) for body in bodies]
        return middles, support.hull(ends), support.middle(ends)


@validated(frozen=True, config=STRICT)
class Lunge:
    """The whole body's spin that pressure from beyond the feet stands for: spin.

    Attributes:
        task: whose aim is `capture`.
        fade: pressure so far beyond the feet switches the damping of the spin off [m].
    """

    law: Literal["lunge"]
    task: str
    fade: Positive

    def check(self, model: Model) -> None:
        """Nothing can be wrong."""

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set velocity and acceleration."""
        capture = scene.aims.get(self.task)
        if not isinstance(capture, Capture):
            raise InputError(f"behaviour: the aim lunge is for a task {self.task!r} that captures")
        momentum, gravity = scene.state.momentum, -float(scene.model.gravity[2])
        ex, ey = capture.beyond(scene)
        share = min(1.0, sqrt(ex * ex + ey * ey) / self.fade)
        weight = scene.model.mass * gravity
        task["velocity"] = share * momentum.angular_velocity
        task["acceleration"] = solve(momentum.inertia, np.array([-weight * ey, weight * ex, 0.0]))


Aim = Annotated[
    Hold
    | Upright
    | Bow
    | Plane
    | Watch
    | Pose
    | Ground
    | Turn
    | Capture
    | Lunge
    | Stepping
    | Heading
    | Lean
    | Launch
    | Whirl,
    Field(discriminator="law"),
]

SERVES: dict[type, tuple[str, ...]] = {
    Hold: ("linear", "spin", "point", "attitude"),
    Upright: ("attitude",),
    Ground: ("point",),
    Turn: ("spin",),
    Capture: ("linear",),
    Lunge: ("spin",),
    Stepping: ("point",),
    Heading: ("attitude",),
    Bow: ("attitude",),
    Plane: ("attitude",),
    Watch: ("point",),
    Pose: ("joints",),
    Lean: ("linear",),
    Launch: ("linear",),
    Whirl: ("spin",),
}
"""Kinds of task that an aim is for."""


def _missing(scene: Scene, angle: np.ndarray) -> np.ndarray:
    return excursion.error(scene.excursion, angle, scene.axes[1], scene.measure)
