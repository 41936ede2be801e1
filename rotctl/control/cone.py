"""Contact forces inside the square friction pyramid of [Brown2013] eq. 2, for any solver.

Variables are [head, lambda (3m), gamma], where head is the torques or nothing. A solver
that knows rows gets lambda_N >= 0 and +-lambda_T <= mu lambda_N. A solver that knows
bounds alone gets each force as a non-negative sum of the pyramid's four edges.
"""

from functools import lru_cache

import numpy as np

from rotctl.control.stack import Stack
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array
from rotctl.qp import Problem, Solution, Solver, without_rows


def solve_cone(
    stack: Stack, solver: Solver, H: Array, f: Array, start: Array | None
) -> tuple[Solution, Array, Array, Array]:
    """Solve min 1/2 x'Hx + f'x with forces in their cone, gamma in [0, 1], torques limited.

    Args:
        H, f: cost over [head, lambda, gamma]; the head is all torques or empty.
        start: a guess in the solver's own variables, or None.

    Returns:
        The solver's account, the head, the forces (m, 3) along N, T1, T2 and [gamma].
    """
    m = stack.contacts
    head = len(f) - 3 * m - 1
    limit = stack.torque_limit[:head]
    if solver.shape == "bounds":
        spread = _edge_map(head, m, stack.friction)
        lower = np.concatenate((-limit, np.zeros(4 * m + 1)))
        upper = np.concatenate((limit, np.full(4 * m, np.inf), [1.0]))
        problem = without_rows(product(spread.T, H, spread), product(f, spread), lower, upper)
        solution = solver.solve(problem, start)
        x = product(spread, solution.x)
    else:
        normal = np.zeros(3 * m) - np.inf
        normal[::3] = 0.0
        lower = np.concatenate((-limit, normal, [0.0]))
        upper = np.concatenate((limit, np.full(3 * m, np.inf), [1.0]))
        rows = friction_rows(head, m, 1, stack.friction)
        solution = solver.solve(
            Problem(H, f, lower, upper, rows, np.full(4 * m, -np.inf), np.zeros(4 * m)), start
        )
        x = solution.x
    return solution, x[:head], x[head : head + 3 * m].reshape(m, 3), x[head + 3 * m :]


@lru_cache(maxsize=256)
def friction_rows(before: int, m: int, after: int, mu: float) -> Array:
    """Rows G with G x <= 0 for +-lambda_T <= mu lambda_N, (4m, before + 3m + after)."""
    one = np.array([[-mu, 1, 0], [-mu, -1, 0], [-mu, 0, 1], [-mu, 0, -1]], dtype=float)
    rows = np.zeros((4 * m, before + 3 * m + after))
    rows[:, before : before + 3 * m] = np.kron(np.eye(m), one)
    return rows


@lru_cache(maxsize=256)
def _edge_map(head: int, m: int, mu: float) -> Array:
    edges = np.array([[1, 1, 1, 1], [mu, mu, -mu, -mu], [mu, -mu, mu, -mu]])
    spread = np.zeros((head + 3 * m + 1, head + 4 * m + 1))
    spread[:head, :head] = np.eye(head)
    spread[head : head + 3 * m, head : head + 4 * m] = np.kron(np.eye(m), edges)
    spread[-1, -1] = 1.0
    return spread
