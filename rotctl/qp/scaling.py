"""A box-constrained problem in variables that give its Hessian a unit diagonal."""

from dataclasses import dataclass

import numpy as np

from rotctl.qp.problem import Problem, Solution
from rotctl.rotations import Array

SMALLEST_WIDTH = 1e-9  # mju_boxQP refuses a lower bound equal to its upper one


@dataclass(frozen=True)
class Scaled:
    """min 1/2 z'Hz + f'z, lower <= z <= upper, in z = x / scale."""

    scale: Array
    H: Array
    f: Array
    lower: Array
    upper: Array

    def solution(self, z: Array, tolerance: float) -> Solution:
        """The answer z in the problem's own variables, solved if its residual is small."""
        residual = natural_residual(self.H, self.f, self.lower, self.upper, z)
        if residual <= tolerance:
            return Solution(z * self.scale, True, 0, residual)
        reason = f"residual {residual:.1e} exceeds {tolerance:.0e}"
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
    step = np.minimum(np.maximum(z - (H @ z + f), lower), upper) - z
    return float(np.abs(step).max() / (1.0 + np.abs(z).max()))
