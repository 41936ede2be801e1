"""What the controller sees: one fresh reading of the simulated character."""

from typing import NamedTuple

import mujoco
import numpy as np

from rotctl.maths.linear import product
from rotctl.maths.rotations import Array
from rotctl.mechanics.contacts import Contacts, read_contacts
from rotctl.mechanics.merging import APART, Merging, merged
from rotctl.mechanics.model import Model
from rotctl.mechanics.momentum import Momentum, read_momentum


class State(NamedTuple):
    """The character at the start of one control step.

    Attributes:
        time: [s].
        position: (nq,) generalised position [m, quaternion, rad].
        velocity: (nv,) generalised velocity [m/s, rad/s].
        bias: (nv,) C of M qddot + C = S' tau + J' lambda [N, N m]: Coriolis, centrifugal and
            gravity forces less the joints' passive ones, and less those from outside where
            control knows of them.
        momentum: rotation indices and centre of mass.
        contacts: contacts with the ground, as control sees them.
        trunk_axes: (3, 3) columns are the trunk's mean front, left and up, each unit, world.
        data: the MuJoCo data behind all this. What is read from it, and the properties
            below, hold until the physics steps.
    """

    time: float
    position: Array
    velocity: Array
    bias: Array
    momentum: Momentum
    contacts: Contacts
    trunk_axes: Array
    data: mujoco.MjData

    @property
    def root_angular_velocity(self) -> Array:
        """Of the root body (3,) [rad/s], world axes."""
        return product(self.momentum.root_rotation, self.velocity[3:6])

    def solve_mass(self, mj: mujoco.MjModel, rows: Array) -> Array:
        """Rows of right-hand sides (k, nv) to rows of M^-1 rhs (k, nv)."""
        solved = np.empty_like(rows)
        mujoco.mj_solveM(mj, self.data, solved, rows)
        return solved


def read(
    model: Model, data: mujoco.MjData, sees_disturbance: bool = False, merging: Merging = APART
) -> State:
    """Read the state; positions and velocities must have been evaluated (`mj_step1`).

    Args:
        sees_disturbance: whether the bias knows of pushes and of a fluid.
        merging: which contacts are one to control.
    """
    axes = (data.xmat[model.trunk] * model.trunk_weights).sum(axis=0).reshape(3, 3)
    return State(
        time=data.time,
        position=data.qpos.copy(),
        velocity=data.qvel.copy(),
        bias=_bias(model.mj, data, sees_disturbance),
        momentum=read_momentum(model.mj, data),
        contacts=merged(read_contacts(model.mj, data, model.touch, model.look_ahead), merging),
        trunk_axes=axes / np.sqrt((axes**2).sum(axis=0)),
        data=data,
    )


def _bias(mj: mujoco.MjModel, data: mujoco.MjData, sees_disturbance: bool) -> Array:
    bias = data.qfrc_bias - data.qfrc_passive
    if not sees_disturbance:
        return np.asarray(bias + data.qfrc_fluid)
    pushed = np.zeros(mj.nv)
    for body in np.flatnonzero(data.xfrc_applied.any(axis=1)).tolist():
        force, moment = data.xfrc_applied[body].reshape(2, 3)
        mujoco.mj_applyFT(mj, data, force, moment, data.xipos[body], body, pushed)
    return np.asarray(bias - pushed)
