"""Left and right: the mirror image of a pose, joint by joint."""

from collections.abc import Mapping
from typing import TypeVar

import numpy as np

from rotctl.mechanics.bodies import SIDES
from rotctl.mechanics.model import Model
from rotctl.motion.pose_pair import Turn

Value = TypeVar("Value")


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
        name: angle * (sign_of(model, names.index(name)) if name in names else 1.0)
        for name, angle in exchanged(angles).items()
    }


def sign_of(model: Model, motor: int) -> float:
    """By which an angle of a motor goes over to its mirror image."""
    if model.joint_names[motor].endswith(SIDES):  # their axes are mirror images already
        return 1.0
    axis = np.abs(model.mj.jnt_axis[1 + motor])
    return 1.0 if axis[1] >= max(axis[0], axis[2]) else -1.0
