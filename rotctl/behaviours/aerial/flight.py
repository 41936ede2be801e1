"""Flight: inertia is regulated so that the body lands at the attitude that is wanted.

In the air angular momentum H stays as it is, so inertia alone decides how fast the body turns:
omega = |H| / I. Each control step takes the time t that is left to the landing, from ballistics,
and what is left to turn, and chooses the shape whose mean rate over that time meets it: the body
tucks where it turns too slowly, and opens where it turns too fast, [AlBorno2014]. In the end it
opens to the pose that it lands in.

What is left to turn is theta_land - (theta + shape), where `shape` is the turn that the change
of shape from here to the landing pose makes by itself. Shapes: see `aerial.tucking`.
"""

from math import atan2, pi, radians, tau
from typing import NamedTuple

import numpy as np

from rotctl.behaviours.aerial.flight_settings import TUCK, FlightSettings
from rotctl.behaviours.aerial.landing import Contact
from rotctl.behaviours.aerial.levelling import Ahead, Levelled, Levelling
from rotctl.behaviours.aerial.touch_down import TouchDown
from rotctl.behaviours.aerial.tucking import Tucking
from rotctl.behaviours.easing import smooth, soonest
from rotctl.behaviours.facing import Frame
from rotctl.behaviours.scene import Scene
from rotctl.errors import InputError
from rotctl.maths.rotations import Array, crossed, dot
from rotctl.mechanics.model import Model
from rotctl.mechanics.shape import Shapes
from rotctl.mechanics.state import State
from rotctl.suggestion import instead

GRAVITY = 9.81  # [m/s2] good enough to say where it comes down: on the floor or beyond it


class Aloft(NamedTuple):
    """What flight remembers from one control step to the next.

    Attributes:
        amount: of the tuck [-]; rate: of that [1/s].
        held: amount that is wanted until it opens [-].
        first: (nu,) pose at take-off [rad].
        pose: (nu,) that joints are to have now [rad]; speed: (nu,) of that [rad/s].
        level: what arms do against momentum across the way.
    """

    amount: float
    rate: float
    held: float
    first: Array
    pose: Array
    speed: Array
    level: Levelled = Levelled()


class Flight:
    """The regulator of one run's flight.

    Attributes:
        landing: how it ends.
        tucking: its shapes.
    """

    def __init__(
        self,
        settings: FlightSettings,
        model: Model,
        frame: Frame,
        target: float,
        key: str,
        shape: str = TUCK,
    ) -> None:
        """Tabulate inertia over the shapes.

        Args:
            frame: of the behaviour.
            target: to turn [rad]; its sign is the sense.
            key: where the settings stand.
            shape: that it flies in.

        Raises:
            InputError: a joint, a body or a shape is not there.
        """
        if shape not in (known := (TUCK, *settings.shapes)):
            valid = instead(shape, known)
            raise InputError(f"behaviour.shape={shape}: no such shape; {valid}")
        self._settings, self._model, self._frame = settings, model, frame
        self._axis = frame.trunk_axis
        self._target, self._sense = target + radians(settings.first), 1.0 if target >= 0.0 else -1.0
        self._pitches = bool(frame.trunk_axis[1])  # a landing leans about left
        self.landing = TouchDown(settings, model, self._axis, self._target, key)
        self._shapes = Shapes(model)
        self._levelling: Levelling | None = None
        level = settings.levelling
        if level and (not level.shapes or shape in level.shapes):
            if not self._pitches:
                raise InputError(f"{key}.levelling: is of turns about left, and this one is not")
            aside = f"{key}.levelling"
            self._levelling = Levelling(level, model, self._shapes, settings.change, aside)
        opening = settings.opened_for(target)
        self.tucking = Tucking(
            settings, model, self._shapes, self._axis, self.landing.usual, opening, key, shape
        )

    def least_momentum(self, turns: float, gone: float, time: float) -> float:
        """About its axis, that makes a turn in the tightest shape [kg m2/s].

        Args:
            turns: from upright to the landing, in the sense of the flight; gone: of that at
                take-off [rad].
            time: in the air [s].
        """
        leans = self._sense * self.landing.usual.attitude if self._pitches else 0.0
        need = turns + leans - gone
        return max(need, 0.0) / (
            time * self.tucking.mean_slowness(self._settings.tightest, 0.0, time)
        )

    def turned(self, scene: Scene) -> float:
        """theta: how far the pelvis has turned from upright [rad]."""
        front, forward = scene.state.momentum.root_rotation[:, 0], scene.axes[0]
        aside = np.array(crossed(scene.turning.tolist(), forward.tolist()))
        angle = atan2(dot(front, aside), dot(front, forward))
        drift = (angle - scene.excursion.phase + pi) % tau - pi
        return scene.excursion.phase + drift

    def left_to_turn(self, scene: Scene, contact: Contact, momentum: float) -> float:
        """In the sense of the flight, beside what the change of shape does [rad].

        Args:
            momentum: in that sense [kg m2/s]; omega_land = |H| / I_land, [AlBorno2014].
        """
        angles = scene.state.position[self._model.angles]
        shape = self._shapes.turn(angles, contact.pose, self._axis)
        goal = self._target + (contact.attitude if self._pitches else 0.0)
        coasts = momentum * self._settings.coasting * self.tucking.landing_slowness
        return self._sense * (goal - self.turned(scene) - shape) - coasts

    def planned(self, scene: Scene, amount: float, forward: float, up: float, high: float) -> float:
        """Momentum with which an average tuck turns what is left [kg m2/s].

        Args:
            amount: of tuck, on average.
            forward, up: velocity at take-off [m/s].
            high: place of the centre of mass there over the floor that it stands on [m].
        """
        x, y = (scene.state.momentum.com + forward * abs(up) / GRAVITY * scene.axes[0])[:2].tolist()
        over, momentum = high + scene.floor - scene.model.ground.height(x, y), 0.0
        for _ in range(2):  # how it lands depends on its momentum, too
            contact = self.landing.contact(momentum if self._pitches else 0.0, forward, up, over)
            time = self.landing.time(up, over, contact)
            slowness = self.tucking.mean_slowness(amount, 0.0, time)
            along = self._sense * momentum
            momentum = self._sense * self.left_to_turn(scene, contact, along) / (time * slowness)
        return momentum

    def begin(self, state: State) -> Aloft:
        """Memory at take-off: the pose as it is."""
        pose = state.position[self._model.angles].copy()
        return Aloft(0.0, 0.0, 0.0, pose, pose, np.zeros_like(pose))

    def advance(self, before: Aloft | None, scene: Scene, period: float) -> Aloft:
        """Memory one control period [s] on, or at take-off."""
        settings = self._settings
        if before is None:
            return self.begin(scene.state)
        momentum, (ahead, left, _) = scene.state.momentum, scene.axes
        x, y, z = momentum.com.tolist()
        up, pitching = float(momentum.com_velocity[2]), dot(momentum.angular, left)
        over = z - scene.model.ground.height(x, y)
        contact = self.landing.contact(pitching, dot(momentum.com_velocity, ahead), up, over)
        time = self.landing.time(up, over, contact)
        late = time < 0.5 * settings.change  # too late for another shape to turn much
        turning = self._sense * dot(momentum.angular, scene.turning)
        need = 0.0 if late else self.left_to_turn(scene, contact, turning) - before.level.missed
        held = before.held if late else self.tucking.amount(need, turning, before.amount, time)
        wanted = held * self.tucking.held(time)
        amount, rate = soonest(wanted, before.amount, before.rate, settings.change, period)
        gone = (scene.state.time - scene.begin.time) / settings.change
        pose = self.tucking.pose(amount, contact)
        feet = self.landing.feet
        if feet and feet.legs_reach:
            opened = 1.0 - self.tucking.held(time)
            turns = turning * time * self.tucking.mean_slowness(held, before.amount, time)
            missing = self.left_to_turn(scene, contact, turning) - turns
            pose = feet.placed(pose, self._sense * opened * missing)
        pose += (1.0 - smooth(min(gone, 1.0))) * (before.first - pose)
        now = Aloft(amount, rate, held, before.first, pose, pose, before.level)
        if self._levelling:
            ahead_of_it = self._ahead(scene, contact, now, time, gone)
            level = self._levelling.advance(before.level, ahead_of_it, period)
            pose = pose + smooth(min(gone, 1.0)) * self._levelling.offset(level.amount)
            now = now._replace(pose=pose, level=level)
        return now._replace(speed=(pose - before.pose) / period)

    def _ahead(self, scene: Scene, contact: Contact, now: Aloft, time: float, gone: float) -> Ahead:
        """What is left of the flight as it is planned, [s] and changes gone until now."""
        settings, state = self._settings, scene.state

        def opened(after: float) -> float:
            return self.tucking.held(max(time - after, 0.0))

        def changed(after: float) -> float:
            return smooth(min(after / settings.change, 1.0))

        def pose(after: float) -> Array:
            amount = now.amount + (now.held * opened(after) - now.amount) * changed(after)
            shape = self.tucking.pose(amount, contact)
            first = 1.0 - smooth(min(gone + after / settings.change, 1.0))
            return np.asarray(shape + first * (now.first - shape))

        return Ahead(
            time,
            state.time,
            tuple(state.position[3:7].tolist()),
            state.momentum.angular.tolist(),
            state.position[self._model.angles],
            pose,
            opened,
            changed,
            scene.axes.tolist(),
            self._target + contact.attitude,
            self._sense,
        )

    def poses(self, scene: Scene, aloft: Aloft | None) -> tuple[Array, Array]:
        """Twice the pose (2, nu) [rad], and its speed (2, nu) [rad/s]."""
        now = self.begin(scene.state) if aloft is None else aloft
        return np.array((now.pose, now.pose)), np.array((now.speed, now.speed))
