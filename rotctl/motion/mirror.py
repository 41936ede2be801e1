"""The mirror image of a motion, and its symmetric part."""

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.motion.sides import other_side, sign_of
from rotctl.motion.turning import Motion

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
    quaternions = motion.pelvis.as_quat(scalar_first=True)
    image = quaternions * _IN_MIRROR
    image[(quaternions * image).sum(axis=1) < 0.0] *= -1.0  # q and -q are one turn: of the two
    return Motion(poses, Rotation.from_quat(quaternions + image, scalar_first=True))  # the nearer


def _mirrored_poses(model: Model, poses: Array) -> Array:
    names = model.joint_names
    source = [names.index(other_side(name)) for name in names]
    sign = [sign_of(model, i) for i in range(len(names))]
    return np.asarray(poses[:, source] * sign)
