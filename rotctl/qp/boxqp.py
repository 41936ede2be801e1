"""MuJoCo's own box-constrained solver: projected Newton on the free variables, exact."""

import mujoco
import numpy as np

from rotctl.maths.rotations import Array
from rotctl.qp.problem import Problem, Shape, Solution, failed, objection
from rotctl.qp.scaling import DIAGONAL, TOLERANCE, natural_residual, scale


class BoxQP:
    """`mju_boxQP` on the problem scaled to a unit diagonal."""

    name = "boxqp"
    shape: Shape = "bounds"

    def solve(self, problem: Problem, start: Array | None) -> Solution:
        """Solve a problem without rows; see `Solver`."""
        reason = objection(problem)
        if reason:
            return failed(problem, reason)
        scaled = scale(problem)
        lower, upper = scaled.lower, scaled.upper
        H, x = scaled.regularised(), scaled.start(start)
        reason = _minimise(H, scaled.f, lower, upper, x)
        if reason:
            return failed(problem, reason)
        # One proximal step: the addition now holds x near the solution, not near zero.
        refined = x.copy()
        if not _minimise(H, scaled.f - DIAGONAL * x, lower, upper, refined):
            x = refined
        return scaled.solution(x)


def _minimise(H: Array, f: Array, lower: Array, upper: Array, x: Array) -> str:
    """`mju_boxQP` from and into `x` (n,); why it failed, or nothing."""
    workspace = np.empty((len(f), len(f) + 7))
    bounds = (lower[:, None], upper[:, None])
    try:
        rank = mujoco.mju_boxQP(x[:, None], workspace, None, H, f[:, None], *bounds)
    except mujoco.FatalError as error:
        return str(error)
    if rank < 0:
        return "mju_boxQP found the Hessian not positive definite"
    residual = natural_residual(H, f, lower, upper, x)
    return "" if residual <= TOLERANCE else f"residual {residual:.1e} exceeds {TOLERANCE:.0e}"
