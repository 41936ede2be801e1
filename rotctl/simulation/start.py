"""Start states, drawn from the seed."""

from dataclasses import dataclass

import mujoco
import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.mechanics.model import Model
from rotctl.rotations import Array, advance, cross
from rotctl.settings import STRICT, Range


@validated(frozen=True, config=STRICT)
class StartSettings:
    """Uniform ranges that a start state is drawn from.

    Attributes:
        pitch: of the pelvis about world y [rad]; negative leans back.
        speed_x, speed_y: velocity of the centre of mass [m/s].
        angular_velocity_x, angular_velocity_y, angular_velocity_z: of the whole body,
            moving as one rigid piece [rad/s].
    """

    name: str
    pitch: Range
    speed_x: Range
    speed_y: Range
    angular_velocity_x: Range
    angular_velocity_y: Range
    angular_velocity_z: Range
    description: str = ""


@dataclass(frozen=True)
class Start:
    """A drawn start: pitch [rad], velocity (3,) [m/s], angular velocity (3,) [rad/s]."""

    pitch: float
    velocity: Array
    angular_velocity: Array


def draw(settings: StartSettings, generator: np.random.Generator) -> Start:
    """Draw pitch, speeds and angular velocities, in the order the settings list them."""
    pitch, vx, vy, wx, wy, wz = (
        generator.uniform(*bounds)
        for bounds in (
            settings.pitch,
            settings.speed_x,
            settings.speed_y,
            settings.angular_velocity_x,
            settings.angular_velocity_y,
            settings.angular_velocity_z,
        )
    )
    return Start(float(pitch), np.array([vx, vy, 0.0]), np.array([wx, wy, wz]))


def place(model: Model, data: mujoco.MjData, start: Start, orientation: Array, pose: Array) -> None:
    """Put the character on the ground, moving. On a slope, pitch and velocity are relative to it.

    Args:
        orientation: (4,) of the pelvis before it is pitched, unit quaternion.
        pose: (nu,) [rad].
    """
    mj = model.mj
    mujoco.mj_resetData(mj, data)
    data.qpos[7:] = pose
    slope = model.ground.slope
    pitch = np.array([0.0, start.pitch - slope, 0.0])
    data.qpos[3:7] = advance(orientation, pitch)
    mujoco.mj_kinematics(mj, data)
    data.qpos[2] -= _clearance(model, data)
    mujoco.mj_kinematics(mj, data)
    mujoco.mj_comPos(mj, data)
    offset = data.xpos[1] - data.subtree_com[1]
    x, y, z = start.velocity
    velocity = np.array([x * np.cos(slope), y, z + x * np.sin(slope)])
    data.qvel[:3] = velocity + cross(start.angular_velocity, offset)
    data.qvel[3:6] = data.xmat[1].reshape(3, 3).T @ start.angular_velocity


def _clearance(model: Model, data: mujoco.MjData) -> float:
    """How far the character can be lowered before it touches the ground [m]."""
    mj, ground = model.mj, model.ground
    least = np.inf
    for geom in np.flatnonzero((mj.geom_bodyid > 0) & (mj.geom_contype > 0)):
        capsule = mj.geom_type[geom] == mujoco.mjtGeom.mjGEOM_CAPSULE
        half = mj.geom_size[geom, 1] * capsule * data.geom_xmat[geom].reshape(3, 3)[:, 2]
        for x, y, z in (data.geom_xpos[geom] + half, data.geom_xpos[geom] - half):
            # A sphere on the plane that touches the ground below its centre.
            upright = ground.normal(x, y)[2]
            least = min(least, z - ground.height(x, y) - mj.geom_size[geom, 0] / upright)
    return float(least)
