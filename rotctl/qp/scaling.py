"""A box-constrained problem in variables that give its Hessian a unit diagonal."""

from dataclasses import dataclass

import numpy as np

from rotctl.maths.linear import product
from rotctl.maths.rotations import Array
from rotctl.qp.problem import Problem, Solution

# Added to the unit diagonal of the scaled Hessian. Four generators span a contact's three
# force components, so the Hessian has a null space along which the force does not change;
# this picks one point of it. It is far below the smallest eigenvalue beside it, which is about
# 1e-8 where a stiff contact is held by torques at their limits.
DIAGONAL = 1e-10
TOLERANCE = 1e-6  # accepted natural residual of the scaled problem [-]
SMALLEST_WIDTH = 1e-9  # mju_boxQP refuses a lower bound equal to its upper one


@dataclass(frozen=True)
class Scaled:
    """min 1/2 z'Hz + f'z, lower <= z <= upper, in z = x / scale."""

    scale: Array
    H: Array
    f: Array
    lower: Array
    upper: Array

    def regularised(self) -> Array:
        """The Hessian with `DIAGONAL` added (n, n)."""
        H = self.H.copy()
        H.flat[:: len(self.f) + 1] += DIAGONAL
        return H

    def start(self, guess: Array | None) -> Array:
        """A point z (n,) inside the bounds: the guess of x, or zero, brought there."""
        z = np.zeros(len(self.f)) if guess is None else guess / self.scale
        return np.asarray(np.minimum(np.maximum(z, self.lower), self.upper))

    def solution(self, z: Array) -> Solution:
        """The answer z in the problem's own variables, solved if its residual is small."""
        residual = natural_residual(self.H, self.f, self.lower, self.upper, z)
        if residual <= TOLERANCE:
            return Solution(z * self.scale, True, 0, residual)
        reason = f"residual {residual:.1e} exceeds {TOLERANCE:.0e}"
        return Solution(z * self.scale, False, 0, residual, reason)


def scale(problem: Problem) -> Scaled:
    """Scale a problem without rows."""
    factor = 1.0 / np.sqrt(np.maximum(problem.H.diagonal(), 0.0) + 1e-12)
    lower = problem.lower / factor
    return Scaled(
        scale=factor,
        H=problem.H * factor * factor[:, None],
        f=problem.f * factor,
        lower=lower,
        upper=np.maximum(problem.upper / factor, lower + SMALLEST_WIDTH),
    )


def natural_residual(H: Array, f: Array, lower: Array, upper: Array, z: Array) -> float:
    """Relative length of the projected gradient step from z; 0 at the solution."""
    step = np.minimum(np.maximum(z - (product(H, z) + f), lower), upper) - z
    return float(np.abs(step).max() / (1.0 + np.abs(z).max()))
