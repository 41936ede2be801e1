"""A start state, put into the physics."""

from math import atan, cos, sin, tan
from typing import Any

import mujoco
import numpy as np

from rotctl.behaviours.behaviour import Behaviour, Placement
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array, advance, cross
from rotctl.mechanics.bodies import ROOT_BODY
from rotctl.mechanics.model import Model
from rotctl.simulation.clearance import clearance
from rotctl.simulation.known import pitch
from rotctl.simulation.start import Start

SINK = 1e-6  # [m] into the ground, so that whether a start touches does not hang on rounding


def beginning(start: Start, behaviour: Behaviour[Any]) -> float:
    """The pitch at which a behaviour begins [rad]."""
    known = start.known
    return start.pitch if known is None else start.pitch + pitch(known, behaviour)


def place(model: Model, data: mujoco.MjData, start: Start, usual: Placement, axes: Array) -> None:
    """Put the character on the ground, moving. On a slope, its velocity is along the slope.

    Args:
        usual: the behaviour's own, where the start does not say otherwise.
        axes: (3, 3) rows are the behaviour's forward, left and up; the start's velocities are
            along them.
    """
    mj, known = model.mj, start.known
    mujoco.mj_resetData(mj, data)
    data.qpos[model.angles] = usual.pose if start.pose is None else start.pose
    if known is None:
        data.qpos[3:7] = advance(usual.orientation, product(start.tilt, axes))
    else:
        turn = start.tilt + np.array([0.0, start.pitch, 0.0])
        data.qpos[:2] = known.settings.place
        data.qpos[3:7] = advance(known.orientation, product(turn, axes))
    mujoco.mj_kinematics(mj, data)
    if start.height:
        mujoco.mj_comPos(mj, data)
        place = start.ahead * axes[0]
        place[2] = model.ground.height(*place[:2].tolist()) + start.height
        data.qpos[:3] += place - data.subtree_com[ROOT_BODY]
    else:
        gap = (start.gap or -SINK) if known is None else start.gap
        data.qpos[2] += gap - clearance(model, data)
    mujoco.mj_kinematics(mj, data)
    mujoco.mj_comPos(mj, data)
    offset = data.xpos[ROOT_BODY] - data.subtree_com[ROOT_BODY]
    x, y, z = start.velocity
    slope = atan(tan(model.ground.slope) * axes[0, 0])  # along the way
    velocity = product(np.array([x * cos(slope), y, z + x * sin(slope)]), axes)
    spin = product(start.angular_velocity, axes)
    data.qvel[:3] = velocity + cross(spin, offset)
    data.qvel[3:6] = product(spin, data.xmat[ROOT_BODY].reshape(3, 3))
    if known is not None:
        data.qvel[:3] += known.settings.velocity
        data.qvel[3:6] += known.settings.angular_velocity
        data.qvel[model.joints] = known.speeds
