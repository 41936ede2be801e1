"""How smoothly a roll goes, and how it overcomes a push."""

import math
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from rotctl.metrics.columns import Arrays, floats, joint_rates
from rotctl.metrics.loads import taken

LIGHT = 7.0  # [N] a hundredth of an adult: the ground hardly carries what it gives less than that


class Limits(Protocol):
    """What of the criteria a push is judged by; see `RollingCriteria`."""

    @property
    def stall_time(self) -> float:
        """In which progress is looked at [s]."""
        ...

    @property
    def recovery_time(self) -> float:
        """In which a push should be overcome [s]."""
        ...

    @property
    def recovery_heading(self) -> float:
        """To which the axis should be back [deg]."""
        ...

    @property
    def recovery_progress(self) -> float:
        """In the stall time from then on [rev]."""
        ...


def jerk(log: Arrays, period: float) -> float:
    """Of the joints, from the second difference of their velocities; NaN for too few rows."""
    jerk = np.diff(joint_rates(log), 2, axis=0) / period**2
    return float(np.sqrt((jerk**2).mean())) if len(jerk) else math.nan


def use_of_contacts(log: Arrays, period: float) -> dict[str, float]:
    """`chatter` and `sticking`: how control takes up contacts, and what it keeps without need.

    chatter: bodies that it takes up or lets go of, a second; NaN for too few rows.
    sticking: share of the time and of the bodies that control keeps still, in which hardly a force
    acts: what the ground does not carry would be free to leave it. NaN where it never uses one.
    """
    row, slot, body = taken(log)
    steps, bodies = len(log["contacts/body"]), int(body.max(initial=0)) + 1
    place = row * bodies + body
    held = np.zeros(steps * bodies, dtype=bool)
    held[place[np.asarray(log["contacts/used"][row, slot])]] = True
    each = np.asarray(log["contacts/force_realised"][row, slot], dtype=float)
    carried = np.bincount(place, np.sqrt((each**2).sum(axis=1)), held.size)
    by_row = held.reshape(steps, bodies)
    changes = np.count_nonzero(by_row[1:] != by_row[:-1])
    return {
        "chatter": changes / ((steps - 1) * period) if steps > 1 else math.nan,
        "sticking": float((carried[held] < LIGHT).mean()) if held.any() else math.nan,
    }


def recovery(
    log: Arrays,
    limits: Limits,
    progress: NDArray[np.float64],
    axis: NDArray[np.float64],
    period: float,
    whole: bool,
) -> dict[str, Any]:
    """How a roll overcomes what acted from outside: `recovery` [s] and `recovered`.

    The axis is its mean over a second: a roll sways. A run that is whole and was over before it
    could be told whether it rolls on in time says nothing; one that broke off has not recovered.
    """
    wrench = floats(log, "disturbance/wrench") if "disturbance/wrench" in log else np.zeros((0, 6))
    acted = np.flatnonzero(wrench.any(axis=1))
    if not len(acted) or acted[-1] + 1 >= len(progress):
        return {"recovery": math.nan, "recovered": math.nan}
    second, ahead = round(1.0 / period), round(limits.stall_time / period)
    first, last = int(acted[-1]) + 1, len(progress) - max(second, ahead)
    for row in range(first, last):
        x, y, _ = axis[row : row + second].mean(axis=0).tolist()
        along = abs(math.degrees(math.atan2(-x, y))) < limits.recovery_heading
        if along and progress[row + ahead] - progress[row] >= limits.recovery_progress:
            taken = (row - first) * period
            return {"recovery": taken, "recovered": float(taken <= limits.recovery_time)}
    untold = whole and last <= first + round(limits.recovery_time / period)
    return {"recovery": math.nan, "recovered": math.nan if untold else 0.0}
