"""Aims of a turn over hands and feet, a cartwheel: carry the body along the way, set limbs down.

Hands and feet are put on one line along the way that the body tips (`standing.tipping`), lowered
over the turn, [AlBorno2014] stages 2 to 4; the centre of mass is carried along, and across it falls
to the side of that line that the capture point is on, as a pendulum does.
"""

from math import copysign, radians
from typing import Literal

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import support
from rotctl.behaviours.aerial.pendulum import Base, captured
from rotctl.behaviours.named_bodies import NamesNothing
from rotctl.behaviours.scene import Scene
from rotctl.behaviours.standing.swinging import SOONEST, arrival, rise, velocity_of
from rotctl.behaviours.standing.tipping import rests, share_of, ways
from rotctl.control.task import Tasks
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array, dot
from rotctl.mechanics.bodies import body_id, body_ids
from rotctl.mechanics.model import Model
from rotctl.settings.fields import STRICT, Finite, Names, NonNegative, Positive

SLOWEST = 1.0  # [rad/s] the slowest turn by which the time to a touch-down is reckoned


@validated(frozen=True, config=STRICT)
class Carry:
    """Take the centre of mass along the way, at a speed and a height: linear.

    Across the way the capture point is kept over what stands. Two hands are a line, and one a
    point: pressure there cannot follow it, and a body thrown about the way acts like pressure
    from beyond them.

    Attributes:
        bodies: that may stand; of those the ones that do, with all of their length, or
        hands: with no more than touches.
        speed: along the way [m/s], and
        eager: how fast it is taken up [1/s].
        gain: of the pressure beyond the capture point, across the way [-].
        margin: inside the support that it keeps there [m].
        heights: of the centre of mass over the ground [m], from the one to the other while it turns
        angles: from here to there [deg], in the sense of the target.
        throw: furthest beyond what stands that pressure is wanted, across the way [m].
    """

    law: Literal["carry"]
    bodies: Names
    hands: Names
    speed: Finite
    eager: Positive
    gain: NonNegative
    margin: NonNegative
    heights: tuple[Positive, Positive]
    angles: tuple[Finite, Finite]
    throw: NonNegative = 0.0

    def __post_init__(self) -> None:
        if not self.bodies and not self.hands:
            raise ValueError("bodies=[]: too few values, as there are no hands either")

    def check(self, model: Model, key: str) -> None:
        """Raises InputError for a body that is not there; `key` says where the aim stands."""
        body_ids(model.mj, self.bodies, f"{key}.bodies")
        body_ids(model.mj, self.hands, f"{key}.hands")

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set target and acceleration."""
        model, state = scene.model, scene.state
        along, across = ways(scene)
        ends = self._ends(scene)
        rate = support.pendulum_rate(model, state)
        base = Base(support.hull(ends), support.middle(ends), rate)
        aside = captured(scene, base, across, self.gain, self.margin)
        if self.throw:
            aside += self._thrown(scene, base, across, aside)
        ahead = self.eager * (self.speed - dot(state.momentum.com_velocity, along))
        task["acceleration"] = ahead * along + aside * across
        low, high = self.heights
        height = low + share_of(scene, self.angles) * (high - low)
        x, y, _ = state.momentum.com.tolist()
        task["target"][:3] = [x, y, scene.floor + height]

    def _thrown(self, scene: Scene, base: Base, across: Array, aside: float) -> float:
        """What pressure from beyond what stands would add to an acceleration across [m/s2]."""
        x, y = base.middle
        momentum, square = scene.state.momentum, base.rate * base.rate
        off = dot(momentum.com - np.array([x, y, 0.0]), across)
        out = off + dot(momentum.com_velocity, across) / base.rate
        missing = square * (off - (1.0 + self.gain) * out) - aside
        most = square * self.throw
        return min(max(missing, -most), most)

    def _ends(self, scene: Scene) -> list[support.Point]:
        """What stands, seen from above [m]."""
        model, contacts = scene.model, scene.state.contacts
        touching = contacts.body.tolist()
        feet = body_ids(model.mj, self.bodies)
        hands = body_ids(model.mj, self.hands)
        stand = [body for body in feet if body in touching]
        spots = zip(touching, contacts.position.tolist(), strict=True)
        ends = [(x, y) for body, (x, y, _) in spots if body in hands]
        if stand or not ends:
            ends += support.ends(model, scene.state.data, stand or feet or hands)
        return ends


@validated(frozen=True, config=STRICT)
class Place:
    """Set a limb down on the way, so far beyond another, or lift it there: point.

    Across the way it goes to where the body comes to rest.
    One that has come down has no weight here: its contacts hold it.

    Attributes:
        beyond: body whose place counts,
        distance: along the way from there [m].
        angles: turned, between which it goes up or down there [deg], in the target's sense.
        height: of the point over the ground in the end [m]; under it, and it comes down for sure.
        ahead: of where the body comes to rest, across the way [m].
        room: by how much it may be set down nearer or further than `distance` [m], where the body
            comes to rest along the way when the limb is down; 0 keeps to the distance.
        short: so far before that place [m].
    """

    law: Literal["place"]
    beyond: str
    distance: Finite
    angles: tuple[Finite, Finite]
    height: Finite
    ahead: Finite = 0.0
    room: NonNegative = 0.0
    short: Finite = 0.0

    def __post_init__(self) -> None:
        if self.short and not self.room:
            raise ValueError(f"short={self.short:g}: acts on nothing without room; give short=0")

    def check(self, model: Model, key: str) -> None:
        """Raises InputError for a body that is not there; `key` says where the aim stands."""
        body_id(model.mj, self.beyond, f"{key}.beyond")

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set the target."""
        body, state, data = int(task["body"]), scene.state, scene.state.data
        along, across = ways(scene)
        (beyond,) = body_ids(scene.model.mj, [self.beyond])
        from_here = dot(data.xpos[beyond], along)
        aside = rests(scene, across) + self.ahead
        goal = (from_here + self._far(scene, along, from_here)) * along + aside * across
        x, y = float(goal[0]), float(goal[1])
        first = float(scene.begin.place[body][2])
        last = scene.model.ground.height(x, y) + self.height
        if last < first and body in state.contacts.body.tolist():
            task["weight"] = 0.0
            return
        share = share_of(scene, self.angles)
        task["target"][:3] = [x, y, first + share * (last - first)]
        turns = abs(dot(state.momentum.angular_velocity, scene.turning))
        span = radians(self.angles[1] - self.angles[0])
        task["velocity"] = dot(state.momentum.com_velocity, across) * across
        task["velocity"][2] = turns * (last - first) / span if 0.0 < share < 1.0 else 0.0

    def _far(self, scene: Scene, along: Array, from_here: float) -> float:
        """Along the way from the other body [m]."""
        if not self.room:
            return self.distance
        momentum = scene.state.momentum
        turns = abs(dot(momentum.angular_velocity, scene.turning))
        left = radians(self.angles[1]) - copysign(1.0, scene.target) * scene.turned
        time = max(left, 0.0) / max(turns, SLOWEST)
        speed = dot(momentum.com_velocity, along)
        far = rests(scene, along) + time * speed - self.short - from_here
        return min(max(far, self.distance - self.room), self.distance + self.room)


@validated(frozen=True, config=STRICT)
class Stride(NamesNothing):
    """Step to the side with a foot, in a time: point.

    Across the way it goes to where the body comes to rest.

    Attributes:
        distance: along the way from where the centre of mass will be when the foot is down [m].
        time: of the step [s].
        lift: of the foot on its way [m].
        height: of the point over the ground when the foot is down [m].
    """

    law: Literal["stride"]
    distance: Finite
    time: Positive
    lift: NonNegative
    height: Finite

    def fill(self, task: Tasks, kind: str, scene: Scene) -> None:
        """Set target, velocity and acceleration; the task has stiffness upward alone."""
        state, data = scene.state, scene.state.data
        body, (along, across) = int(task["body"]), ways(scene)
        place = data.xpos[body] + product(data.xmat[body].reshape(3, 3), task["point"])
        velocity = velocity_of(scene, body, place)
        gone = min((state.time - scene.begin.time) / self.time, 1.0)
        left = max(self.time * (1.0 - gone), SOONEST)
        com, speed = state.momentum.com, state.momentum.com_velocity
        way = dot(com + left * speed - place, along) + self.distance
        aside = rests(scene, across) - dot(place, across)
        task["acceleration"] = arrival(way, dot(velocity, along), left) * along
        task["acceleration"] += arrival(aside, dot(velocity, across), left) * across
        rise(task, scene, self, gone, place, velocity)
