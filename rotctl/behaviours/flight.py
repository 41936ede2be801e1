"""Flight: inertia is regulated so that the body lands at the attitude that is wanted.

In the air angular momentum H stays as it is, so inertia alone decides how fast the body turns:
omega = |H| / I. Each control step takes the time t that is left to the landing, from ballistics,
and what is left to turn, and chooses the shape whose mean rate over that time meets it: the body
tucks where it turns too slowly, and opens where it turns too fast, [AlBorno2014]. In the end it
opens to the pose that it lands in.

What is left to turn is theta_land - (theta + shape), where `shape` is the turn that the change
of shape from here to the landing pose makes by itself. Shapes lie on one line: the amount is 1
fully tucked, 0 in the landing pose and -1 stretched.
"""

from dataclasses import dataclass
from math import atan2, copysign, pi, radians, sqrt, tau
from typing import TypeVar

import mujoco
import numpy as np
from numpy.typing import NDArray
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.scene import Scene
from rotctl.mechanics.model import Model, body_ids, lowest_and_highest
from rotctl.mechanics.shape import Shapes
from rotctl.mechanics.state import State
from rotctl.motion import Turn, make_pose
from rotctl.rotations import Array, dot, quaternion_from_rotation_vector
from rotctl.settings import STRICT, Finite, Fraction, Positive

AMOUNTS = np.arange(-10, 11) / 10.0  # of the tuck, at which inertia is tabulated
INSTANTS = (np.arange(24) + 0.5) / 24  # of the time left, at which the plan is looked at
HALVINGS = 14  # of the amounts that are possible: 0.0001
LEAST_TIME = 1e-3  # [s] to the landing
SETTLING = 4.0  # [periods] in which the amount comes near, so that it does not overshoot

Share = TypeVar("Share", float, Array)


@validated(frozen=True, config=STRICT)
class FlightSettings:
    """How a body flies.

    Attributes:
        land: pose that it lands in, by joint name [rad].
        tuck: tightest pose; stretch: longest.
        tightest, longest: shares of the way to them that it may go [-].
        attitude: of the pelvis on landing, from upright in the sense of forward [deg], past
            the whole turns that the behaviour's target is.
        bodies: that land.
        opening: to the landing pose begins so long before it [s].
        change: from the landing pose to the tuck, or from the pose at take-off to the line of
            shapes, takes so long [s].
    """

    land: dict[str, Turn]
    tuck: dict[str, Turn]
    stretch: dict[str, Turn]
    attitude: Finite
    bodies: tuple[str, ...]
    opening: Positive
    change: Positive
    tightest: Fraction = 1.0
    longest: Fraction = 1.0


@dataclass(frozen=True)
class Aloft:
    """What flight remembers from one control step to the next.

    Attributes:
        amount: of the tuck [-]; rate: of that [1/s].
        held: amount that is wanted until it opens [-].
        first: (nu,) pose at take-off [rad].
        pose: (nu,) that joints are to have now [rad]; speed: (nu,) of that [rad/s].
    """

    amount: float
    rate: float
    held: float
    first: Array
    pose: Array
    speed: Array


class Flight:
    """The regulator of one run's flight."""

    def __init__(
        self, settings: FlightSettings, model: Model, axis: Array, target: float, key: str
    ) -> None:
        """Tabulate inertia over the shapes.

        Args:
            axis: (3,) of the pelvis that it turns about, unit, in the pelvis's frame.
            target: to turn [rad]; its sign is the sense.
            key: where the settings stand.

        Raises:
            InputError: a joint or a body is not there.
        """
        self._settings, self._model, self._axis = settings, model, axis
        self._sense = 1.0 if target >= 0.0 else -1.0
        self.landing = target + radians(settings.attitude)
        self._line = [
            make_pose(model, pose, f"{key}.{name}")
            for name, pose in (
                ("stretch", settings.stretch),
                ("land", settings.land),
                ("tuck", settings.tuck),
            )
        ]
        self._shapes = Shapes(model)
        self._slowness = np.array(
            [1.0 / self._shapes.inertia(self.pose(a), axis) for a in AMOUNTS.tolist()]
        )
        standing = np.isin(model.mj.geom_bodyid, body_ids(model.mj, settings.bodies, key))
        self.height = self._height(standing & (model.mj.geom_contype > 0))

    def _height(self, landing: NDArray[np.bool_]) -> float:
        """Of the centre of mass over what lands, in the landing pose and attitude [m]."""
        mj, data = self._model.mj, mujoco.MjData(self._model.mj)
        data.qpos[3:7] = quaternion_from_rotation_vector(self.landing * self._axis)
        data.qpos[self._model.angles] = self._line[1]
        mujoco.mj_kinematics(mj, data)
        mujoco.mj_comPos(mj, data)
        return float(data.subtree_com[1, 2] - lowest_and_highest(mj, data, landing)[0])

    def pose(self, amount: float) -> Array:
        """The shape (nu,) of an amount of tuck [rad]."""
        stretch, land, tuck = self._line
        end = tuck if amount >= 0.0 else stretch
        return land + abs(amount) * (end - land)

    def time_left(self, scene: Scene) -> float:
        """To the landing, as things fly [s]."""
        momentum = scene.state.momentum
        return self.time(scene, momentum.com.tolist(), float(momentum.com_velocity[2]))

    def time(self, scene: Scene, com: list[float], up: float) -> float:
        """To the landing [s]: 2 v / g, [AlBorno2014], and more where it lands lower.

        Args:
            com: place of the centre of mass [m]; up: its velocity [m/s].
        """
        fall = -float(scene.model.gravity[2])
        x, y, z = com
        over = max(z - self.height - scene.model.ground.height(x, y), 0.0)
        return max((up + sqrt(up * up + 2.0 * fall * over)) / fall, LEAST_TIME)

    def turned(self, scene: Scene) -> float:
        """theta: how far the pelvis has turned about left from upright [rad]."""
        front = scene.state.momentum.root_rotation[:, 0]
        forward, _, up = scene.axes
        angle = atan2(-dot(front, up), dot(front, forward))
        drift = (angle - scene.excursion.phase + pi) % tau - pi
        return scene.excursion.phase + drift

    def left_to_turn(self, scene: Scene) -> float:
        """In the sense of the flight, beside what the change of shape does [rad]."""
        angles = scene.state.position[self._model.angles]
        shape = self._shapes.turn(angles, self._line[1], self._axis)
        return self._sense * (self.landing - self.turned(scene) - shape)

    def momentum(self, scene: Scene, amount: float, time: float) -> float:
        """About left, with which an amount of tuck turns what is left in a time [kg m2/s]."""
        return (
            self._sense * self.left_to_turn(scene) / (time * self.mean_slowness(amount, 0.0, time))
        )

    def mean_slowness(self, amount: float, now: float, time: float) -> float:
        """Mean of 1/I until the landing [1/(kg m2)].

        Args:
            amount: that it goes to, until it opens; now: the present one.
            time: left [s].
        """
        settings = self._settings
        held = _smooth(np.minimum((1.0 - INSTANTS) * (time / settings.opening), 1.0))
        gone = _smooth(np.minimum(INSTANTS * (time / settings.change), 1.0))
        amounts = now + (amount * held - now) * gone
        return float(np.interp(amounts, AMOUNTS, self._slowness).sum()) / len(INSTANTS)

    def begin(self, state: State) -> Aloft:
        """Memory at take-off: the pose as it is."""
        pose = state.position[self._model.angles].copy()
        return Aloft(0.0, 0.0, 0.0, pose, pose, np.zeros_like(pose))

    def advance(self, before: Aloft | None, scene: Scene, period: float) -> Aloft:
        """Memory one control period [s] on, or at take-off."""
        settings = self._settings
        if before is None:
            return self.begin(scene.state)
        time = self.time_left(scene)
        late = time < 0.5 * settings.change  # too late for another shape to turn much
        held = before.held if late else self._amount(scene, before.amount, time)
        wanted = held * _smooth(min(time / settings.opening, 1.0))
        amount, rate = self._towards(wanted, before, period)
        gone = (scene.state.time - scene.begin.time) / settings.change
        pose = self.pose(amount)
        pose += (1.0 - _smooth(min(gone, 1.0))) * (before.first - pose)
        return Aloft(amount, rate, held, before.first, pose, (pose - before.pose) / period)

    def _towards(self, wanted: float, now: Aloft, period: float) -> tuple[float, float]:
        """Amount and its rate a period on: there soonest, with a unit's way in `change`."""
        most, way = 4.0 / self._settings.change**2, wanted - now.amount
        fastest = min(sqrt(2.0 * most * abs(way)), abs(way) / (SETTLING * period))
        rate = now.rate + min(max(copysign(fastest, way) - now.rate, -most * period), most * period)
        return now.amount + rate * period, rate

    def _amount(self, scene: Scene, now: float, time: float) -> float:
        """Of tuck whose mean rate |H|/I over the time left turns what is left, by bisection."""
        need = self.left_to_turn(scene)
        momentum = self._sense * dot(scene.state.momentum.angular, scene.axes[1])
        low, high = -self._settings.longest, self._settings.tightest

        def falls_short(amount: float) -> bool:
            return momentum * self.mean_slowness(amount, now, time) * time < need

        if falls_short(high):
            return high
        if not falls_short(low):
            return low
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if falls_short(middle) else (low, middle)
        return 0.5 * (low + high)

    def poses(self, scene: Scene, aloft: Aloft | None) -> tuple[Array, Array]:
        """Twice the pose (2, nu) [rad], and its speed (2, nu) [rad/s]."""
        now = self.begin(scene.state) if aloft is None else aloft
        return np.array((now.pose, now.pose)), np.array((now.speed, now.speed))


def _smooth(share: Share) -> Share:
    """From 0 to 1 without a jump of speed."""
    return share * share * (3.0 - 2.0 * share)
