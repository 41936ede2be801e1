"""Whole-body momentum, composite inertia and angular velocity about the centre of mass."""

from typing import NamedTuple

import mujoco
import numpy as np

from rotctl.maths.linear import product, solve
from rotctl.maths.rotations import Array, cross
from rotctl.mechanics.bodies import ROOT_BODY


class Momentum(NamedTuple):
    """Rotation indices of the character at one instant, world axes.

    Attributes:
        com: (3,) centre of mass c [m].
        com_velocity: (3,) [m/s].
        linear: (3,) linear momentum L [kg m/s].
        angular: (3,) AM, angular momentum H about c [kg m2/s].
        inertia: (3, 3) composite inertia I_c about c [kg m2].
        angular_velocity: (3,) AV, omega = I_c^-1 H [rad/s], [Brown2013] section 3.
        root_rotation: (3, 3) of the root body.
        root_offset: (3,) from the root body's origin to c [m].
    """

    com: Array
    com_velocity: Array
    linear: Array
    angular: Array
    inertia: Array
    angular_velocity: Array
    root_rotation: Array
    root_offset: Array


def read_momentum(mj: mujoco.MjModel, data: mujoco.MjData) -> Momentum:
    """Momentum of the current position and velocity; call after `mj_step1` or `mj_forward`.

    The first six entries of M qdot are the momentum along the root's free joint: world
    linear momentum, and angular momentum about the root's origin in the root's frame.
    So neither M nor a momentum matrix has to be formed.
    """
    generalised = np.empty(mj.nv)
    mujoco.mj_mulM(mj, data, generalised, data.qvel)
    rotation = data.xmat[ROOT_BODY].reshape(3, 3).copy()
    com = data.subtree_com[ROOT_BODY].copy()
    offset = com - data.qpos[:3]
    linear = generalised[:3]
    angular = product(rotation, generalised[3:6]) - cross(offset, linear)
    xx, yy, zz, xy, xz, yz = data.crb[ROOT_BODY, :6]
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return Momentum(
        com=com,
        com_velocity=linear / mj.body_subtreemass[ROOT_BODY],
        linear=linear,
        angular=angular,
        inertia=inertia,
        angular_velocity=solve(inertia, angular),
        root_rotation=rotation,
        root_offset=offset,
    )


def contact_momentum_maps(momentum: Momentum, jacobian: Array) -> Array:
    """G (6, 3m): rates of L and H that forces along the rows of `jacobian` (3m, nv) bring about.

    With the dynamics satisfied, Ldot = G[:3] lambda + m g and Hdot = G[3:] lambda exactly:
    no acceleration and no derivative of a momentum matrix is needed.
    """
    root = jacobian[:, :6].T  # (6, 3m)
    force = root[:3]
    x, y, z = momentum.root_offset
    about_root = product(momentum.root_rotation, root[3:])
    lever = product(np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]), force)
    return np.concatenate((force, about_root - lever))
