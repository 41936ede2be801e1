"""Quadratic programs of both forms solved to rounding, given which limits bind."""

import mujoco
import numpy as np
import scipy.linalg
import scipy.optimize

from rotctl.control import literal
from rotctl.control.answer import Answer
from rotctl.control.cone import friction_rows
from rotctl.qp import Solution, make_solver

BINDS = 1e-7  # of the size of the unknowns: what is nearer to its limit lies on it


class Polished:
    """DAQP, and its answer once more on the limits that bind, by orthogonal factors."""

    name, shape = "polished", "rows"

    def solve(self, problem, start):
        answer = make_solver("qpsolvers:daqp").solve(problem, start)
        if not answer.solved:
            return answer
        n, x = len(problem.f), answer.x
        rows = np.concatenate((np.eye(n), -np.eye(n), problem.G, -problem.G))
        most = np.concatenate((problem.upper, -problem.lower, problem.high, -problem.low))
        finite = np.isfinite(most)
        rows, most = rows[finite], most[finite]
        on = np.abs(most - rows @ x) < BINDS * (1 + np.abs(x).max())
        fixed, free = on_the_limits(rows[on], most[on], n)
        gradient = free.T @ (problem.H @ fixed + problem.f)
        x = fixed - free @ np.linalg.solve(free.T @ problem.H @ free, gradient)
        assert (rows @ x - most).max() < 10 * BINDS * (1 + np.abs(x).max())
        return Solution(x, True, 0, 0.0)


def on_the_limits(rows, values, n):
    """A point with rows x = values, and a basis of the directions that stay there."""
    if not len(rows):
        return np.zeros(n), np.eye(n)
    point = np.linalg.lstsq(rows, values, rcond=None)[0]
    return point, scipy.linalg.null_space(rows, rcond=1e-10)


def written_out(stack, model, state, near):
    """The literal form's minimum on the limits that `near`, an answer, lies on; and how optimal.

    As least squares over [tau, lambda, gamma], with the acceleration of the dynamics put in: no
    square of a matrix is formed, so that nothing but rounding is lost.
    """
    nv, nu, m = model.mj.nv, model.mj.nu, stack.contacts
    n = nu + 3 * m + 1
    M = np.zeros((nv, nv))
    mujoco.mj_fullM(model.mj, state.data, M)
    pushes = np.concatenate(
        (np.eye(nv)[:, model.joints], stack.jacobian.T, np.zeros((nv, 1)), -state.bias[:, None]),
        axis=1,
    )
    moves = np.linalg.solve(M, pushes)  # qddot = moves [tau, lambda, gamma, 1]
    A, b = [], []
    for objective in literal.objectives(stack, model, state, M):
        root = np.sqrt(objective.W)[:, None]
        over = objective.A[:, :nv] @ moves
        over[:, :-1] += objective.A[:, nv:]
        A.append(root * over[:, :-1])
        b.append(root[:, 0] * (objective.b - over[:, -1]))
    A, b = np.concatenate(A), np.concatenate(b)
    limits = np.zeros((2 * nu + m + 2, n))
    limits[:nu, :nu], limits[nu : 2 * nu, :nu] = np.eye(nu), -np.eye(nu)
    limits[2 * nu + np.arange(m), nu + 3 * np.arange(m)] = -1.0
    limits[-2, -1], limits[-1, -1] = 1.0, -1.0
    limits = np.concatenate((limits, friction_rows(nu, m, 1, stack.friction)))
    most = np.zeros(len(limits))
    most[: 2 * nu], most[2 * nu + m] = np.tile(stack.torque_limit, 2), 1.0
    x = np.concatenate((near.torque, near.force.ravel(), [near.blend]))
    on = most - limits @ x < BINDS * (1 + np.abs(x).max())
    fixed, free = on_the_limits(limits[on], most[on], n)
    x = fixed + free @ np.linalg.lstsq(A @ free, b - A @ fixed, rcond=None)[0]
    assert (limits @ x - most).max() < 10 * BINDS * (1 + np.abs(x).max())
    slope = A.T @ (A @ x - b)
    scale = np.abs(A).T @ np.abs(A @ x - b) + 1.0
    pulls = np.concatenate((limits[on] / scale, np.zeros((1, n))))  # nnls dies of no columns
    _, left = scipy.optimize.nnls(pulls.T, -slope / scale)
    answer = Answer(x[:nu], x[nu:-1].reshape(m, 3), float(x[-1]), None)
    return answer, left
