"""OSQP, arranged for small dense problems that change entirely from step to step.

One workspace per problem size keeps OSQP's setup (more than half of a fresh solve) out of
the loop; columns are scaled by the Hessian's diagonal, the cost by its gradient, rows to
unit length, and OSQP's own scaling is off. Every solve starts cold, so that a result
depends on its problem alone.
"""

from typing import Any

import numpy as np
import osqp
import scipy.sparse as sparse

from rotctl.maths.rotations import Array
from rotctl.qp.problem import Problem, Shape, Solution, failed, objection

EPSILON = 1e-5  # absolute and relative tolerance of the scaled problem [-]
LARGEST = 1e20  # OSQP's infinity is 1e30; a bound beyond this is none
# Initial step size and iteration cap, measured over recorded steps of a roll: a cap of
# 4000 leaves no condensed problem unsolved.
SETTINGS = {
    "verbose": False,
    "eps_abs": EPSILON,
    "eps_rel": EPSILON,
    "scaling": 0,
    "rho": 0.01,
    "check_termination": 10,
    "adaptive_rho_interval": 50,
    "max_iter": 4000,
    "polishing": False,
}


class Osqp:
    """First-order splitting; approximate, with rows."""

    name = "osqp"
    shape: Shape = "rows"

    def __init__(self) -> None:
        """Start with no workspaces."""
        self._workspaces: dict[tuple[int, int], Any] = {}

    def solve(self, problem: Problem, start: Array | None) -> Solution:
        """Solve, cold; `start` is ignored. See `Solver`."""
        n, k = len(problem.f), len(problem.low)
        reason = objection(problem)
        if reason:
            return failed(problem, reason)
        scale = 1.0 / np.sqrt(np.maximum(problem.H.diagonal(), 0.0) + 1e-12)
        cost = 1.0 / max(float(np.abs(problem.f * scale).max(initial=0.0)), 1e-12)
        P = problem.H * scale * scale[:, None] * cost
        q = problem.f * scale * cost
        G = problem.G * scale
        length = 1.0 / np.maximum(np.abs(G).max(axis=1, initial=0.0), 1e-12)
        A = np.concatenate((np.eye(n), G * length[:, None]))
        low = np.concatenate((problem.lower / scale, problem.low * length))
        high = np.concatenate((problem.upper / scale, problem.high * length))
        low, high = np.maximum(low, -LARGEST), np.minimum(high, LARGEST)
        try:
            result = self._run(n, k, P, q, A, low, high)
        except osqp.OSQPException as error:  # such as a Hessian that is not convex
            return failed(problem, f"OSQP: {error}")
        iterations = int(result.info.iter)
        if result.info.status_val != osqp.SolverStatus.OSQP_SOLVED:
            return failed(problem, f"OSQP: {result.info.status}", iterations)
        if not np.isfinite(result.x).all():
            return failed(problem, "OSQP returned numbers that are not finite", iterations)
        residual = float(max(result.info.prim_res, result.info.dual_res))
        return Solution(result.x * scale, True, iterations, residual)

    def _run(self, n: int, k: int, P: Array, q: Array, A: Array, low: Array, high: Array) -> Any:
        upper = np.triu_indices(n)
        order = np.lexsort((upper[0], upper[1]))  # column by column, as CSC wants it
        values = P[upper][order]
        workspace = self._workspaces.get((n, k))
        if workspace is None:
            hessian = sparse.csc_matrix(np.triu(np.ones((n, n))))
            hessian.data[:] = values
            rows = sparse.csc_matrix(np.ones_like(A))
            rows.data[:] = A.T.ravel()
            workspace = osqp.OSQP()
            workspace.setup(hessian, q, rows, low, high, **SETTINGS)
            self._workspaces[n, k] = workspace
        else:
            workspace.update_settings(rho=SETTINGS["rho"])
            workspace.update(Px=values, Ax=A.T.ravel(), q=q, l=low, u=high)
        workspace.warm_start(x=np.zeros(n), y=np.zeros(n + k))
        return workspace.solve(raise_error=False)
