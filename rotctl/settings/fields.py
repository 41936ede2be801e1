"""The validated, frozen dataclasses that settings everywhere in rotctl are made of."""

from itertools import pairwise
from typing import Annotated

from pydantic import AfterValidator, AllowInfNan, ConfigDict, Field, Strict

STRICT = ConfigDict(defer_build=True, extra="forbid")
# Of a field that is left out of plain data where it has no value: what a joint may have, say, and
# most have not.
SPARSE = {"sparse": True}
MOST_PARTS = 20  # of a chain of behaviours


def _sorted_pair(pair: tuple[float, float]) -> tuple[float, float]:
    if pair[0] > pair[1]:
        raise ValueError(f"the range [{pair[0]:g}, {pair[1]:g}] is empty: low must not exceed high")
    return pair


# Strict: a whole number will do for a float, but "1.0" or true will not. -0 is 0: it is the same
# number, and would be another run.
Finite = Annotated[float, Strict(), AllowInfNan(False), AfterValidator((0.0).__add__)]
Positive = Annotated[float, Strict(), AllowInfNan(False), Field(gt=0)]
NonNegative = Annotated[float, Strict(), AllowInfNan(False), Field(ge=0), AfterValidator(abs)]
Fraction = Annotated[NonNegative, Field(le=1)]
HalfTurn = Annotated[NonNegative, Field(le=3.15)]  # [rad] to either side: nothing turns further
Vector = tuple[Finite, Finite, Finite]
NonNegativeVector = tuple[NonNegative, NonNegative, NonNegative]
Range = Annotated[tuple[Finite, Finite], AfterValidator(_sorted_pair)]


def _narrowed(drawn: float | tuple[float, float]) -> float | tuple[float, float]:
    """A range without width as the number that it is: written otherwise it would be another run."""
    low, high = ends(drawn)
    return drawn if low < high else low


# Drawn from a range; a number stands for itself.
Drawn = Annotated[Finite | Range, AfterValidator(_narrowed)]


def ends(drawn: float | tuple[float, float]) -> tuple[float, float]:
    """The ends of what is drawn from a range."""
    return drawn if isinstance(drawn, tuple) else (drawn, drawn)


def each_once(names: tuple[str, ...]) -> tuple[str, ...]:
    """Names none of which comes twice: the second would make another run and, mostly, no more."""
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"names {name:.60} twice")
    return names


Names = Annotated[tuple[str, ...], AfterValidator(each_once)]
SomeNames = Annotated[Names, Field(min_length=1)]


Schedule = tuple[tuple[float, float], ...]  # times, and what holds from each on


def _growing(schedule: Schedule) -> Schedule:
    if any(later <= time for (time, _), (later, _) in pairwise(schedule)):
        raise ValueError("its times must grow")
    return schedule


GROWING = AfterValidator(_growing)
