"""Where a schedule says 0 it asks for a halt: to stand still is no stall then, but the task."""

from collections.abc import Sequence
from math import tau

import numpy as np
from numpy.typing import NDArray

from rotctl.metrics.columns import Arrays, Column, in_frame
from rotctl.metrics.turning import longest_stall

COLUMNS = (
    Column("halt_commanded", "Told to halt from", "s"),
    Column("halted", "Longest that it stood still while told to", "s"),
)
STILL = 1.0  # [s] for which a halt is kept at least
LONG = 3.0  # [s] a shorter one has no room for that: it goes on to a squat first, and that stops it

Halts = Sequence[tuple[float, float]]


def going(time: NDArray[np.float64], halts: Halts) -> NDArray[np.bool_]:
    """Whether it is to roll, at each time (n,) [s].

    Args:
        halts: when each begins and ends [s].
    """
    rolls = np.ones(len(time), dtype=bool)
    for begin, end in halts:
        rolls &= (time < begin) | (time >= end)
    return rolls


def measure(log: Arrays, halts: Halts, least: float, period: float) -> dict[str, float]:
    """Columns of a run that is told to halt; none of one that is not, or is over by then.

    Args:
        halts: when each begins and ends [s].
        least: who makes less than that is still [rev].
        period: of the control [s].
    """
    progress = in_frame(log, "trajectory/angular_excursion")[:, 1] / tau
    time = period * np.arange(len(progress))
    spans = [progress[(time >= begin) & (time < end)] for begin, end in halts]
    stood = [longest_stall(span, least, period)[0] for span in spans if len(span)]
    return {"halt_commanded": halts[0][0], "halted": max(stood)} if stood else {}


def unkept(
    time: NDArray[np.float64],
    progress: NDArray[np.float64],
    halts: Halts,
    least: float,
    period: float,
) -> float | None:
    """When the first halt that it did not keep began [s]; None if it kept all.

    A halt is kept by who at some time in it makes less than `least` [rev] in a second: who is told
    on his back goes on to the squat first. Halts of less than three seconds are not looked at.

    Args:
        time, progress: (n,) [s, rev].
        period: from one of them to the next [s].
    """
    for begin, end in halts:
        within = (time >= begin) & (time < end)
        if round(within.sum() * period, 6) < LONG:
            continue
        rested, _ = longest_stall(progress[within], least, period)
        if rested < STILL:
            return begin
    return None
