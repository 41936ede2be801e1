"""Aims of balance: the capture point over what stands, and the trunk thrown beyond that."""

from math import sqrt
from typing import Literal

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import support
from rotctl.behaviours.named_bodies import NamesBodies, NamesNothing
from rotctl.behaviours.scene import Scene
from rotctl.behaviours.support import Point
from rotctl.control.task import Tasks
from rotctl.maths.linear import solve
from rotctl.mechanics.bodies import body_ids
from rotctl.settings.fields import STRICT, NonNegative, Positive, SomeNames


@validated(frozen=True, config=STRICT)
class Capture(NamesBodies):
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
    bodies: SomeNames
    gain: NonNegative
    margin: NonNegative
    height: Positive
    sink: NonNegative
    lunge: NonNegative = 0.0
    lunge_margin: NonNegative = 0.0
    lunge_most: NonNegative = 0.0
    rise: NonNegative = 0.0

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set target and acceleration."""
        model, state = scene.model, scene.state
        bodies, corners, (mx, my) = self._support(scene)
        rate = support.pendulum_rate(model, state)
        x, y = support.capture_point(state, rate)
        reach = 1.0 + self.gain
        wish = (mx + reach * (x - mx), my + reach * (y - my))
        px, py = support.within(corners, (mx, my), wish, self.margin)
        ex, ey = self._beyond(corners, (mx, my), (x, y))
        cx, cy, cz = state.momentum.com.tolist()
        task["acceleration"] = [rate * rate * (cx - px - ex), rate * rate * (cy - py - ey), 0.0]
        feet = [support.middle(support.ends(model, state.data, (body,))) for body in bodies]
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
        return self._beyond(corners, middle, support.capture_point(scene.state, rate))

    def _beyond(self, corners: list[Point], middle: Point, point: Point) -> tuple[float, float]:
        """The same of a capture point."""
        x, y = point
        ix, iy = support.within(corners, middle, (x, y), self.lunge_margin)
        ex, ey = self.lunge * (x - ix), self.lunge * (y - iy)
        far = sqrt(ex * ex + ey * ey)
        share = min(1.0, self.lunge_most / far) if far > 0.0 else 0.0
        return share * ex, share * ey

    def _support(self, scene: Scene) -> tuple[list[int], list[Point], Point]:
        """The bodies that do not swing, hull of those on the ground, and its middle."""
        model, state = scene.model, scene.state
        bodies = body_ids(model.mj, self.bodies)
        bodies = [body for body in bodies if body != scene.step.swing]
        stand = [body for body in bodies if not support.lifted(model, state, body)]
        ends = support.ends(model, state.data, stand or bodies)
        return bodies, support.hull(ends), support.middle(ends)


@validated(frozen=True, config=STRICT)
class Lunge(NamesNothing):
    """The whole body's spin that pressure from beyond the feet stands for: spin.

    Attributes:
        task: whose aim is `capture`.
        fade: pressure so far beyond the feet switches the damping of the spin off [m].
    """

    law: Literal["lunge"]
    task: str
    fade: Positive

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set velocity and acceleration."""
        capture = scene.aims[self.task]
        assert isinstance(capture, Capture)  # see `staged.named_tasks`
        momentum, gravity = scene.state.momentum, -float(scene.model.gravity[2])
        ex, ey = capture.beyond(scene)
        share = min(1.0, sqrt(ex * ex + ey * ey) / self.fade)
        weight = scene.model.mass * gravity
        task["velocity"] = share * momentum.angular_velocity
        task["acceleration"] = solve(momentum.inertia, np.array([-weight * ey, weight * ex, 0.0]))
