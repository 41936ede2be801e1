"""Where a motion takes the body over level ground: its lowest point rests there, without slip."""

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.maths.rotations import Array
from rotctl.mechanics.bodies import ROOT_BODY
from rotctl.mechanics.model import Model
from rotctl.motion.turning import Motion, qpos


def rolled(model: Model, motion: Motion, heading: float = 0.0) -> Array:
    """Generalised positions (n, nq) of a motion that rolls on what is lowest at each moment.

    Args:
        heading: where it goes, seen from above, from world +x [rad].
    """
    mj = model.mj
    turned = Motion(motion.poses, Rotation.from_rotvec([0.0, 0.0, heading]) * motion.pelvis)
    data, positions = mujoco.MjData(mj), qpos(model, turned)
    lowest, arm, body = np.zeros(3), np.zeros(3), 0
    for i, position in enumerate(positions):
        data.qpos[:] = position
        mujoco.mj_kinematics(mj, data)
        if i:  # the point that was lowest stays where it was
            moved = data.xpos[body] + data.xmat[body].reshape(3, 3) @ arm
            position[:2] += lowest[:2] - moved[:2]
            data.qpos[:] = position
            mujoco.mj_kinematics(mj, data)
        geom, lowest = _lowest_point(model, data)
        body = mj.geom_bodyid[geom]
        arm = data.xmat[body].reshape(3, 3).T @ (lowest - data.xpos[body])
        position[2] -= lowest[2]
    return positions


def heights(model: Model, positions: Array) -> Array:
    """How far the lowest point of each posture (n, nq) is above z = 0 (n,) [m]."""
    data, found = mujoco.MjData(model.mj), []
    for position in positions:
        data.qpos[:] = position
        mujoco.mj_kinematics(model.mj, data)
        found.append(_lowest_point(model, data)[1][2])
    return np.array(found)


def centres(model: Model, positions: Array) -> Array:
    """The centre of mass of each posture (n, nq): (n, 3) [m]."""
    data, found = mujoco.MjData(model.mj), []
    for position in positions:
        data.qpos[:] = position
        mujoco.mj_kinematics(model.mj, data)
        mujoco.mj_comPos(model.mj, data)
        found.append(data.subtree_com[ROOT_BODY].copy())
    return np.array(found)


def _lowest_point(model: Model, data: mujoco.MjData) -> tuple[int, Array]:
    """The solid geom that reaches lowest, and that point of it, of spheres and capsules."""
    mj = model.mj
    solid = np.flatnonzero((mj.geom_bodyid > 0) & (mj.geom_contype > 0))
    capsule = mj.geom_type[solid] == mujoco.mjtGeom.mjGEOM_CAPSULE
    axis = data.geom_xmat[solid, 2::3] * (mj.geom_size[solid, 1] * capsule)[:, None]
    ends = data.geom_xpos[solid] - np.sign(axis[:, 2:]) * axis
    height = ends[:, 2] - mj.geom_size[solid, 0]
    least = int(np.argmin(height))
    return int(solid[least]), np.array([*ends[least, :2], height[least]])
