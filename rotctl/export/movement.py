"""Where the bodies of a logged run were, by forward kinematics alone."""

from dataclasses import dataclass

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.errors import LogError
from rotctl.log import RunLog
from rotctl.maths.rotations import Array
from rotctl.report import stored_model
from rotctl.report.rows import drawable

ROOT = 1  # MuJoCo's id of the character's first body


@dataclass(frozen=True)
class Movement:
    """A run's bodies over time; world axes, z up.

    Attributes:
        model: as it was simulated.
        time: (n,) even [s].
        states: (n, nq) generalised positions.
        velocities: (n, nv).
        place: (n, nbody, 3) [m].
        turned: (n, nbody, 4) w, x, y, z.
    """

    model: mujoco.MjModel
    time: Array
    states: Array
    velocities: Array
    place: Array
    turned: Array

    @property
    def period(self) -> float:
        """From row to row [s]."""
        return float(np.median(np.diff(self.time))) if len(self.time) > 1 else 1.0 / 60.0

    @property
    def character(self) -> list[int]:
        """The character's bodies, parents first."""
        return np.flatnonzero(self.model.body_rootid == ROOT).tolist()

    @property
    def joints(self) -> list[int]:
        """The character's hinges."""
        hinge = self.model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE
        return np.flatnonzero(
            hinge & (self.model.body_rootid[self.model.jnt_bodyid] == ROOT)
        ).tolist()

    def name(self, body: int) -> str:
        """What a body is called."""
        return self.model.body(body).name or f"body_{body}"

    def rest(self) -> tuple[Array, Rotation]:
        """Places (nbody, 3) and orientations of the bodies at zero angles."""
        data = mujoco.MjData(self.model)
        mujoco.mj_kinematics(self.model, data)
        return data.xpos.copy(), Rotation.from_quat(data.xquat, scalar_first=True)

    def end(self, body: int) -> Array:
        """The middle of a body's farthest solid geom (3,), in the body's frame [m]."""
        model = self.model
        geoms = np.flatnonzero(model.geom_bodyid == body)
        solid = [g for g in geoms if model.geom_contype[g] or model.geom_conaffinity[g]]
        places = [model.geom_pos[g] for g in solid or geoms]
        return max(places, key=lambda at: float(np.abs(at).max()), default=np.zeros(3))


def movement(log: RunLog) -> Movement:
    """A log's bodies over all rows in which nothing has broken down.

    Raises:
        LogError: the log is damaged, its model is not safe to load, or no row is of use.
    """
    model = stored_model.load(log)
    if model.jnt_type[0] != mujoco.mjtJoint.mjJNT_FREE:
        raise LogError(f"{log.path}: the first joint of its model is no freejoint")
    states, velocities = log["trajectory/qpos"], log["trajectory/qvel"]
    time = drawable(log, np.hstack([states, velocities]))
    n = len(time)
    data = mujoco.MjData(model)
    place, turned = np.empty((n, model.nbody, 3)), np.empty((n, model.nbody, 4))
    for i in range(n):
        data.qpos[:] = states[i]
        mujoco.mj_kinematics(model, data)
        place[i], turned[i] = data.xpos, data.xquat
    return Movement(model, time, states[:n], velocities[:n], place, turned)
