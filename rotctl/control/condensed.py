"""The optimisation of [Brown2013] eq. 2 with accelerations and, if no limit binds, torques gone.

The dynamics M qddot + C = S' tau + J' lambda give qddot exactly, so no equality is left, and any
stack of rows over qddot becomes R qddot = B tau + A lambda + c. Without torque limits the
torques are a linear function of lambda and the blend gamma, too:

    cost over tau:  wP/2 |tau - t(gamma)|^2 + 1/2 |B tau + A lambda + c - wanted|^2_W
    minimum:        1/2 y' K y,  K = (W^-1 + B B'/wP)^-1,  y = A lambda + B t(gamma) + c - wanted
    at              tau = t(gamma) - B' K y / wP,          t(gamma) = tau_b + gamma (tau_a - tau_b)

Rows of momenta have B = 0, so their K is W: they go onto the forces as they are.

`reduced` is that small problem, as large as the contacts make it, however many the tasks. Where
its torques break a limit, `full` keeps the torques as variables with the limits as bounds, and
starts from there. A solver that knows bounds alone gets each contact force as a non-negative sum
of the friction pyramid's four edges.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rotctl.control.answer import Answer
from rotctl.control.cone import solve_cone
from rotctl.control.stack import Stack
from rotctl.maths import linear
from rotctl.maths.linear import NotPositiveDefiniteError, product
from rotctl.maths.rotations import Array
from rotctl.qp import Solution, Solver

LIMIT_SLACK = 1e-6  # [N m] a torque this far beyond its limit is rounding, and is clipped


def solve(stack: Stack, solver: Solver, start: Array | None = None) -> Answer:
    """Torques, contact forces and blend of one pass.

    Args:
        start: a guess in the solver's own variables for forces and blend, see `warm_start`.
    """
    if stack.pose.weight == 0:
        return _full(stack, solver, None)
    answer = _reduced(stack, solver, start)
    within = np.abs(answer.torque) <= stack.torque_limit + LIMIT_SLACK
    if not answer.solution.solved or within.all():
        return answer
    held = np.clip(answer.torque, -stack.torque_limit, stack.torque_limit)
    full = _full(stack, solver, np.concatenate((held, answer.solution.x)))
    iterations = answer.solution.iterations + full.solution.iterations
    return replace(full, solution=replace(full.solution, iterations=iterations))


def warm_start(first: Answer, keep: NDArray[np.bool_], solver: Solver) -> Array:
    """A guess for a pass over the contacts where `keep` is True, from a pass over all."""
    each = 4 if solver.shape == "bounds" else 3  # unknowns a contact
    tail = first.solution.x[-(each * len(keep) + 1) :]
    return np.concatenate((tail[:-1][np.repeat(keep, each)], tail[-1:]))


def _reduced(stack: Stack, solver: Solver, start: Array | None) -> Answer:
    m, row = stack.contacts, stack.counting
    n, wP = len(row), stack.pose.weight
    difference = stack.pose_a - stack.pose_b
    actuation = stack.actuation[row]
    H = np.zeros((3 * m + 1, 3 * m + 1))
    f = np.zeros(3 * m + 1)
    reach = np.empty((n, 3 * m + 2))  # y = reach [lambda, gamma, 1]
    pulled: Array = np.zeros((n, 3 * m + 2))  # K reach
    if n:
        reach[:, :-2] = stack.mobility[row]
        reach[:, -2] = product(actuation, difference)
        reach[:, -1] = product(actuation, stack.pose_b) + stack.drift[row]
        Q = stack.actuation_square[np.ix_(row, row)] / wP
        Q.flat[:: n + 1] += 1.0 / stack.weight[row]
        try:
            pulled = linear.solve(Q, reach)
        except NotPositiveDefiniteError as error:  # it has numbers that are not finite
            nothing = Solution(np.zeros(3 * m + 1), False, 0, float("nan"), str(error))
            return Answer(stack.pose_b, np.zeros((m, 3)), stack.blend, nothing)
        square = product(reach.T, pulled)
        H += square[:-1, :-1]
        f += square[:-1, -1]
    _add_forces(H[:-1, :-1], f[:-1], stack)
    H[-1, -1] += stack.blend_weight
    f[-1] -= stack.blend_weight * stack.blend
    solution, _, force, tail = solve_cone(stack, solver, H, f, start)
    blend = float(tail[0])
    yielded = product(pulled[:, :-2], force.ravel()) + pulled[:, -2] * blend + pulled[:, -1]
    torque = stack.pose_b + blend * difference - product(yielded, actuation) / wP
    return Answer(torque, force, blend, solution)


def _full(stack: Stack, solver: Solver, start: Array | None) -> Answer:
    m, nu, row, wP = stack.contacts, len(stack.torque_limit), stack.counting, stack.pose.weight
    difference = stack.pose_a - stack.pose_b
    H = np.zeros((nu + 3 * m + 1, nu + 3 * m + 1))
    f = np.zeros(nu + 3 * m + 1)
    blending = -stack.blending[:, None]
    rows = np.concatenate((stack.actuation, stack.mobility, blending), axis=1)[row]
    weighted = rows.T * stack.weight[row]  # (nu + 3m + 1, n)
    H += product(weighted, rows)
    f += product(weighted, stack.drift[row])
    H[:nu, :nu].flat[:: nu + 1] += wP
    H[:nu, -1] -= wP * difference
    H[-1, :nu] -= wP * difference
    H[-1, -1] += wP * product(difference, difference) + stack.blend_weight
    f[:nu] -= wP * stack.pose_b
    f[-1] += wP * product(difference, stack.pose_b) - stack.blend_weight * stack.blend
    _add_forces(H[nu:-1, nu:-1], f[nu:-1], stack)
    solution, head, force, tail = solve_cone(stack, solver, H, f, start)
    return Answer(head, force, float(tail[0]), solution)


def _add_forces(H: Array, f: Array, stack: Stack) -> None:
    """Momentum objectives and force regularisation onto the force block, in place."""
    H += stack.momentum_square
    H.flat[:: len(f) + 1] += stack.contact.force
    f -= stack.momentum_pull
