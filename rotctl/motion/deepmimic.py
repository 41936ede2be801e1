"""DeepMimic motion files (JSON): a row of 44 numbers a frame, for one skeleton.

A row is its duration, the root's position and orientation, then joint after joint: a
quaternion (w, x, y, z) or the angle of a hinge about z. y is up, x forward, z to the right.
The skeleton is not in the file; its joints stand as in DeepMimic's `humanoid3d`.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.motion.capture import MAX_FRAMES, Y_UP_FACING_X, Capture, assembled
from rotctl.motion.untrusted import LARGEST, text_of
from rotctl.settings.json_documents import from_json

# Joint: parent, offset from it [m], numbers in a row (4 a quaternion, 1 a hinge, 0 fixed).
_SKELETON: dict[str, tuple[str, tuple[float, float, float], int]] = {
    "root": ("", (0.0, 0.0, 0.0), 4),
    "chest": ("root", (0.0, 0.236, 0.0), 4),
    "neck": ("chest", (0.0, 0.224, 0.0), 4),
    "right_hip": ("root", (0.0, 0.0, 0.085), 4),
    "right_knee": ("right_hip", (0.0, -0.422, 0.0), 1),
    "right_ankle": ("right_knee", (0.0, -0.410, 0.0), 4),
    "right_shoulder": ("chest", (-0.024, 0.244, 0.183), 4),
    "right_elbow": ("right_shoulder", (0.0, -0.275, 0.0), 1),
    "right_wrist": ("right_elbow", (0.0, -0.259, 0.0), 0),
    "left_hip": ("root", (0.0, 0.0, -0.085), 4),
    "left_knee": ("left_hip", (0.0, -0.422, 0.0), 1),
    "left_ankle": ("left_knee", (0.0, -0.410, 0.0), 4),
    "left_shoulder": ("chest", (-0.024, 0.244, -0.183), 4),
    "left_elbow": ("left_shoulder", (0.0, -0.275, 0.0), 1),
    "left_wrist": ("left_elbow", (0.0, -0.259, 0.0), 0),
}
_ROW = 4 + sum(count for _, _, count in _SKELETON.values())


def read_deepmimic(path: Path) -> Capture:
    """Read a DeepMimic motion.

    Raises:
        InputError: one line that names the file and the line or frame in it.
    """
    rows = _rows(path)
    n = len(rows)
    local, column = {}, 4
    for name, (_, _, count) in _SKELETON.items():
        values = rows[:, column : column + count]
        if count == 4:
            short = np.flatnonzero(np.linalg.norm(values, axis=1) < 0.5)
            if len(short):
                raise InputError(f"{path}: frame {short[0] + 1}: {name} has no unit quaternion")
            local[name] = Rotation.from_quat(values, scalar_first=True)
        elif count == 1:
            local[name] = Rotation.from_rotvec(values * [0.0, 0.0, 1.0])
        else:
            local[name] = Rotation.identity(n)
        column += count
    return assembled(
        np.append(0.0, np.cumsum(rows[:-1, 0])),  # a duration lasts until the next frame
        {name: parent for name, (parent, _, _) in _SKELETON.items()},
        {name: np.array(offset) for name, (_, offset, _) in _SKELETON.items()},
        local,
        {"root": rows[:, 1:4]},
        Y_UP_FACING_X,
    )


def _rows(path: Path) -> Array:
    try:
        data: Any = from_json(text_of(path))
    except ValueError as error:
        line = f":{error.lineno}" if isinstance(error, json.JSONDecodeError) else ""
        reason = error.msg if isinstance(error, json.JSONDecodeError) else error
        raise InputError(f"{path}{line}: is no JSON: {reason}") from None
    rows = data.get("Frames") if isinstance(data, dict) else None
    if not isinstance(rows, list) or not 2 <= len(rows) <= MAX_FRAMES:
        raise InputError(f"{path}: Frames must be a list of 2 to {MAX_FRAMES} frames")
    for i, row in enumerate(rows, 1):
        if not isinstance(row, list) or len(row) != _ROW:
            found = len(row) if isinstance(row, list) else 0
            raise InputError(
                f"{path}: frame {i}: {found} values, {_ROW} expected; only humanoid3d is read"
            )
        for value in row:
            if type(value) not in (int, float) or not abs(value) < LARGEST:
                raise InputError(f"{path}: frame {i}: {value!r:.40} is no number")
        if i < len(rows) and not 1e-4 <= row[0] <= 1.0:
            raise InputError(f"{path}: frame {i}: lasts {row[0]:g} s, valid: 0.0001 to 1 s")
    return np.array(rows, dtype=float)
