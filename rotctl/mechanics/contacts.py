"""Ground contacts: frames, points and Jacobian rows, straight from MuJoCo's constraint rows.

Whatever is not the character is ground, loose things included: control plans with their
contacts as if they stood still.
"""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.maths.rotations import Array
from rotctl.mechanics.bodies import is_character


@dataclass(frozen=True)
class Contacts:
    """The m contacts between character and ground at one instant.

    Attributes:
        body: (m,) MuJoCo id of the character's body.
        position: (m, 3) world point [m].
        frame: (m, 3, 3) rows are normal (out of the ground) and two tangents, world axes.
        row: (m,) first row of each contact in MuJoCo's constraint arrays.
        friction: (m, 2) the physics' friction coefficients along the two tangents [-].
        gap: (m,) distance to the ground [m]; negative where they overlap.
    """

    body: NDArray[np.int32]
    position: Array
    frame: Array
    row: NDArray[np.int64]
    friction: Array
    gap: Array

    @property
    def count(self) -> int:
        """Number of contacts m."""
        return len(self.body)


def read_contacts(
    mj: mujoco.MjModel, data: mujoco.MjData, touch: float = 0.0, look_ahead: float = 0.0
) -> Contacts:
    """Contacts of the current position; call after `mj_step1` or `mj_forward`.

    Contacts of the character with itself are left out: control does not plan with them. So are
    open ones, which only lockstep physics has, but for those with a gap below `touch` [m] and
    those that close within `look_ahead` [s] at their present speed.
    """
    contact = data.contact
    bodies = mj.geom_bodyid[contact.geom]  # (ncon, 2)
    own = is_character(mj)[bodies]
    chosen = np.flatnonzero((own.sum(axis=1) == 1) & (contact.efc_address >= 0))
    gap, row = contact.dist[chosen], contact.efc_address[chosen]
    there = gap <= touch
    if look_ahead and not there.all():
        there |= gap + look_ahead * data.efc_vel[row] < 0.0
    chosen = chosen[there]
    own, bodies = own[chosen], bodies[chosen]
    # Where the character is the contact's first geom, MuJoCo's frame points into the
    # ground while its rows still measure separation: only the frame needs turning.
    sign = np.where(own[:, 0], -1.0, 1.0)
    return Contacts(
        body=np.where(own[:, 0], bodies[:, 0], bodies[:, 1]),
        position=contact.pos[chosen],
        frame=contact.frame[chosen].reshape(-1, 3, 3) * sign[:, None, None],
        row=row[there].astype(np.int64),
        friction=contact.friction[chosen, :2],
        gap=gap[there],
    )


def contact_jacobian(mj: mujoco.MjModel, data: mujoco.MjData, contacts: Contacts) -> Array:
    """Rows N, T1, T2 of each contact (3m, nv): the character's velocity along the frame's rows.

    With an elliptic cone they are rows of `efc_J`; with a pyramidal cone each pair of
    opposite edges is N +- mu T, from which N and T follow exactly.
    """
    rows = data.efc_J.reshape(-1, mj.nv)
    if mj.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC:
        jacobian = rows[(contacts.row[:, None] + _THREE).ravel()]
    else:
        jacobian = _from_pyramid(rows, contacts.row, contacts.friction)
    jacobian[:, ~is_character(mj)[mj.dof_bodyid]] = 0.0
    return np.asarray(jacobian)


def realised_forces(mj: mujoco.MjModel, data: mujoco.MjData, contacts: Contacts) -> Array:
    """World forces (m, 3) [N] on the character that the last solve gave these contacts."""
    force = data.efc_force
    if mj.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC:
        local = force[contacts.row[:, None] + _THREE]
    else:
        edges = force[contacts.row[:, None] + np.arange(4)]  # (m, 4)
        first, second = contacts.friction.T
        local = np.stack(
            [
                edges.sum(axis=1),
                first * (edges[:, 0] - edges[:, 1]),
                second * (edges[:, 2] - edges[:, 3]),
            ],
            axis=1,
        )
    return np.asarray(np.einsum("mij,mi->mj", contacts.frame, local))


def _from_pyramid(rows: Array, row: NDArray[np.int64], friction: Array) -> Array:
    edges = rows[row[:, None] + np.arange(4)]  # (m, 4, nv)
    normal = 0.5 * (edges[:, 0] + edges[:, 1])
    first = (edges[:, 0] - edges[:, 1]) / (2.0 * friction[:, 0:1])
    second = (edges[:, 2] - edges[:, 3]) / (2.0 * friction[:, 1:2])
    return np.stack([normal, first, second], axis=1).reshape(-1, rows.shape[1])


_THREE = np.arange(3)
