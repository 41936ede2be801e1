"""Shapes of the body apart from its motion: inertia, and the turn that a change of shape is.

A body without angular momentum turns all the same where it changes its shape: as a cat does,
and as the pelvis of a tucked jumper who stretches.
"""

from typing import NamedTuple

import mujoco
import numpy as np

from rotctl.maths.rotations import Array, Numbers, Triple, crossed, dotted
from rotctl.mechanics.bodies import ROOT_BODY
from rotctl.mechanics.model import Model

PARTS = 8  # of a change of shape, each with the inertia of its middle


class Spin(NamedTuple):
    """About the centre of mass, in the pelvis's frame.

    Attributes:
        angular: (3,) angular momentum [kg m2/s].
        inertia: rows of (3, 3) [kg m2].
    """

    angular: Triple
    inertia: tuple[Triple, Triple, Triple]


class Shapes:
    """Poses (nu,) [rad] of a character whose pelvis stays upright where it is."""

    def __init__(self, model: Model) -> None:
        """Keep a scratch space."""
        self._model = model
        self._data = data = mujoco.MjData(model.mj)
        self._angles, self._rates = data.qpos[model.angles], data.qvel[model.joints]
        self._momentum, self._root = np.empty(model.mj.nv), data.qpos[:3].copy()

    def spin(self, pose: Array, rate: Array | float = 0.0) -> Spin:
        """Of a pose whose joints move at a rate (nu,) [rad/s].

        As `rotctl.mechanics.momentum` has it, where the root's frame is the world's.
        """
        mj, data, generalised = self._model.mj, self._data, self._momentum
        self._angles[:] = pose
        self._rates[:] = rate
        mujoco.mj_kinematics(mj, data)
        mujoco.mj_comPos(mj, data)
        mujoco.mj_makeM(mj, data)
        mujoco.mj_mulM(mj, data, generalised, data.qvel)
        *linear, hx, hy, hz = generalised[:6].tolist()
        x, y, z = crossed((data.subtree_com[ROOT_BODY] - self._root).tolist(), linear)
        xx, yy, zz, xy, xz, yz = data.crb[ROOT_BODY, :6].tolist()
        return Spin((hx - x, hy - y, hz - z), ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)))

    def inertia(self, pose: Array, axis: Array) -> float:
        """Of the whole body about its centre of mass and a unit axis of the pelvis [kg m2]."""
        return _about(self.spin(pose).inertia, axis.tolist())

    def turn(self, start: Array, end: Array, axis: Array) -> float:
        """How far the pelvis turns about an axis of its own from one pose to another [rad].

        The body has no momentum about that axis: what the joints' motion would give it, the
        whole body's turning takes back.
        """
        step, turned, about = (end - start) / PARTS, 0.0, axis.tolist()
        for part in range(PARTS):
            found = self.spin(start + (part + 0.5) * step, step)
            turned -= dotted(found.angular, about) / _about(found.inertia, about)
        return turned


def _about(inertia: tuple[Triple, Triple, Triple], axis: Numbers) -> float:
    """Moment of inertia about an axis [kg m2]."""
    return dotted([dotted(row, axis) for row in inertia], axis)
