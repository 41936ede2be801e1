"""Linear algebra that gives the same bits on every machine: products and solves without BLAS.

numpy hands `@`, `np.dot` and `np.linalg` to a BLAS that takes other code on other processors,
and with it another order of sums. What runs between a run's start and its log keeps to the plain
loops here: numpy's einsum, which adds in one order as long as it is not asked to optimise, and
MuJoCo's Cholesky factorisation.
"""

import mujoco
import numpy as np

from rotctl.rotations import Array

_SUMS = {(1, 1): "i,i->", (1, 2): "i,ij->j", (2, 1): "ij,j->i", (2, 2): "ij,jk->ik"}


class NotPositiveDefiniteError(ArithmeticError):
    """A matrix has no Cholesky factor."""


def product(left: Array, right: Array, *more: Array) -> Array:
    """Product of vectors and matrices, from left to right; of two vectors a 0-d array."""
    result = np.einsum(_SUMS[left.ndim, right.ndim], left, right)
    return product(result, *more) if more else np.asarray(result)


def solve(matrix: Array, right: Array) -> Array:
    """X of matrix x = right, for a symmetric positive definite matrix (n, n).

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
        mujoco.mju_cholSolve(column[:, None], factor, column[:, None].copy())
    return columns.reshape(right.T.shape).T
