"""What a flight is told: its shapes, and how it lands."""

from dataclasses import field
from math import degrees

from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.aerial.landing import LandingSettings
from rotctl.behaviours.aerial.levelling import LevellingSettings
from rotctl.motion import Turn
from rotctl.settings.fields import (
    SPARSE,
    STRICT,
    Finite,
    Fraction,
    NonNegative,
    Positive,
    SomeNames,
)
from rotctl.suggestion import instead

TUCK = "tuck"  # the shape that every flight has


@validated(frozen=True, config=STRICT)
class EntrySettings:
    """A landing that is always alike.

    Attributes:
        pose: by joint name [rad].
        attitude: of the pelvis about left from upright [deg], past the whole or half turns that
            the behaviour's target is.
        bodies: that land.
    """

    pose: dict[str, Turn]
    attitude: Finite
    bodies: SomeNames


@validated(frozen=True, config=STRICT)
class MidwaySettings:
    """A shape on the way from the landing pose to the tightest.

    The straight way there is, for a part of it, a body that spins about its middle axis of inertia,
    and whatever is off grows.

    Attributes:
        amount: of the tuck at which it has this shape [-].
        pose: by joint name [rad].
    """

    amount: Fraction
    pose: dict[str, Turn]


@validated(frozen=True, config=STRICT)
class FlightSettings:
    """How a body flies.

    Attributes:
        tuck: tightest pose, by joint name [rad]; stretch: longest.
        shapes: that may be flown in its place, by name: their tightest poses.
        tightest, longest: shares of the way to them that it may go [-].
        opening: to the landing pose begins so long before it [s].
        opening_for: the turn that `opening` is for; what turns further opens later, as if by the
            angle that is left [deg]. All by default.
        change: from the landing pose to the tuck, or from the pose at take-off to the line of
            shapes, takes so long [s].
        entry: how it lands, if always alike;
        feet: if on its feet, as its motion then asks for.
        first: attitude of the pelvis that the behaviour's target counts from [deg].
        coasting: what landed turns on as if with its last speed for so long [s].
        levelling: how arms keep it in its plane; without, nothing does.
        midway: by which its shapes go from the landing pose to the tightest; straight without.
    """

    tuck: dict[str, Turn]
    stretch: dict[str, Turn]
    opening: Positive
    change: Positive
    tightest: Fraction = 1.0
    longest: Fraction = 1.0
    shapes: dict[str, dict[str, Turn]] = field(default_factory=dict)
    entry: EntrySettings | None = None
    feet: LandingSettings | None = None
    first: Finite = 0.0
    coasting: NonNegative = 0.0
    levelling: LevellingSettings | None = None
    midway: MidwaySettings | None = None
    opening_for: Positive | None = field(default=None, metadata=SPARSE)

    def __post_init__(self) -> None:
        if (self.entry is None) == (self.feet is None):
            raise ValueError("give either entry or feet, not both and not neither")
        if TUCK in self.shapes:
            raise ValueError(f"shapes: {TUCK} is flown by the pose of that name, beside them")
        for shape in self.levelling.shapes if self.levelling else ():
            if shape not in (known := (TUCK, *self.shapes)):
                raise ValueError(f"levelling: no shape {shape!r}; {instead(shape, known)}")
        if self.midway and not 0.0 < self.midway.amount < 1.0:
            raise ValueError(f"midway: its amount {self.midway.amount:g} is not between 0 and 1")

    def opened_for(self, target: float) -> float:
        """How long before the landing it opens, of a turn to a target [rad]; [s]."""
        turn = abs(degrees(target))
        if self.opening_for is None or turn <= self.opening_for:
            return self.opening
        return self.opening * self.opening_for / turn
