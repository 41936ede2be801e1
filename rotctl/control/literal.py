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
from rotctl.control.stack import Stack
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import ROOT_DOFS, Model
from rotctl.mechanics.state import State
from rotctl.qp import Problem, Solver


@dataclass(frozen=True)
class Objective:
    """1/2 |A x - b|^2 with weights W (k,) on the squared errors; A (k, n), b (k,)."""

    A: Array
    b: Array
    W: Array


def solve(stack: Stack, model: Model, state: State, solver: Solver) -> Answer:
    """Torques, contact forces and blend of one pass over `stack.contacts` contacts."""
    nv, nu, m = model.mj.nv, model.mj.nu, stack.contacts
    solution = solver.solve(assemble(stack, model, state), None)
    force = solution.x[nv + nu : nv + nu + 3 * m].reshape(m, 3)
    return Answer(solution.x[nv : nv + nu], force, float(solution.x[-1]), solution)


def assemble(stack: Stack, model: Model, state: State) -> Problem:
    """The quadratic program over [qddot (nv), tau (nu), lambda (3m), gamma]."""
    nv, nu, m = model.mj.nv, model.mj.nu, stack.contacts
    n = nv + nu + 3 * m + 1
    M = np.zeros((nv, nv))
    mujoco.mj_fullM(model.mj, state.data, M)
    H, f = np.zeros((n, n)), np.zeros(n)
    for objective in objectives(stack, model, state, M):
        weighted = objective.A.T * objective.W
        H += product(weighted, objective.A)
        f -= product(weighted, objective.b)
    limit = stack.torque_limit
    normal = np.full(3 * m, -np.inf)
    normal[::3] = 0.0
    free = np.full(nv, np.inf)
    dynamics = np.concatenate(  # S' tau + J' lambda - M qddot = C
        (-M, np.eye(nv)[:, model.joints], stack.jacobian.T, np.zeros((nv, 1))), axis=1
    )
    return Problem(
        H=H,
        f=f,
        lower=np.concatenate((-free, -limit, normal, [0.0])),
        upper=np.concatenate((free, limit, np.full(3 * m, np.inf), [1.0])),
        G=np.concatenate((dynamics, friction_rows(nv + nu, m, 1, stack.friction))),
        low=np.concatenate((state.bias, np.full(4 * m, -np.inf))),
        high=np.concatenate((state.bias, np.zeros(4 * m))),
    )


def objectives(stack: Stack, model: Model, state: State, M: Array) -> list[Objective]:
    """Momenta, contacts and tasks over qddot, blend tracking and two small regularisers."""
    nv, nu, m = model.mj.nv, model.mj.nu, stack.contacts
    n = nv + nu + 3 * m + 1

    def rows(count: int) -> Array:
        return np.zeros((count, n))

    momentum, motion = rows(len(stack.rate_wanted)), rows(len(stack.wanted))
    momentum[:, :nv] = product(stack.rate_rows, _momentum_matrix(state, M))
    bias = product(stack.rate_rows, _momentum_bias(model, state))
    motion[:, :nv], motion[:, -1] = stack.rows, -stack.blending
    blend, difference = rows(nu), stack.pose_a - stack.pose_b
    blend[:, nv : nv + nu] = np.eye(nu)
    blend[:, -1] = -difference
    force = rows(3 * m)
    force[:, nv + nu : nv + nu + 3 * m] = np.eye(3 * m)
    gamma = rows(1)
    gamma[0, -1] = 1.0
    return [
        Objective(momentum, stack.rate_wanted - bias, stack.rate_weight),  # E_L, E_H
        Objective(motion, stack.wanted, stack.weight),  # W_v term of eq. 2, the tasks, and poses by
        # acceleration
        Objective(blend, stack.pose_b, np.full(nu, stack.pose.weight)),  # E_B, eq. 7
        Objective(force, np.zeros(3 * m), np.full(3 * m, stack.contact.force)),
        Objective(gamma, np.array([stack.blend]), np.array([stack.blend_weight])),
    ]


def _momentum_matrix(state: State, M: Array) -> Array:
    """(6, nv) with [L; H] = matrix qdot: the root rows of M, carried to the centre of mass."""
    return product(_to_com(state), M[:ROOT_DOFS])


def _momentum_bias(model: Model, state: State) -> Array:
    """d(matrix)/dt qdot (6,): the root rows of the motion's own forces, gravity's taken out."""
    gravity = np.concatenate((model.mass * model.gravity, np.zeros(3)))
    return product(_to_com(state), state.data.qfrc_bias[:ROOT_DOFS]) + gravity


def _to_com(state: State) -> Array:
    x, y, z = state.momentum.root_offset
    lever = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    carry = np.zeros((6, 6))
    carry[:3, :3] = np.eye(3)
    carry[3:, :3] = -lever
    carry[3:, 3:] = state.momentum.root_rotation
    return carry
