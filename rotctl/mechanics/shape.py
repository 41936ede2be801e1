"""Shapes of the body apart from its motion: inertia, and the turn that a change of shape is.

A body without angular momentum turns all the same where it changes its shape: as a cat does,
and as the pelvis of a tucked jumper who stretches.
"""

import mujoco

from rotctl.mechanics.model import Model
from rotctl.mechanics.momentum import Spin, read_spin
from rotctl.rotations import Array, Numbers, dotted

PARTS = 8  # of a change of shape, each with the inertia of its middle


class Shapes:
    """Poses (nu,) [rad] of a character whose pelvis stays upright at the origin."""

    def __init__(self, model: Model) -> None:
        """Keep a scratch space."""
        self._model = model
        self._data = mujoco.MjData(model.mj)

    def momentum(self, pose: Array, rate: Array | None = None) -> Spin:
        """Of a pose whose joints move at a rate (nu,) [rad/s], if at all."""
        mj, data, joints = self._model.mj, self._data, self._model.joints
        data.qpos[self._model.angles] = pose
        data.qvel[joints] = 0.0 if rate is None else rate
        mujoco.mj_kinematics(mj, data)
        mujoco.mj_comPos(mj, data)
        mujoco.mj_makeM(mj, data)
        return read_spin(mj, data)

    def inertia(self, pose: Array, axis: Array) -> float:
        """Of the whole body about its centre of mass and a unit axis of the pelvis [kg m2]."""
        return _about(self.momentum(pose).inertia, axis.tolist())

    def turn(self, start: Array, end: Array, axis: Array) -> float:
        """How far the pelvis turns about an axis of its own from one pose to another [rad].

        The body has no momentum about that axis: what the joints' motion would give it, the
        whole body's turning takes back.
        """
        step, turned, about = (end - start) / PARTS, 0.0, axis.tolist()
        for part in range(PARTS):
            found = self.momentum(start + (part + 0.5) * step, step)
            turned -= dotted(found.angular.tolist(), about) / _about(found.inertia, about)
        return turned


def _about(inertia: Array, axis: Numbers) -> float:
    """Moment of inertia about an axis [kg m2]."""
    return dotted([dotted(row, axis) for row in inertia.tolist()], axis)
