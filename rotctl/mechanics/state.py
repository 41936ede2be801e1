"""What the controller sees: one fresh reading of the simulated character."""

from dataclasses import dataclass

import mujoco
import numpy as np

from rotctl.linear import product
from rotctl.mechanics.contacts import Contacts, read_contacts
from rotctl.mechanics.model import Model
from rotctl.mechanics.momentum import Momentum, read_momentum
from rotctl.rotations import Array


@dataclass(frozen=True)
class State:
    """The character at the start of one control step.

    Attributes:
        time: [s].
        position: (nq,) generalised position [m, quaternion, rad].
        velocity: (nv,) generalised velocity [m/s, rad/s].
        momentum: rotation indices and centre of mass.
        contacts: contacts with the ground.
        trunk_axes: (3, 3) columns are the trunk's mean front, left and up, each unit, world.
        data: the MuJoCo data behind all this. What is read from it, and the properties
            below, hold until the physics steps.
    """

    time: float
    position: Array
    velocity: Array
    momentum: Momentum
    contacts: Contacts
    trunk_axes: Array
    data: mujoco.MjData

    @property
    def bias(self) -> Array:
        """C of M qddot + C = S' tau + J' lambda (nv,) [N, N m].

        Coriolis, centrifugal and gravity forces less the joints' passive ones.
        """
        return np.asarray(self.data.qfrc_bias - self.data.qfrc_passive)

    @property
    def root_angular_velocity(self) -> Array:
        """Of the root body (3,) [rad/s], world axes."""
        return product(self.momentum.root_rotation, self.velocity[3:6])

    def solve_mass(self, mj: mujoco.MjModel, rows: Array) -> Array:
        """Rows of right-hand sides (k, nv) to rows of M^-1 rhs (k, nv)."""
        solved = np.empty_like(rows)
        mujoco.mj_solveM(mj, self.data, solved, rows)
        return solved


def read(model: Model, data: mujoco.MjData) -> State:
    """Read the state; positions and velocities must have been evaluated (`mj_step1`)."""
    axes = (data.xmat[model.trunk] * model.trunk_weights).sum(axis=0).reshape(3, 3)
    return State(
        time=data.time,
        position=data.qpos.copy(),
        velocity=data.qvel.copy(),
        momentum=read_momentum(model.mj, data),
        contacts=read_contacts(model.mj, data, model.touch, model.look_ahead),
        trunk_axes=axes / np.sqrt((axes**2).sum(axis=0)),
        data=data,
    )
