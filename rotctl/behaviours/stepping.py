"""Capture steps: a foot goes where the body can come to rest over it.

With the whole body's angular momentum H the body comes to rest over

    c + v / omega + spin (H_y, -H_x) / (m z omega),

the capture point as if H, too, were gone there. Where it leaves the feet, one of them becomes the
swing foot and goes to where that point will be when the foot is down; pressure stays under the
other foot meanwhile, from which the point runs away as e^(omega t).
"""

from functools import lru_cache
from math import cos, exp, pi, sin, sqrt
from typing import Literal

import mujoco
import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import support
from rotctl.behaviours.scene import Scene, Step
from rotctl.behaviours.support import Point
from rotctl.control.task import Tasks
from rotctl.linear import product
from rotctl.mechanics.bodies import ROOT_BODY, body_id
from rotctl.mechanics.model import Model
from rotctl.rotations import Array
from rotctl.settings import STRICT, NonNegative, Positive

DOWN = 0.5  # of a swing, from which on a touch ends it
LATE = 1.5  # swings, after which one ends that met no ground
REACH_DOWN = 0.85  # of a swing, from which on the foot
UNDER = 0.03  # [m] is wanted so far under the ground: it meets it with some speed
SOONEST = 0.05  # [s] the shortest time to go that a swing is steered with
Facing = Literal["front", "left"]
FACING = {"front": support.forward, "left": support.forward_of_left}
NEAR = 0.01  # [m] over the ground: a foot that has just lost it
CALM = 0.2  # [m/s] of the centre of mass: it rests
STAGGERED = 0.15  # [m] feet so far one before the other: the one behind swings


@validated(frozen=True, config=STRICT)
class Stepping:
    """Swing a foot to the capture point; one that does not swing has no weight here: point.

    Attributes:
        bodies: the left foot and the right one.
        margin: that the capture point may be outside the feet [m].
        spin: share of the angular momentum that the step is to catch [-].
        time: that a swing takes [s].
        lift: of the foot in its middle [m].
        height: of the task's point above the ground when the foot stands [m].
        over: that the foot goes beyond the capture point [m].
        reach: furthest from the other foot, but for the width [m].
        width: of the stance at least, from foot to foot; legs do not cross [m].
        fall: no step begins while the body falls faster: two legs have to brake it [m/s].
        aside: capture points further to a side than this are followed by that side's foot [m].
        facing: axis of the pelvis by which it knows its sides: its front, or its left, which stays
            level however far it bows. Past level its front points behind it.
        narrow: in a stance wider than this the foot beyond which the capture point lies does not
            swing out of reach: the other one comes in first [m]; 0 lets it.
        away: of the two feet the one swings whose step leaves the capture point less far outside
            them, a metre that the point runs away meanwhile counted as so many of those [-]; 0 goes
            by `aside` and `narrow` in place of that.
        gather: who has come to rest with feet further apart brings them together [m], more than
            `width`; 0 lets them.
    """

    law: Literal["step"]
    bodies: tuple[str, str]
    margin: NonNegative
    spin: NonNegative
    time: Positive
    lift: NonNegative
    height: NonNegative
    over: NonNegative
    reach: Positive
    width: NonNegative
    fall: Positive
    aside: NonNegative = 0.0
    facing: Facing = "front"
    narrow: NonNegative = 0.0
    away: NonNegative = 0.0
    gather: NonNegative = 0.0

    def __post_init__(self) -> None:
        for name in ("aside", "narrow"):
            if self.away and getattr(self, name):
                raise ValueError(
                    f"{name}={getattr(self, name):g}: acts on nothing, the foot is chosen by away; "
                    f"give {name}=0 or away=0"
                )
        if 0.0 < self.gather <= self.width:
            raise ValueError(
                f"gather={self.gather:g}: must be 0 or more than width={self.width:g}, which it "
                "comes to"
            )

    def check(self, model: Model, key: str) -> None:
        """Raises InputError for a body that is not there; `key` says where the aim stands."""
        for body in self.bodies:
            body_id(model.mj, body, f"{key}.bodies")

    def next(self, scene: Scene) -> Step:
        """The step of this instant, from that of the control step before."""
        step, model, state = scene.step, scene.model, scene.state
        touching = state.contacts.body.tolist()
        if step.swing:
            gone = state.time - step.begin
            down = gone > DOWN * self.time and step.swing in touching
            ends = down or gone > LATE * self.time
            return Step() if ends else step
        left, right = self._feet(model)
        falls = float(state.momentum.com_velocity[2]) < -self.fall
        if falls or not {left, right} & set(touching):
            return step
        corners = support.hull(support.ends(model, state.data, (left, right)))
        hangs = any(support.lifted(model, state, foot) for foot in (left, right))
        stays = support.outside(corners, self.capture_point(scene)) < self.margin
        if not hangs and stays and not self._sprawls(scene):
            return step
        swing = self.swinging(scene, touching)
        return Step(swing, right if swing == left else left, state.time)

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set what the swing foot should do."""
        step, body, data = scene.step, int(task["body"]), scene.state.data
        if step.swing != body:
            task["weight"] = 0.0
            return
        place = data.xpos[body] + product(data.xmat[body].reshape(3, 3), task["point"])
        velocity = velocity_of(scene, body, place)
        gone = min((scene.state.time - step.begin) / self.time, 1.0)
        left = self.time * (1.0 - gone)
        x, y = self.landing(scene, left)
        px, py, _ = place.tolist()
        vx, vy, _ = velocity.tolist()
        soon = max(left, SOONEST)
        task["acceleration"] = [arrival(x - px, vx, soon), arrival(y - py, vy, soon), 0.0]
        over = self.lift * sin(pi * gone) - (UNDER if gone > REACH_DOWN else 0.0)
        task["target"][:3] = [px, py, scene.model.ground.height(px, py) + self.height + over]
        task["velocity"] = [vx, vy, self.lift * pi / self.time * cos(pi * gone)]

    def landing(self, scene: Scene, left: float) -> Point:
        """Where the middle of the swing foot should be [m], `left` [s] before it is down."""
        return self._landing(scene, scene.step, left)

    def _landing(self, scene: Scene, step: Step, left: float) -> Point:
        """The same in a step that may never be taken."""
        model, state = scene.model, scene.state
        ends = support.ends(model, state.data, (step.stance,))
        fx, fy = support.middle(ends)
        x, y = self._escaped(scene, ends, left)
        dx, dy = x - fx, y - fy
        far = sqrt(dx * dx + dy * dy)
        beyond = 1.0 + self.over / far if far > 0.0 else 1.0
        forward = FACING[self.facing](state, ROOT_BODY)
        ahead, aside = _turned(beyond * dx, beyond * dy, forward, -1.0)
        share = min(1.0, self.reach / (sqrt(ahead * ahead + aside * aside) or 1.0))
        side = 1.0 if step.swing == self._feet(model)[0] else -1.0
        aside = side * max(side * share * aside, self.width)
        dx, dy = _turned(share * ahead, aside, forward, 1.0)
        return fx + dx, fy + dy

    def _escaped(self, scene: Scene, ends: list[Point], time: float) -> Point:
        """Where the capture point is after a time [s], pressed by a foot as near as it reaches."""
        x, y = self.capture_point(scene)
        px, py = support.within(support.hull(ends), support.middle(ends), (x, y), 0.0)
        grown = self._grown(scene, time)
        return px + grown * (x - px), py + grown * (y - py)

    def capture_point(self, scene: Scene) -> Point:
        """Where the body comes to rest, its angular momentum gone, seen from above [m]."""
        model, momentum = scene.model, scene.state.momentum
        rate = support.pendulum_rate(model, scene.state)
        x, y = support.capture_point(scene.state, rate)
        # m z omega = m g / omega
        share = self.spin * rate / (model.mass * -float(model.gravity[2]))
        return x + share * float(momentum.angular[1]), y - share * float(momentum.angular[0])

    def swinging(self, scene: Scene, touching: list[int]) -> int:
        """The foot to swing, of those that touch the ground: never the only one that stands."""
        left, right = feet = self._feet(scene.model)
        bearing = {*touching, *self._near(scene)} if self.away else {*touching}
        if left not in bearing or right not in bearing:
            return right if left in bearing else left
        if self.away:
            return min(feet, key=lambda foot: self._cost(scene, foot))
        return self._by_sides(scene)

    def _by_sides(self, scene: Scene) -> int:
        """The foot of the side to which the capture point lies, else the one that is behind."""
        model, state = scene.model, scene.state
        left, right = feet = self._feet(model)
        (lx, ly), (rx, ry) = (support.middle(support.ends(model, state.data, (f,))) for f in feet)
        x, y = self.capture_point(scene)
        forward = FACING[self.facing](state, ROOT_BODY)
        _, aside = _turned(x - 0.5 * (lx + rx), y - 0.5 * (ly + ry), forward, -1.0)
        ahead, wide = _turned(lx - rx, ly - ry, forward, -1.0)
        near, far = (left, right) if aside > 0.0 else (right, left)
        if abs(aside) > self.aside:
            way = (abs(aside) + 0.5 * abs(wide)) * self._grown(scene, self.time)
            far_out = self.narrow > 0.0 and abs(wide) > self.narrow and way > self.reach
            return far if far_out else near
        if abs(ahead) > STAGGERED:
            to_left = (lx - x) ** 2 + (ly - y) ** 2
            to_right = (rx - x) ** 2 + (ry - y) ** 2
            return left if to_left > to_right else right
        return far

    def _cost(self, scene: Scene, swing: int) -> float:
        """Of a step with this foot [m]: how far the capture point is outside both feet then.

        And how far it has run, away from the foot that stands. Pushed to a side it is better to
        swing the loaded foot where the other one, on its own side, would not get beyond the point,
        and worse where the loaded one has just come down out there and all but reached it.
        """
        data, (left, right) = scene.state.data, self._feet(scene.model)
        stance = right if swing == left else left
        stands = support.ends(scene.model, data, (stance,))
        swings = support.ends(scene.model, data, (swing,))
        fx, fy = support.middle(swings)
        x, y = self._landing(scene, Step(swing, stance), self.time)
        landed = [(ex + x - fx, ey + y - fy) for ex, ey in swings]
        (px, py), (nx, ny) = self._escaped(scene, stands, self.time), self.capture_point(scene)
        missed = max(support.outside(support.hull(stands + landed), (px, py)), 0.0)
        return missed + self.away * sqrt((px - nx) ** 2 + (py - ny) ** 2)

    def _near(self, scene: Scene) -> list[int]:
        """The feet that could bear in a moment."""
        model, data = scene.model, scene.state.data
        lowest = {foot: support.lowest_end(model, data, foot) for foot in self._feet(model)}
        return [f for f, (x, y, z) in lowest.items() if z - model.ground.height(x, y) < NEAR]

    def _sprawls(self, scene: Scene) -> bool:
        """Whether it has come to rest with its feet further apart than people stand."""
        if not self.gather:
            return False
        model, state = scene.model, scene.state
        vx, vy, _ = state.momentum.com_velocity.tolist()
        (lx, ly), (rx, ry) = (
            support.middle(support.ends(model, state.data, (foot,))) for foot in self._feet(model)
        )
        apart = (lx - rx) ** 2 + (ly - ry) ** 2 > self.gather**2
        return apart and vx * vx + vy * vy < CALM**2

    def _grown(self, scene: Scene, time: float) -> float:
        """How many times further from the pressure a capture point is after a time [s]."""
        return exp(support.pendulum_rate(scene.model, scene.state) * time)

    def _feet(self, model: Model) -> tuple[int, int]:
        return _ids(model.mj, self.bodies)


@lru_cache(maxsize=64)
def _ids(mj: mujoco.MjModel, bodies: tuple[str, str]) -> tuple[int, int]:
    left, right = bodies
    return body_id(mj, left), body_id(mj, right)


def arrival(way: float, speed: float, time: float) -> float:
    """Acceleration [m/s2] to be at rest after a way [m] and a time [s], the least in the square."""
    return 6.0 * way / time**2 - 4.0 * speed / time


def velocity_of(scene: Scene, body: int, place: Array) -> Array:
    """Of a point of a body (3,) [m/s]."""
    jacobian = np.zeros((3, scene.model.mj.nv))
    mujoco.mj_jac(scene.model.mj, scene.state.data, jacobian, None, place, body)
    return product(jacobian, scene.state.velocity)


def _turned(x: float, y: float, forward: Point, sense: float) -> Point:
    """A level vector turned as +x is to `forward` (sense 1), or back (-1)."""
    cosine, sine = forward[0], sense * forward[1]
    return x * cosine - y * sine, x * sine + y * cosine
