"""From one value to another without a jump of speed: along a course, or soonest."""

from math import copysign, sqrt
from typing import TypeVar

from rotctl.maths.rotations import Array

SETTLING = 4.0  # [periods] in which a value comes near, so that it does not overshoot

Share = TypeVar("Share", float, Array)


def smooth(share: Share) -> Share:
    """From 0 to 1 with no speed at either end."""
    return share * share * (3.0 - 2.0 * share)


def soonest(
    wanted: float, value: float, rate: float, change: float, period: float
) -> tuple[float, float]:
    """A value and its rate [1/s] a period [s] on; it goes from 0 to 1 in `change` [s]."""
    most, way = 4.0 / change**2, wanted - value
    fastest = min(sqrt(2.0 * most * abs(way)), abs(way) / (SETTLING * period))
    rate += min(max(copysign(fastest, way) - rate, -most * period), most * period)
    return value + rate * period, rate
