"""A run as the tables that motion trackers read: the root and the joints' angles, row by row."""

import io
import zipfile
from typing import Any

import mujoco
import numpy as np

from rotctl.export.movement import Movement
from rotctl.maths.rotations import Array

_EPOCH = (1980, 1, 1, 0, 0, 0)  # of a zip: equal runs give equal bytes


def csv(run: Movement) -> bytes:
    """Root place [m], root quaternion (x, y, z, w), joint angles [rad]; without a header.

    That is the layout of LAFAN1 on robots, which mjlab's and BeyondMimic's converters read.
    """
    root = run.states[:, :7]
    table = np.hstack([root[:, :3], np.roll(root[:, 3:], -1, axis=1), _angles(run)])
    rows = [",".join(f"{x:.9g}" for x in row) for row in table]
    return ("\n".join(rows) + "\n").encode()


def npz(run: Movement) -> bytes:
    """Both common layouts in one: `qpos` and its like, `joint_pos` and the bodies in the world."""
    names = [run.model.joint(j).name for j in run.joints]
    linear, angular = _velocities(run)
    arrays: dict[str, Any] = {
        "fps": np.array([1.0 / run.period]),
        "frequency": np.array(1.0 / run.period),
        "time": run.time,
        "joint_names": np.array(names),
        "body_names": np.array([run.name(b) for b in run.character]),
        "qpos": np.hstack([run.states[:, :7], _angles(run)]),
        "qvel": np.hstack([run.velocities[:, :6], _rates(run)]),
        "joint_pos": _angles(run),
        "joint_vel": _rates(run),
        "body_pos_w": run.place[:, run.character],
        "body_quat_w": run.turned[:, run.character],
        "body_lin_vel_w": linear,
        "body_ang_vel_w": angular,
    }
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in arrays.items():
            part = io.BytesIO()
            np.lib.format.write_array(part, np.ascontiguousarray(array), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy", _EPOCH), part.getvalue())
    return out.getvalue()


def _angles(run: Movement) -> Array:
    return np.asarray(run.states[:, run.model.jnt_qposadr[run.joints]])


def _rates(run: Movement) -> Array:
    return np.asarray(run.velocities[:, run.model.jnt_dofadr[run.joints]])


def _velocities(run: Movement) -> tuple[Array, Array]:
    """Of the bodies' origins [m/s] and of the bodies [rad/s], (n, bodies, 3), world axes."""
    model, data = run.model, mujoco.MjData(run.model)
    linear, angular = (np.empty((len(run.time), len(run.character), 3)) for _ in range(2))
    velocity = np.empty(6)
    for i, (state, rate) in enumerate(zip(run.states, run.velocities, strict=True)):
        data.qpos[:], data.qvel[:] = state, rate
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        for k, body in enumerate(run.character):
            kind = mujoco.mjtObj.mjOBJ_XBODY
            mujoco.mj_objectVelocity(model, data, kind, body, velocity, 0)
            angular[i, k], linear[i, k] = velocity[:3], velocity[3:]
    return linear, angular
