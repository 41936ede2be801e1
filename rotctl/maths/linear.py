"""Linear algebra that gives the same bits on every machine: products and solves without BLAS.

numpy hands `@`, `np.dot` and `np.linalg` to a BLAS that takes other code on other processors,
and with it another order of sums. What runs between a run's start and its log keeps to MuJoCo's
own products and Cholesky factors, which are one code for all; np.einsum adds in one order, too,
as long as it is not asked to optimise.
"""

import mujoco
import numpy as np

from rotctl.maths.rotations import Array


class NotPositiveDefiniteError(ArithmeticError):
    """A matrix has no Cholesky factor."""


def product(left: Array, right: Array, *more: Array) -> Array:
    """Product of vectors and matrices, from left to right; of two vectors a 0-d array."""
    rows = np.ascontiguousarray(left if left.ndim == 2 else left[None])
    columns = np.ascontiguousarray(right.T if right.ndim == 2 else right[None])
    found = np.empty((len(rows), len(columns)))
    mujoco.mju_mulMatMatT(found, rows, columns)
    result = found.reshape(left.shape[:-1] + right.shape[1:])
    return product(result, *more) if more else result


def solve(matrix: Array, right: Array) -> Array:
    """Solve matrix x = right for x, with a symmetric positive definite matrix (n, n).

    Args:
        right: (n,) or (n, k), as is x.

    Raises:
        NotPositiveDefiniteError: the matrix is not, to within rounding.
    """
    factor = np.array(matrix, order="C")
    rank = mujoco.mju_cholFactor(factor, mujoco.mjMINVAL)
    if rank < len(factor):
        raise NotPositiveDefiniteError(f"matrix has rank {rank} of {len(factor)}")
    columns = np.array(right.T, order="C").reshape(-1, len(factor))
    for column in columns:
        mujoco.mju_cholSolve(column, factor, column)
    return columns.reshape(right.T.shape).T
