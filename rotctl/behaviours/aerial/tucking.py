"""The shapes of a flight, on one line: 1 is fully tucked, 0 the landing pose, -1 stretched.

Which of them turns at the mean rate that is wanted until the landing, omega = |H| / I, and how
the body comes there and opens in the end.
"""

import numpy as np

from rotctl.behaviours.aerial.flight_settings import TUCK, FlightSettings
from rotctl.behaviours.aerial.landing import Contact
from rotctl.behaviours.easing import smooth
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.mechanics.shape import Shapes
from rotctl.motion import make_pose

AMOUNTS = np.arange(-10, 11) / 10.0  # of the tuck, at which inertia is tabulated
INSTANTS = (np.arange(24) + 0.5) / 24  # of the time left, at which the plan is looked at
REMAINING = 1.0 - INSTANTS
HALVINGS = 14  # of the amounts that are possible: 0.0001


class Tucking:
    """The shapes of one run's flight."""

    def __init__(
        self,
        settings: FlightSettings,
        model: Model,
        shapes: Shapes,
        axis: Array,
        usual: Contact,
        opening: float,
        key: str,
        shape: str,
    ) -> None:
        """Tabulate inertia over the shapes.

        Args:
            axis: (3,) that it turns about, in the trunk's frame.
            usual: the landing that inertia is tabulated for.
            opening: how long before the landing it opens [s].
            key: where the settings stand.
            shape: that it flies in.

        Raises:
            InputError: a joint is not there.
        """
        self._settings, self._opening = settings, opening
        tucks = {TUCK: make_pose(model, settings.tuck, f"{key}.tuck")}
        for name, pose in settings.shapes.items():
            tucks[name] = make_pose(model, pose, f"{key}.shapes.{name}")
        self._tuck = tucks[shape]
        self._stretch = make_pose(model, settings.stretch, f"{key}.stretch")
        self._midway: tuple[float, Array] | None = None
        if settings.midway:
            by_way = make_pose(model, settings.midway.pose, f"{key}.midway.pose")
            self._midway = settings.midway.amount, by_way
        self.slowness = np.array(
            [1.0 / shapes.inertia(self.pose(a, usual), axis) for a in AMOUNTS.tolist()]
        )
        self.landing_slowness = float(self.slowness[len(AMOUNTS) // 2])

    def pose(self, amount: float, contact: Contact) -> Array:
        """The shape (nu,) of an amount of tuck [rad]."""
        if self._midway and amount > 0.0:
            at, pose = self._midway
            if amount <= at:
                return np.asarray(contact.pose + (amount / at) * (pose - contact.pose))
            return np.asarray(pose + ((amount - at) / (1.0 - at)) * (self._tuck - pose))
        end = self._tuck if amount >= 0.0 else self._stretch
        return np.asarray(contact.pose + abs(amount) * (end - contact.pose))

    def held(self, time: float) -> float:
        """What is held of an amount so long before the landing [s]."""
        return smooth(min(time / self._opening, 1.0))

    def mean_slowness(self, amount: float, now: float, time: float) -> float:
        """Mean of 1/I until the landing [1/(kg m2)].

        Args:
            amount: that it goes to, until it opens; now: the present one.
            time: left [s].
        """
        return self._mean_slowness(amount, now, *self._plan(time))

    def _plan(self, time: float) -> tuple[Array, Array]:
        """What is held of an amount at `INSTANTS` of the time left [s], and gone of its change."""
        held = smooth(np.minimum(REMAINING * (time / self._opening), 1.0))
        return held, smooth(np.minimum(INSTANTS * (time / self._settings.change), 1.0))

    def _mean_slowness(self, amount: float, now: float, held: Array, gone: Array) -> float:
        amounts = now + (amount * held - now) * gone
        return float(np.interp(amounts, AMOUNTS, self.slowness).sum()) / len(INSTANTS)

    def amount(self, need: float, momentum: float, now: float, time: float) -> float:
        """Of tuck whose mean rate |H|/I over the time left [s] makes the turn, by bisection.

        Args:
            need: to turn [rad]; momentum: in that sense [kg m2/s].
            now: the present amount.
        """
        low, high = -self._settings.longest, self._settings.tightest
        held, gone = self._plan(time)

        def falls_short(amount: float) -> bool:
            return momentum * self._mean_slowness(amount, now, held, gone) * time < need

        if falls_short(high):
            return high
        if not falls_short(low):
            return low
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if falls_short(middle) else (low, middle)
        return 0.5 * (low + high)
