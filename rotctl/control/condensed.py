"""The optimisation of [Brown2013] eq. 2 with accelerations and, if no limit binds, torques gone.

The dynamics M qddot + C = S' tau + J' lambda give qddot exactly, so no equality is left
and the contact velocity of eq. 2 becomes h (B tau + A lambda + drift). Without torque
limits the torques are a linear function of lambda and gamma, too:

    cost over tau:  wP/2 |tau - t(gamma)|^2 + s/2 |B tau + A lambda + drift|^2,   s = W_v h^2
    minimum:        1/2 y' K y,  K = (I/s + B B'/wP)^-1,  y = A lambda + B t(gamma) + drift
    at              tau = t(gamma) - B' K y / wP,         t(gamma) = tau_b + gamma (tau_a - tau_b)

`reduced` is that small problem. Where its torques break a limit, `full` keeps the torques
as variables with the limits as bounds, and starts from there. A solver that knows bounds
alone gets each contact force as a non-negative sum of the friction pyramid's four edges.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rotctl import linear
from rotctl.control.answer import Answer
from rotctl.control.cone import solve_cone
from rotctl.control.terms import Terms
from rotctl.linear import NotPositiveDefiniteError, product
from rotctl.qp import Solution, Solver
from rotctl.rotations import Array

LIMIT_SLACK = 1e-6  # [N m] a torque this far beyond its limit is rounding, and is clipped


def solve(terms: Terms, solver: Solver, start: Array | None = None) -> Answer:
    """Torques, contact forces and blend of one pass.

    Args:
        start: a guess in the solver's own variables for forces and blend, see `warm_start`.
    """
    if terms.weights.pose == 0:
        return _full(terms, solver, None)
    answer = _reduced(terms, solver, start)
    within = np.abs(answer.torque) <= terms.torque_limit + LIMIT_SLACK
    if not answer.solution.solved or within.all():
        return answer
    held = np.clip(answer.torque, -terms.torque_limit, terms.torque_limit)
    full = _full(terms, solver, np.concatenate((held, answer.solution.x)))
    iterations = answer.solution.iterations + full.solution.iterations
    return replace(full, solution=replace(full.solution, iterations=iterations))


def warm_start(first: Answer, keep: NDArray[np.bool_], solver: Solver) -> Array:
    """A guess for a pass over the contacts where `keep` is True, from a pass over all."""
    each = 4 if solver.shape == "bounds" else 3  # unknowns a contact
    tail = first.solution.x[-(each * len(keep) + 1) :]
    return np.concatenate((tail[:-1][np.repeat(keep, each)], tail[-1:]))


def _reduced(terms: Terms, solver: Solver, start: Array | None) -> Answer:
    m, weights = terms.contacts, terms.weights
    n = 3 * m
    difference = terms.pose_a - terms.pose_b
    s = weights.contact_velocity * terms.period**2
    H = np.zeros((n + 1, n + 1))
    f = np.zeros(n + 1)
    reach = np.empty((n, n + 2))  # y = reach [lambda, gamma, 1]
    pulled: Array = np.zeros((n, n + 2))  # K reach
    if m and s > 0:
        reach[:, :n] = terms.mobility
        reach[:, n] = product(terms.actuation, difference)
        reach[:, n + 1] = product(terms.actuation, terms.pose_b) + terms.drift
        Q = terms.actuation_square / weights.pose
        Q.flat[:: n + 1] += 1.0 / s
        try:
            pulled = linear.solve(Q, reach)
        except NotPositiveDefiniteError as error:  # it has numbers that are not finite
            nothing = Solution(np.zeros(n + 1), False, 0, float("nan"), str(error))
            return Answer(terms.pose_b, np.zeros((m, 3)), terms.blend, nothing)
        square = product(reach.T, pulled)
        H += square[:-1, :-1]
        f += square[:-1, -1]
    _add_forces(H[:n, :n], f[:n], terms)
    H[n, n] += terms.blend_weight
    f[n] -= terms.blend_weight * terms.blend
    solution, _, force, tail = solve_cone(terms, solver, H, f, start)
    blend = float(tail[0])
    yielded = product(pulled[:, :n], force.ravel()) + pulled[:, n] * blend + pulled[:, n + 1]
    torque = terms.pose_b + blend * difference - product(yielded, terms.actuation) / weights.pose
    return Answer(torque, force, blend, solution)


def _full(terms: Terms, solver: Solver, start: Array | None) -> Answer:
    m, nu, weights = terms.contacts, len(terms.torque_limit), terms.weights
    n = 3 * m
    difference = terms.pose_a - terms.pose_b
    H = np.zeros((nu + n + 1, nu + n + 1))
    f = np.zeros(nu + n + 1)
    s = weights.contact_velocity * terms.period**2
    velocity = np.concatenate((terms.actuation, terms.mobility), axis=1)  # (3m, nu + 3m)
    H[:-1, :-1] = s * product(velocity.T, velocity)
    f[:-1] = s * product(terms.drift, velocity)
    H[:nu, :nu].flat[:: nu + 1] += weights.pose
    H[:nu, -1] = H[-1, :nu] = -weights.pose * difference
    H[-1, -1] = weights.pose * product(difference, difference) + terms.blend_weight
    f[:nu] -= weights.pose * terms.pose_b
    f[-1] = weights.pose * product(difference, terms.pose_b) - terms.blend_weight * terms.blend
    _add_forces(H[nu:-1, nu:-1], f[nu:-1], terms)
    solution, head, force, tail = solve_cone(terms, solver, H, f, start)
    return Answer(head, force, float(tail[0]), solution)


def _add_forces(H: Array, f: Array, terms: Terms) -> None:
    """Momentum objectives and force regularisation onto the force block, in place."""
    H += terms.momentum_square
    H.flat[:: len(f) + 1] += terms.weights.contact_force
    f -= terms.momentum_pull
