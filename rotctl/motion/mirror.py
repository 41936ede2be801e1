"""The mirror image of a motion in the plane of the roll, and the symmetric part of one."""

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.mechanics.model import SIDES, Model
from rotctl.motion.turning import Motion
from rotctl.rotations import Array

_IN_MIRROR = np.array([1.0, -1.0, 1.0, -1.0])  # of w, x, y, z: a turn is a pseudo-vector


def mirrored(model: Model, motion: Motion) -> Motion:
    """Left and right exchanged; a turn about +y stays one."""
    quaternions = motion.pelvis.as_quat(scalar_first=True) * _IN_MIRROR
    return Motion(
        _mirrored_poses(model, motion.poses), Rotation.from_quat(quaternions, scalar_first=True)
    )


def symmetric(model: Model, motion: Motion) -> Motion:
    """The mean of a motion and its mirror image."""
    poses = 0.5 * (motion.poses + _mirrored_poses(model, motion.poses))
    quaternions = motion.pelvis.as_quat(scalar_first=True) * [1.0, 0.0, 1.0, 0.0]
    return Motion(poses, Rotation.from_quat(quaternions, scalar_first=True))


def _mirrored_poses(model: Model, poses: Array) -> Array:
    names = model.joint_names
    left, right = SIDES
    source, sign = [], []
    for i, name in enumerate(names):
        if name.endswith(SIDES):  # their axes are mirror images already
            other = name[:-2] + (right if name.endswith(left) else left)
            source.append(names.index(other))
            sign.append(1.0)
        else:
            axis = np.abs(model.mj.jnt_axis[1 + i])
            source.append(i)
            sign.append(1.0 if axis[1] >= max(axis[0], axis[2]) else -1.0)
    return np.asarray(poses[:, source] * sign)
