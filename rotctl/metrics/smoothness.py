"""How smoothly a roll goes, and how it overcomes a push."""

import math
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from rotctl.metrics.columns import Arrays, floats, slots_taken

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
    jerk = np.diff(floats(log, "trajectory/qvel")[:, 6:], 2, axis=0) / period**2
    return float(np.sqrt((jerk**2).mean())) if len(jerk) else math.nan


def chatter(log: Arrays, period: float) -> float:
    """Bodies that control takes up or lets go of, a second; NaN for too few rows."""
    held = _held(log)
    if len(held) < 2:
        return math.nan
    return float((held[1:] != held[:-1]).sum() / ((len(held) - 1) * period))


def sticking(log: Arrays) -> float:
    """Share of the time and of the bodies that control keeps still, in which hardly a force acts.

    What the ground does not carry would be free to leave it. NaN where control never uses one.
    """
    held, some = _held(log), slots_taken(log)
    each = np.asarray(log["contacts/force_realised"])[:, :some].astype(float)
    force = np.sqrt((each**2).sum(axis=2))
    body = np.asarray(log["contacts/body"])[:, :some]
    carried = np.zeros(held.shape)
    rows, slots = np.nonzero(force)
    np.add.at(carried, (rows, body[rows, slots]), force[rows, slots])
    return float((carried[held] < LIGHT).mean()) if held.any() else math.nan


def _held(log: Arrays) -> NDArray[np.bool_]:
    """Which bodies (steps, n) control keeps still on the ground."""
    some = slots_taken(log)
    body, used = (np.asarray(log[f"contacts/{name}"])[:, :some] for name in ("body", "used"))
    held = np.zeros((len(body), int(body.max(initial=0)) + 1), dtype=bool)
    rows, slots = np.nonzero(used)
    held[rows, body[rows, slots]] = True
    return held


def recovery(
    log: Arrays,
    limits: Limits,
    progress: NDArray[np.float64],
    axis: NDArray[np.float64],
    period: float,
) -> dict[str, Any]:
    """How a roll overcomes what acted from outside: `recovery` [s] and `recovered`.

    The axis is its mean over a second: a roll sways.
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
    return {"recovery": math.nan, "recovered": 0.0}
