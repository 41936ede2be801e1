"""Motions of the SMPL family (.npz, as AMASS has them): a rotation vector for each joint.

The body models are licensed and not needed: only directions are matched, so that a plain T-pose of
ordinary proportions stands in for the actor's body. Joints come in the order that all of the
family share (SMPL, -H, -X), hands and faces after them. z is up; the T-pose itself has y up
and faces +z.
"""

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.motion.capture import MAX_FRAMES, Capture, assembled, bounded
from rotctl.motion.untrusted import Arrays, arrays_of

# Joint: parent, offset from it [m], x left, y up, z forward.
_SKELETON: dict[str, tuple[str, tuple[float, float, float]]] = {
    "pelvis": ("", (0.0, 0.0, 0.0)),
    "left_hip": ("pelvis", (0.09, -0.08, 0.0)),
    "right_hip": ("pelvis", (-0.09, -0.08, 0.0)),
    "spine1": ("pelvis", (0.0, 0.11, 0.0)),
    "left_knee": ("left_hip", (0.0, -0.40, 0.0)),
    "right_knee": ("right_hip", (0.0, -0.40, 0.0)),
    "spine2": ("spine1", (0.0, 0.14, 0.0)),
    "left_ankle": ("left_knee", (0.0, -0.41, 0.0)),
    "right_ankle": ("right_knee", (0.0, -0.41, 0.0)),
    "spine3": ("spine2", (0.0, 0.06, 0.0)),
    "left_foot": ("left_ankle", (0.0, -0.06, 0.12)),
    "right_foot": ("right_ankle", (0.0, -0.06, 0.12)),
    "neck": ("spine3", (0.0, 0.21, 0.0)),
    "left_collar": ("spine3", (0.08, 0.12, 0.0)),
    "right_collar": ("spine3", (-0.08, 0.12, 0.0)),
    "head": ("neck", (0.0, 0.09, 0.0)),
    "left_shoulder": ("left_collar", (0.11, 0.0, 0.0)),
    "right_shoulder": ("right_collar", (-0.11, 0.0, 0.0)),
    "left_elbow": ("left_shoulder", (0.26, 0.0, 0.0)),
    "right_elbow": ("right_shoulder", (-0.26, 0.0, 0.0)),
    "left_wrist": ("left_elbow", (0.25, 0.0, 0.0)),
    "right_wrist": ("right_elbow", (-0.25, 0.0, 0.0)),
}
_RATES = ("mocap_framerate", "mocap_frame_rate", "fps", "frequency")


def read_smpl(path: Path) -> Capture:
    """Read a motion of the SMPL family.

    Raises:
        InputError: one line that names the file and what is wrong with it.
    """
    arrays = arrays_of(path)
    vectors = _vectors(arrays)
    n = len(vectors)
    if not 2 <= n <= MAX_FRAMES:
        raise InputError(f"{path}: {n} frames, valid: 2 to {MAX_FRAMES}")
    bounded(path, len(_SKELETON), n)
    return assembled(
        np.arange(n) / rate_of(arrays),
        {name: parent for name, (parent, _) in _SKELETON.items()},
        {name: np.array(offset) for name, (_, offset) in _SKELETON.items()},
        {name: Rotation.from_rotvec(vectors[:, i]) for i, name in enumerate(_SKELETON)},
        {"pelvis": arrays.numbers("trans", n, 3)},
        np.eye(3),
    )


def rate_of(arrays: Arrays) -> float:
    """The frame rate [Hz] of an .npz, under any of its names.

    Raises:
        InputError: there is none.
    """
    name = next((name for name in _RATES if name in arrays), None)
    if name is None:
        raise InputError(f"{arrays.path}: no frame rate ({', '.join(_RATES)})")
    rate = arrays.number(name)
    if not 1.0 <= rate <= 10_000.0:
        raise InputError(f"{arrays.path}: {name} is {rate:g}, valid: 1 to 10000 Hz")
    return rate


def _vectors(arrays: Arrays) -> Array:
    """Rotation vectors (n, joints, 3) [rad], the root's first."""
    if "poses" in arrays:
        flat = arrays.numbers("poses", None, None)
    elif "root_orient" in arrays and "pose_body" in arrays:
        root = arrays.numbers("root_orient", None, 3)
        flat = np.hstack([root, arrays.numbers("pose_body", len(root), 63)])
    elif "qpos" in arrays or "joint_pos" in arrays or "dof_pos" in arrays:
        raise InputError(f"{arrays.path}: has a robot's joints; name it with --model robot.xml")
    else:
        raise InputError(
            f"{arrays.path}: has neither poses nor root_orient and pose_body; "
            f"it has: {arrays.names}"
        )
    if flat.shape[1] % 3 or flat.shape[1] < 3 * len(_SKELETON):
        raise InputError(
            f"{arrays.path}: poses has {flat.shape[1]} columns, three a joint and "
            f"{3 * len(_SKELETON)} at least expected"
        )
    return np.asarray(flat.reshape(len(flat), -1, 3))
