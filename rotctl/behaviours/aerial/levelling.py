"""What a flight does against momentum across its way: one arm leaves the other.

H does not change in the air. What of it lies across the way tilts the body aside, and in the end
it enters leaning. A body whose arms are not alike turns otherwise: its main axes are tilted, and
to move an arm aside turns the rest the other way, more in a tuck than stretched. Simulated
gymnasts keep somersaults from twisting by such arms [Yeadon1996].

So the flight that is planned is looked at to its end: Euler's equations over the shapes that the
regulator is going to take, with an amount of arm held from now until the body opens, and with a
little more and a little less. What brings the body's length nearest to the plane at the landing
is taken; and what of the turn about left is then missed goes back to the regulator.

[Yeadon1996] Yeadon, Mikulcik, The control of non-twisting somersaults using configuration
changes, J. Biomechanics 29(10).
"""

from collections.abc import Callable
from math import atan2, ceil, exp, pi, tau
from typing import NamedTuple

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.easing import soonest
from rotctl.maths.rotations import Array, Triple, advanced, crossed, dotted, rotated
from rotctl.mechanics.model import Model
from rotctl.mechanics.shape import Shapes, Spin
from rotctl.motion import Turn, make_pose
from rotctl.motion.sides import mirrored_angles
from rotctl.settings.fields import STRICT, Names, NonNegative, Positive

STEP = 0.05  # [s] of the plan, in which the body turns by up to 60 degrees
LEAST_PARTS, MOST_PARTS = 6, 100  # of the plan: one from the stratosphere takes no longer
WAYS = (0.3, 0.1, 0.03)  # of the amount, by which it is changed in turn to see what comes of it
CATCHING_UP = 0.08  # [s] in which joints come to where they should be
LATEST = 0.05  # [s] before the landing nothing helps any more
LEARNED = 0.3  # of what is missed in the plane, at once
MOST_LEARNED = 0.15  # [rad]


@validated(frozen=True, config=STRICT)
class LevellingSettings:
    """How arms keep a flight in its plane.

    Attributes:
        arms: joints of the left side and how far they leave the shape at most, by name [rad]; to
            the other side it is their mirror image.
        interval: between two looks at the plan [s].
        twist: weight of facing aside at the landing, beside leaning aside [-].
        effort: weight of the amount itself [-].
        shapes: of the flight, with which arms do so; with all, if none is named.
    """

    arms: dict[str, Turn]
    interval: Positive
    twist: NonNegative
    effort: NonNegative
    shapes: Names = ()


class Levelled(NamedTuple):
    """What levelling remembers.

    Attributes:
        amount: of the arms' leaving, to the left or to the right [-]; rate: of it [1/s].
        wanted: held until the body opens [-].
        missed: of the turn in the plane, as seen so far [rad].
        looked: when the plan was looked at last [s]; looks: how often.
    """

    amount: float = 0.0
    rate: float = 0.0
    wanted: float = 0.0
    missed: float = 0.0
    looked: float = -np.inf
    looks: int = 0


class Ahead(NamedTuple):
    """The flight that is left.

    Attributes:
        time: left [s]; now: it is now [s].
        attitude: quaternion of the pelvis, world.
        angular: (3,) H about the centre of mass, world [kg m2/s].
        angles: (nu,) of the joints [rad].
        pose: that is planned after so long [s], both arms alike (nu,) [rad].
        opened: share of an amount that is held after so long [s].
        gone: share of a change that is done after so long [s].
        axes: rows are the behaviour's forward, left and up.
        goal: pitch of the pelvis at the landing, in the sense of the flight [rad].
        sense: of the flight about left.
    """

    time: float
    now: float
    attitude: tuple[float, ...]
    angular: list[float]
    angles: Array
    pose: Callable[[float], Array]
    opened: Callable[[float], float]
    gone: Callable[[float], float]
    axes: list[list[float]]
    goal: float
    sense: float


class Levelling:
    """The law of one model."""

    def __init__(
        self, settings: LevellingSettings, model: Model, shapes: Shapes, change: float, key: str
    ) -> None:
        """Read the arms.

        Args:
            change: an amount goes from 0 to 1 in so long [s].
            key: where the settings stand.

        Raises:
            InputError: a joint is not there.
        """
        self._settings, self._shapes, self._change = settings, shapes, change
        self._left = make_pose(model, settings.arms, f"{key}.arms")
        other = mirrored_angles(model, settings.arms)
        self._right = make_pose(model, other, f"{key}.arms")

    def offset(self, amount: float) -> Array:
        """What of an amount of tilt is added to a shape (nu,) [rad]."""
        return np.asarray(abs(amount) * (self._left if amount >= 0.0 else self._right))

    def advance(self, before: Levelled, ahead: Ahead, period: float) -> Levelled:
        """One control period [s] on."""
        settings, now = self._settings, before
        due = ahead.now - before.looked >= settings.interval - 1e-9
        if due and ahead.time > LATEST:
            wanted, missed = self._better(before, ahead)
            learned = before.missed + LEARNED * missed
            learned = min(max(learned, -MOST_LEARNED), MOST_LEARNED)
            now = before._replace(
                wanted=wanted, missed=learned, looked=ahead.now, looks=before.looks + 1
            )
        held = now.wanted * ahead.opened(0.0)
        amount, rate = soonest(held, now.amount, now.rate, self._change, period)
        return now._replace(amount=amount, rate=rate)

    def _better(self, now: Levelled, ahead: Ahead) -> tuple[float, float]:
        """A better amount, and how far the turn in the plane misses with the present one [rad]."""
        best, missed = self._cost(now.amount, now.wanted, ahead)
        wanted, way = now.wanted, WAYS[now.looks % len(WAYS)]
        for other in (max(now.wanted - way, -1.0), min(now.wanted + way, 1.0)):
            cost, _ = self._cost(now.amount, other, ahead)
            if cost < best:
                best, wanted = cost, other
        return wanted, missed

    def _cost(self, amount: float, wanted: float, ahead: Ahead) -> tuple[float, float]:
        """Of leaning and facing aside at the landing, and of arms; and what is missed [rad]."""
        settings, (forward, left, up) = self._settings, ahead.axes
        end = self._landed(amount, wanted, ahead)
        side, top = (rotated(end, axis) for axis in ((0, 1, 0), (0, 0, 1)))
        leans, faces = dotted(top, left), dotted(side, forward)
        cost = leans * leans + settings.twist * faces * faces + settings.effort * wanted * wanted
        pitch = atan2(dotted(top, forward), dotted(top, up))  # of its length, however it faces
        return cost, (ahead.sense * (pitch - ahead.goal) + pi) % tau - pi

    def _landed(self, amount: float, wanted: float, ahead: Ahead) -> tuple[float, ...]:
        """Attitude of the pelvis at the landing, by Euler's equations over the planned shapes."""
        parts = min(max(LEAST_PARTS, ceil(ahead.time / STEP)), MOST_PARTS)
        step = ahead.time / parts

        def planned(time: float) -> Array:
            aside = amount + (wanted * ahead.opened(time) - amount) * ahead.gone(time)
            return ahead.pose(time) + self.offset(aside)

        poses = [planned(part * step) for part in range(parts + 1)]
        behind = ahead.angles - poses[0]
        poses = [p + exp(-i * step / CATCHING_UP) * behind for i, p in enumerate(poses)]
        turn = ahead.attitude
        for start, end in zip(poses[:-1], poses[1:], strict=True):
            spin = self._shapes.spin(0.5 * (start + end), (end - start) / step)
            half = _rate(turn, ahead.angular, spin)
            middle = advanced(turn, [0.5 * step * rate for rate in half])
            rate = _rate(middle, ahead.angular, spin)
            turn = advanced(turn, [step * r for r in rate])
        return turn


def _rate(attitude: tuple[float, ...], angular: list[float], spin: Spin) -> Triple:
    """Angular velocity of the pelvis, world [rad/s]: I omega = H - what joints' motion has."""
    w, x, y, z = attitude
    own = rotated((w, -x, -y, -z), angular)
    a, b, c = (h - moving for h, moving in zip(own, spin.angular, strict=True))
    return rotated(attitude, _solved(spin.inertia, (a, b, c)))


def _solved(matrix: tuple[Triple, Triple, Triple], right: Triple) -> Triple:
    """Solve a symmetric (3, 3) matrix x = right, by Cramer's rule.

    In plain numbers: some forty times a control step.
    """
    a, b, c = matrix
    ab, bc, ca = crossed(a, b), crossed(b, c), crossed(c, a)
    whole = dotted(a, bc)
    x, y, z = right
    return (
        (x * bc[0] + y * ca[0] + z * ab[0]) / whole,
        (x * bc[1] + y * ca[1] + z * ab[1]) / whole,
        (x * bc[2] + y * ca[2] + z * ab[2]) / whole,
    )
