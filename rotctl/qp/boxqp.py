"""MuJoCo's own box-constrained solver: projected Newton on the free variables, exact."""

from dataclasses import replace

import mujoco
import numpy as np

from rotctl.qp.problem import Problem, Shape, Solution, failed, objection
from rotctl.rotations import Array

# Added to the unit diagonal of the scaled Hessian. Four generators span a contact's three
# force components, so the Hessian has a null space along which the force does not change;
# this picks one point of it, and moves torques by less than 1e-3 N m (tested).
DIAGONAL = 1e-7
# On about one problem in a thousand mju_boxQP stops short on such a Hessian. It then gets
# the solution of a better conditioned problem as its start, ever better conditioned.
LADDER = (1e-5, 1e-3, 1e-1)
TOLERANCE = 1e-6  # accepted natural residual of the scaled problem [-]
SMALLEST_WIDTH = 1e-9  # mju_boxQP refuses a lower bound equal to its upper one


class BoxQP:
    """`mju_boxQP` on the problem scaled to a unit diagonal."""

    name = "boxqp"
    shape: Shape = "bounds"

    def solve(self, problem: Problem, start: Array | None) -> Solution:
        """Solve a problem without rows; see `Solver`."""
        reason = objection(problem)
        if reason:
            return failed(problem, reason)
        solution = _try(problem, start, DIAGONAL)
        for diagonal in LADDER:
            if solution.solved:
                break
            solution = _try(problem, _try(problem, start, diagonal).x, DIAGONAL)
        if not solution.solved:
            return solution
        # One proximal step: the addition now holds x near the solution, not near zero.
        pull = DIAGONAL * (problem.H.diagonal() + 1e-12) * solution.x
        refined = _try(replace(problem, f=problem.f - pull), solution.x, DIAGONAL)
        return refined if refined.solved else solution


def _try(problem: Problem, start: Array | None, diagonal: float) -> Solution:
    n = len(problem.f)
    scale = 1.0 / np.sqrt(np.maximum(problem.H.diagonal(), 0.0) + 1e-12)
    H = problem.H * scale * scale[:, None]
    H.flat[:: n + 1] += diagonal
    f = problem.f * scale
    lower = problem.lower / scale
    upper = np.maximum(problem.upper / scale, lower + SMALLEST_WIDTH)
    guess = np.zeros(n) if start is None else start / scale
    x = np.minimum(np.maximum(guess, lower), upper)
    workspace = np.empty((n, n + 7))
    try:
        rank = mujoco.mju_boxQP(
            x[:, None], workspace, None, H, f[:, None], lower[:, None], upper[:, None]
        )
    except mujoco.FatalError as error:
        return failed(problem, str(error))
    if rank < 0:
        return failed(problem, "mju_boxQP found the Hessian not positive definite")
    step = np.minimum(np.maximum(x - (H @ x + f), lower), upper) - x
    residual = float(np.abs(step).max() / (1.0 + np.abs(x).max()))
    if not residual <= TOLERANCE:
        reason = f"residual {residual:.1e} exceeds {TOLERANCE:.0e}"
        return Solution(x * scale, False, 0, residual, reason)
    return Solution(x * scale, True, 0, residual)
