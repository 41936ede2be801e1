"""The optimisation of [Brown2013] eq. 2 as the paper writes it: x = [qddot, tau, lambda, gamma].

Every objective is 1/2 |A x - b|^2_W; the dynamics are an equality. (Eq. 2 prints
S tau = M qddot + C; the contact forces' J' lambda belongs on its left side and is there
here.) This form is the readable reference that the condensed one is tested against.
"""

from dataclasses import dataclass

import mujoco
import numpy as np

from rotctl.control.answer import Answer
from rotctl.control.cone import friction_rows
from rotctl.control.terms import Terms
from rotctl.linear import product
from rotctl.mechanics.model import ROOT_DOFS, Model
from rotctl.mechanics.state import State
from rotctl.qp import Problem, Solver
from rotctl.rotations import Array


@dataclass(frozen=True)
class Objective:
    """1/2 |A x - b|^2 with weights W (k,) on the squared errors; A (k, n), b (k,)."""

    A: Array
    b: Array
    W: Array


def solve(terms: Terms, model: Model, state: State, solver: Solver) -> Answer:
    """Torques, contact forces and blend of one pass over `terms.contacts` contacts."""
    nv, nu, m = model.mj.nv, model.mj.nu, terms.contacts
    solution = solver.solve(assemble(terms, model, state), None)
    force = solution.x[nv + nu : nv + nu + 3 * m].reshape(m, 3)
    return Answer(solution.x[nv : nv + nu], force, float(solution.x[-1]), solution)


def assemble(terms: Terms, model: Model, state: State) -> Problem:
    """The quadratic program over [qddot (nv), tau (nu), lambda (3m), gamma]."""
    nv, nu, m = model.mj.nv, model.mj.nu, terms.contacts
    n = nv + nu + 3 * m + 1
    M = np.zeros((nv, nv))
    mujoco.mj_fullM(model.mj, state.data, M)
    H, f = np.zeros((n, n)), np.zeros(n)
    for objective in objectives(terms, model, state, M):
        weighted = objective.A.T * objective.W
        H += product(weighted, objective.A)
        f -= product(weighted, objective.b)
    limit = terms.torque_limit
    normal = np.full(3 * m, -np.inf)
    normal[::3] = 0.0
    free = np.full(nv, np.inf)
    dynamics = np.concatenate(  # S' tau + J' lambda - M qddot = C
        (-M, np.eye(nv)[:, model.joints], terms.jacobian.T, np.zeros((nv, 1))), axis=1
    )
    return Problem(
        H=H,
        f=f,
        lower=np.concatenate((-free, -limit, normal, [0.0])),
        upper=np.concatenate((free, limit, np.full(3 * m, np.inf), [1.0])),
        G=np.concatenate((dynamics, friction_rows(nv + nu, m, 1, terms.friction))),
        low=np.concatenate((state.bias, np.full(4 * m, -np.inf))),
        high=np.concatenate((state.bias, np.zeros(4 * m))),
    )


def objectives(terms: Terms, model: Model, state: State, M: Array) -> list[Objective]:
    """Momentum, blend tracking, contact velocity and the two small regularisers."""
    nv, nu, m = model.mj.nv, model.mj.nu, terms.contacts
    n = nv + nu + 3 * m + 1
    weights = terms.weights

    def rows(count: int) -> Array:
        return np.zeros((count, n))

    momentum, rate = rows(6), terms.rates - _momentum_bias(model, state)
    momentum[:, :nv] = _momentum_matrix(state, M)
    blend, difference = rows(nu), terms.pose_a - terms.pose_b
    blend[:, nv : nv + nu] = np.eye(nu)
    blend[:, -1] = -difference
    velocity = rows(3 * m)
    velocity[:, :nv] = terms.period * terms.jacobian
    force = rows(3 * m)
    force[:, nv + nu : nv + nu + 3 * m] = np.eye(3 * m)
    gamma = rows(1)
    gamma[0, -1] = 1.0
    return [
        Objective(momentum, rate, terms.momentum_weights),  # E_L, E_H
        Objective(blend, terms.pose_b, np.full(nu, weights.pose)),  # E_B, eq. 7
        Objective(  # W_v term of eq. 2
            velocity,
            terms.approach - product(terms.jacobian, state.velocity),
            np.full(3 * m, weights.contact_velocity),
        ),
        Objective(force, np.zeros(3 * m), np.full(3 * m, weights.contact_force)),
        Objective(gamma, np.array([terms.blend]), np.array([terms.blend_weight])),
    ]


def _momentum_matrix(state: State, M: Array) -> Array:
    """(6, nv) with [L; H] = matrix @ qdot: the root rows of M, carried to the centre of mass."""
    return product(_to_com(state), M[:ROOT_DOFS])


def _momentum_bias(model: Model, state: State) -> Array:
    """d(matrix)/dt qdot (6,): the root rows of C with gravity's part taken out."""
    gravity = np.concatenate((model.mass * model.gravity, np.zeros(3)))
    return np.asarray(product(_to_com(state), state.bias[:ROOT_DOFS]) + gravity)


def _to_com(state: State) -> Array:
    x, y, z = state.momentum.root_offset
    lever = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    carry = np.zeros((6, 6))
    carry[:3, :3] = np.eye(3)
    carry[3:, :3] = -lever
    carry[3:, 3:] = state.momentum.root_rotation
    return carry
