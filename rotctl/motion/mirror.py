"""The mirror image of a motion or of a pose, and the symmetric part of a motion."""

from collections.abc import Mapping
from typing import TypeVar

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.mechanics.model import SIDES, Model
from rotctl.motion.pose_pair import Turn
from rotctl.motion.turning import Motion
from rotctl.rotations import Array

Value = TypeVar("Value")

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


def other_side(name: str) -> str:
    """The name of a joint's mirror image; its own, if it is of no side or of both."""
    left, right = SIDES
    return name[:-2] + (right if name.endswith(left) else left) if name.endswith(SIDES) else name


def exchanged(values: Mapping[str, Value]) -> dict[str, Value]:
    """What is said of joints, by name, said of their mirror images."""
    return {other_side(name): value for name, value in values.items()}


def mirrored_angles(model: Model, angles: Mapping[str, Turn]) -> dict[str, Turn]:
    """The mirror image of a pose by joint name [rad]."""
    names = model.joint_names
    return {
        name: angle * (_sign(model, names.index(name)) if name in names else 1.0)
        for name, angle in exchanged(angles).items()
    }


def _mirrored_poses(model: Model, poses: Array) -> Array:
    names = model.joint_names
    source = [names.index(other_side(name)) for name in names]
    sign = [_sign(model, i) for i in range(len(names))]
    return np.asarray(poses[:, source] * sign)


def _sign(model: Model, motor: int) -> float:
    """By which an angle of a motor goes over to its mirror image."""
    if model.joint_names[motor].endswith(SIDES):  # their axes are mirror images already
        return 1.0
    axis = np.abs(model.mj.jnt_axis[1 + motor])
    return 1.0 if axis[1] >= max(axis[0], axis[2]) else -1.0
