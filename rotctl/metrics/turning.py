"""Progress in turning: where it stalls or falls back, and the revolutions that it is made of."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def longest_stall(progress: Array, least: float, period: float) -> tuple[float, float]:
    """Longest time [s] in which `progress` (n,) grew by less than `least`, and its start [s].

    A stall begins when progress last exceeded its previous mark by `least`, and lasts until
    it does so again, or the run ends. From between two marks so much may take longer, less than
    twice as long.
    """
    values = progress.tolist()  # plain numbers, which are compared in a fifth of the time
    mark, since = values[0], 0
    longest, begin = 0, 0
    for i, value in enumerate(values):
        if value >= mark + least:
            mark, since = value, i
        if i - since > longest:
            longest, begin = i - since, since
    return longest * period, begin * period


def setback(progress: Array) -> float:
    """How far progress (n,) fell below the furthest that it had come to."""
    return float((np.maximum.accumulate(progress) - progress).max())


def revolutions(progress: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First and last rows of every revolution, wherever in the roll it is counted from.

    Args:
        progress: (n,) [rev].

    Returns:
        For each row by which a whole revolution has been made, the latest row that lies one
        revolution before it, and that row.
    """
    furthest = np.maximum.accumulate(progress)
    last = np.flatnonzero(furthest >= progress[0] + 1.0)
    first = np.searchsorted(furthest, furthest[last] - 1.0, side="right") - 1
    return np.maximum(first, 0), last


def turned_about(axis: Array, orientation: Array) -> Array:
    """How far a body has turned about an axis of its own since the first row (n,) [rev].

    A row adds the chord of its turn, which is 1 % short of it at 0.5 rad.

    Args:
        axis: (n, 3) world axis, unit.
        orientation: (n, 4) unit quaternions.
    """
    before, after = orientation[:-1], orientation[1:]
    half = before[:, :1] * after[:, 1:] - after[:, :1] * before[:, 1:]
    (a, b, c), (x, y, z) = after[:, 1:].T, before[:, 1:].T
    half -= np.stack((b * z - c * y, c * x - a * z, a * y - b * x), axis=1)
    same_way = np.where((before * after).sum(axis=1) < 0.0, -1.0, 1.0)  # q and -q are one turn
    turns = 2.0 * same_way * (half * axis[:-1]).sum(axis=1)
    return np.concatenate(([0.0], np.cumsum(turns))) / (2.0 * np.pi)


def within(first: NDArray[np.int64], last: NDArray[np.int64], each: Array) -> Array:
    """Sum over the rows from `first` up to `last` (k,) of what each row (n,) adds."""
    total = np.concatenate(([0.0], np.cumsum(each)))
    return np.asarray(total[last] - total[first])
