"""Least squares within bounds, for some ten unknowns: the same bits on every processor.

Levenberg and Marquardt's way, with steps clipped at the bounds; an unknown at its bound that would
go on beyond it stands still [Kelley1999] ch. 5.4.
"""

from collections.abc import Callable

import numpy as np

from rotctl.maths.linear import product, solve
from rotctl.maths.rotations import Array

DIFFERENCE = 1e-6  # of an unknown, for slopes
STEPS = 500  # from some start of a limb a dozen are enough
CLOSE = 1e-10  # largest change of an unknown, at which it is there
TIMID, BOLD = 1e-4, 0.3  # damping at first; what it is multiplied by after a step that helps
MOST_DAMPED = 1e8  # where no step helps any more


def least_squares(missed: Callable[[Array], Array], start: Array, low: Array, high: Array) -> Array:
    """The unknowns (n,) at a least sum of squares, as near as `start` leads.

    Args:
        missed: what is to be small (m,), of the unknowns.
        low, high: bounds (n,).
    """
    at = np.clip(start, low, high)
    misses, damping = missed(at), TIMID
    for _ in range(STEPS):
        slopes = _slopes(missed, at)
        downhill = -product(slopes.T, misses)
        free = np.flatnonzero(~(((at <= low) & (downhill < 0)) | ((at >= high) & (downhill > 0))))
        if not free.size:
            return np.asarray(at)
        square = product(slopes.T[free], slopes.T[free].T)
        while True:
            step = np.zeros(len(at))
            step[free] = solve(square + damping * np.eye(len(free)), downhill[free])
            tried = np.clip(at + step, low, high)
            new = missed(tried)
            if product(new, new) <= product(misses, misses) or damping > MOST_DAMPED:
                break
            damping *= 4.0
        moved = float(np.abs(tried - at).max())
        if damping > MOST_DAMPED:
            return np.asarray(at)
        at, misses, damping = tried, new, BOLD * damping
        if moved < CLOSE:
            break
    return np.asarray(at)


def _slopes(missed: Callable[[Array], Array], at: Array) -> Array:
    """Jacobian (m, n) of what is missed, by central differences."""
    columns = []
    for k in range(len(at)):
        step = np.zeros(len(at))
        step[k] = DIFFERENCE
        columns.append((missed(at + step) - missed(at - step)) / (2.0 * DIFFERENCE))
    return np.array(columns).T
