"""Complementarity with box friction by projected Gauss-Seidel: in numpy, and the same in C.

Row velocities are w = A p + b for impulses p. A unilateral row (a contact's normal, a joint
limit) wants 0 <= p and 0 <= w, one of them zero. A friction row belongs to a normal row n and
wants w = 0 with |p| <= mu p_n, or |p| = mu p_n against w. [Brown2013] eq. 8, after [Erleben2007].

The plain method bounds friction by the normal impulse of the moment. In up to one state of 200 of
a roll it then goes round in circles for ever, several dm/s from a solution that does exist. A
bound that goes only part of the way, `follow`, towards each new mu p_n finds it.
"""

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from rotctl.errors import RotctlError
from rotctl.maths.rotations import Array
from rotctl.native import library

NO_NORMAL = -1


@dataclass(frozen=True)
class Rows:
    """The rows of one problem.

    Attributes:
        A: (n, n) symmetric, positive on its diagonal [1/kg].
        b: (n,) velocities without impulses, less the wanted ones [m/s].
        normal: (n,) the normal row that bounds a friction row; `NO_NORMAL` for others.
        friction: (n,) mu of friction rows [-].
    """

    A: Array
    b: Array
    normal: NDArray[np.int32]
    friction: Array


@dataclass(frozen=True)
class Impulses:
    """A solution, or as far as the sweeps came.

    Attributes:
        p: (n,) [N s].
        sweeps: made.
        residual: largest velocity that one more projection of a row would change [m/s].
    """

    p: Array
    sweeps: int
    residual: float


Solve = Callable[[Rows, int, float, float], Impulses]


def solve(rows: Rows, sweeps: int, tolerance: float, follow: float) -> Impulses:
    """Sweep over the rows from p = 0 until none changes by more than `tolerance` [m/s].

    Args:
        sweeps: at most so many.
        follow: how far a friction bound goes towards mu p_n in a sweep; 1 is the plain method.
    """
    A, w, diagonal = rows.A, rows.b.copy(), rows.A.diagonal()
    p, bound = np.zeros(len(w)), np.zeros(len(w))
    sweep, change = 0, np.inf
    while sweep < sweeps and not change <= tolerance:
        change = 0.0
        for i, normal in enumerate(rows.normal):
            if normal != NO_NORMAL:
                bound[i] += follow * (rows.friction[i] * p[normal] - bound[i])
            step = _projected(p[i] - w[i] / diagonal[i], normal, bound[i]) - p[i]
            if step != 0.0:
                w += step * A[i]
                change = max(change, abs(step) * diagonal[i])
                p[i] += step
        sweep += 1
    most = np.where(rows.normal == NO_NORMAL, 0.0, rows.friction * p[rows.normal])
    last = [_projected(*row) for row in zip(p - w / diagonal, rows.normal, most, strict=True)]
    return Impulses(p, sweep, float(np.max(np.abs(last - p) * diagonal, initial=0.0)))


def _projected(x: float, normal: int, most: float) -> float:
    """A row's impulse brought between its bounds."""
    if normal == NO_NORMAL:
        return max(x, 0.0)
    return min(max(x, -most), most)


def solve_compiled(rows: Rows, sweeps: int, tolerance: float, follow: float) -> Impulses:
    """As `solve`, in C; `library()` must be there."""
    n, residual = len(rows.b), ctypes.c_double()
    p, bound, w = np.zeros((3, n))
    arrays = (rows.A, rows.b, rows.normal, rows.friction)
    kept = [np.ascontiguousarray(array) for array in arrays]
    done = _function()(
        n,
        *(array.ctypes.data for array in kept),
        sweeps,
        tolerance,
        follow,
        p.ctypes.data,
        bound.ctypes.data,
        w.ctypes.data,
        ctypes.byref(residual),
    )
    return Impulses(p, done, residual.value)


@lru_cache(maxsize=1)
def _function() -> Callable[..., int]:
    found = library()
    if found is None:
        raise RotctlError("the compiled contact solver is not built")
    function: Callable[..., int] = found.rotctl_pgs
    function.argtypes = [  # type: ignore[attr-defined]
        ctypes.c_int,
        *[ctypes.c_void_p] * 4,
        ctypes.c_int,
        *[ctypes.c_double] * 2,
        *[ctypes.c_void_p] * 4,
    ]
    return function
