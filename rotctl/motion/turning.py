"""How far a given motion turns the body: AV and AE of a sequence of postures."""

from dataclasses import dataclass

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.mechanics.momentum import read_momentum
from rotctl.motion.clip import TurnAbout

AXIS = np.array([0.0, 1.0, 0.0])  # every roll is about world +y, to +x
# Columns are the pelvis's forward, left and up at phase 0, in the world.
_UPRIGHT: dict[TurnAbout, Array] = {
    "left": np.eye(3),
    "right": np.diag([-1.0, -1.0, 1.0]),
    "head": np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
    "face": np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),
}


@dataclass(frozen=True)
class Motion:
    """Postures one after the other, over time or over a phase.

    Attributes:
        poses: (n, nu) joint angles [rad].
        pelvis: n orientations in the world.
    """

    poses: Array
    pelvis: Rotation

    def __getitem__(self, chosen: slice) -> "Motion":
        return Motion(self.poses[chosen], self.pelvis[chosen])


def upright(roll_about: TurnAbout) -> Rotation:
    """The pelvis's orientation at phase 0: upright, or supine with the head to +y."""
    return Rotation.from_matrix(_UPRIGHT[roll_about])


def rolled_by(angles: Array) -> Rotation:
    """Turns about the rolling axis by angles (n,) [rad]."""
    return Rotation.from_rotvec(np.outer(angles, AXIS))


def pelvis_turn(pelvis: Rotation, roll_about: TurnAbout) -> Array:
    """How far each orientation has turned about +y since phase 0 (n,), unwrapped [rad]."""
    turned = (pelvis * upright(roll_about).inv()).as_matrix()
    angle = np.arctan2(turned[:, 0, 2] - turned[:, 2, 0], turned[:, 0, 0] + turned[:, 2, 2])
    return np.asarray(np.unwrap(angle))


def rotation_between_postures(model: Model, motion: Motion) -> Array:
    """The whole body's turn I_c^-1 H dt (n - 1, 3) from each posture to the next [rad].

    It does not depend on how fast that happens, nor on where the body is.
    """
    mj = model.mj
    data, positions = mujoco.MjData(mj), qpos(model, motion)
    step, turns = np.empty(mj.nv), []
    for before, after in zip(positions[:-1], positions[1:], strict=True):
        mujoco.mj_differentiatePos(mj, step, 1.0, before, after)
        data.qpos[:], data.qvel[:] = before, step
        mujoco.mj_integratePos(mj, data.qpos, step, 0.5)  # second order: from halfway
        mujoco.mj_fwdPosition(mj, data)
        turns.append(read_momentum(mj, data).angular_velocity)
    return np.array(turns)


def qpos(model: Model, motion: Motion) -> Array:
    """Generalised positions (n, nq), high above the ground."""
    positions = np.empty((len(motion.poses), model.mj.nq))
    positions[:, :3] = [0.0, 0.0, 100.0]
    positions[:, 3:7] = motion.pelvis.as_quat(canonical=True, scalar_first=True)
    positions[:, 7:] = motion.poses
    return positions
