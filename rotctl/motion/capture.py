"""What every motion file becomes: the joints of a captured body over time."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.errors import InputError
from rotctl.rotations import Array

MAX_JOINTS = 500
MAX_FRAMES = 30_000
MAX_POSES = 3_000_000  # joints times frames: memory for some hundred bytes each

# Columns are the file's x, y, z in ours: x forward, y left, z up.
Y_UP_FACING_Z = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
Y_UP_FACING_X = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


@dataclass(frozen=True)
class Joint:
    """One joint of a captured body; world axes are x forward, y left, z up.

    Attributes:
        parent: its parent's name; empty for the root.
        position: (n, 3), in the file's unit of length.
        rotation: n rotations since the rest pose, in which the body faces +x.
    """

    parent: str
    position: Array
    rotation: Rotation


@dataclass(frozen=True)
class Capture:
    """A captured motion.

    Attributes:
        time: (n,) strictly increasing [s].
        joints: by name, parents first.
    """

    time: Array
    joints: dict[str, Joint]


def bounded(path: Path, joints: int, frames: int) -> None:
    """Refuse what would not fit into memory.

    Raises:
        InputError: there are too many joints times frames.
    """
    if joints * frames > MAX_POSES:
        raise InputError(
            f"{path}: {joints} joints in {frames} frames, at most {MAX_POSES // joints} frames"
        )


def assembled(
    time: Array,
    parents: dict[str, str],
    offsets: dict[str, Array],
    local: dict[str, Rotation],
    root: Array,
    axes: Array,
) -> Capture:
    """Forward kinematics of a skeleton in the file's own axes.

    Args:
        time: (n,) [s].
        parents: joint to parent, parents first; the first joint is the root.
        offsets: (3,) from a joint's parent to it, in the parent's frame.
        local: n rotations in the parent's frame.
        root: (n, 3) position of the root.
        axes: (3, 3) the file's axes in ours.
    """
    basis = Rotation.from_matrix(axes)
    position: dict[str, Array] = {}
    rotation: dict[str, Rotation] = {}
    for name, parent in parents.items():
        if parent:
            position[name] = position[parent] + rotation[parent].apply(offsets[name])
            rotation[name] = rotation[parent] * local[name]
        else:
            position[name], rotation[name] = root, local[name]
    return Capture(
        time,
        {
            name: Joint(parent, basis.apply(position[name]), basis * rotation[name] * basis.inv())
            for name, parent in parents.items()
        },
    )
