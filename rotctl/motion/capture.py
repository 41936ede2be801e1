"""What every motion file becomes: the joints of a captured body over time."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.errors import InputError
from rotctl.maths.rotations import Array

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
        rotation: n rotations since the rest pose, the one of zero angles.
        rest: (3,) its position in that pose, which need not be one that a human takes.
    """

    parent: str
    position: Array
    rotation: Rotation
    rest: Array


@dataclass(frozen=True)
class Capture:
    """A captured motion.

    Attributes:
        time: (n,) strictly increasing [s].
        joints: by name, parents first.
        upright: whether z is known to be up; a kind of file may leave that open.
    """

    time: Array
    joints: dict[str, Joint]
    upright: bool = True


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
    moves: dict[str, Array],
    axes: Array,
) -> Capture:
    """Forward kinematics of a skeleton in the file's own axes.

    Args:
        time: (n,) [s].
        parents: joint to parent, parents first; the first joint is the root.
        offsets: (3,) from a joint's parent to it, in the parent's frame.
        local: n rotations in the parent's frame.
        moves: (n, 3) in place of the offset, of the root and any joint that slides.
        axes: (3, 3) the file's axes in ours.
    """
    basis = Rotation.from_matrix(axes)
    position: dict[str, Array] = {}
    rotation: dict[str, Rotation] = {}
    rest: dict[str, Array] = {}
    for name, parent in parents.items():
        if parent:
            local_position = moves.get(name, offsets[name])
            position[name] = position[parent] + rotation[parent].apply(local_position)
            rotation[name] = rotation[parent] * local[name]
            rest[name] = rest[parent] + offsets[name]
        else:
            position[name], rotation[name], rest[name] = moves[name], local[name], np.zeros(3)
    return Capture(
        time,
        {
            name: Joint(
                parent,
                basis.apply(position[name]),
                basis * rotation[name] * basis.inv(),
                basis.apply(rest[name]),
            )
            for name, parent in parents.items()
        },
    )
