"""How feet should meet the ground: how far the centre of mass is ahead of them, and in which pose.

About the middle of the feet a landing body has the angular momentum H + m (z v + d u) about left:
z and d are the centre of mass's height over the feet and how far it is ahead of them, v and u its
speeds forward and down. The ground's force at the feet cannot change it, gravity can, by m g d a
second. Where it shall be gone after the time T, it asks for

    d = -(H + m z v) / (m (u + g T)),

and the body is turned about left until the centre of mass is there, on flat feet.
"""

from math import atan2
from typing import NamedTuple

import mujoco
import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.support import ends, middle
from rotctl.maths.rotations import Array, quaternion_from_rotation_vector
from rotctl.mechanics.bodies import ROOT_BODY, body_ids, lowest_and_highest
from rotctl.mechanics.hulls import hulls
from rotctl.mechanics.model import Model
from rotctl.motion import Poses, Turn, make_pose_pair
from rotctl.settings.fields import STRICT, NonNegative, Positive, SomeNames

ATTITUDES = np.arange(-80, 141) / 100.0  # [rad] of the pelvis from upright, at which d is tabulated


@validated(frozen=True, config=STRICT)
class LandingSettings:
    """How a body lands on its feet.

    Attributes:
        pose: by joint name [rad]; ankles are bent further, so that the feet are flat.
        bodies: that land.
        ankle: joint between them and the leg, about the left axis.
        time: T, in which gravity may take the angular momentum about the feet [s].
        share: of H that counts [-]; limbs take up a part of it.
        most: furthest that the centre of mass may be ahead of the feet, or behind [m].
        hip: joint that puts the legs where they belong under a pelvis that has not turned enough,
            or too far; none if empty.
    """

    pose: dict[str, Turn]
    bodies: SomeNames
    ankle: str
    time: NonNegative
    share: NonNegative
    most: Positive
    hip: str = ""


class Contact(NamedTuple):
    """The body as it meets the ground.

    Attributes:
        attitude: of the pelvis about left, from upright [rad].
        pose: (nu,) [rad].
        offset: how far the centre of mass is ahead of the middle of the feet [m].
        height: of the centre of mass over the lowest point of the feet [m].
    """

    attitude: float
    pose: Array
    offset: float
    height: float


class Landing:
    """The landing law of one model."""

    def __init__(self, settings: LandingSettings, model: Model, key: str) -> None:
        """Tabulate the offset over the attitude.

        Args:
            key: where the settings stand.

        Raises:
            InputError: a joint or a body is not there.
        """
        self._settings, self._model, self._key = settings, model, key
        self._feet = body_ids(model.mj, settings.bodies, f"{key}.bodies")
        self._ankles = model.motors(settings.ankle, f"{key}.ankle")
        self._hips = model.motors(settings.hip, f"{key}.hip") if settings.hip else []
        self._pose = make_pose_pair(model, Poses(dict(settings.pose)), f"{key}.pose").start(0.0)
        self._data = mujoco.MjData(model.mj)
        found = [self.contact(a) for a in ATTITUDES.tolist()]
        low, high = model.joint_range[self._ankles[0]].tolist()
        flat = [c for c in found if c and low < c.pose[self._ankles[0]] < high]
        self._offsets = np.array([c.offset for c in flat])
        self._attitudes = np.array([c.attitude for c in flat])

    def offset(self, momentum: float, forward: float, down: float, height: float) -> float:
        """How far the centre of mass should be ahead of the feet at touch-down [m].

        Args:
            momentum: H about left [kg m2/s].
            forward, down: velocity of the centre of mass at touch-down [m/s].
            height: of the centre of mass over the feet there [m].
        """
        s, mass = self._settings, self._model.mass
        fall = -float(self._model.gravity[2])
        d = -(s.share * momentum / mass + height * forward) / (down + fall * s.time)
        return min(max(d, -s.most), s.most)

    def contact(self, attitude: float) -> Contact:
        """The body at an attitude of the pelvis [rad], on flat feet where the ankles allow it."""
        mj, data, pose = self._model.mj, self._data, self._pose.copy()
        for _ in range(2):
            data.qpos[:3] = 0.0
            data.qpos[3:7] = quaternion_from_rotation_vector(np.array([0.0, attitude, 0.0]))
            data.qpos[self._model.angles] = pose
            mujoco.mj_kinematics(mj, data)
            x, _, z = data.xmat[self._feet[0]].reshape(3, 3)[:, 0].tolist()
            axis = data.xaxis[mj.actuator_trnid[self._ankles[0], 0]]
            pose[self._ankles] -= atan2(-z, x) * (1.0 if axis[1] > 0.0 else -1.0)
        mujoco.mj_comPos(mj, data)
        com = data.subtree_com[ROOT_BODY]
        under = np.isin(mj.geom_bodyid, self._feet) & (mj.geom_contype > 0)
        if hulls(mj):
            sole = lowest_and_highest(mj, data, under)[0]
        else:
            sole = float((data.geom_xpos[under, 2] - mj.geom_size[under, 0]).min())
        ahead = float(com[0]) - middle(ends(self._model, data, self._feet))[0]
        return Contact(attitude, pose, ahead, float(com[2]) - sole)

    def at(self, offset: float) -> Contact:
        """The body with its centre of mass so far ahead of its feet [m], as near as it can."""
        return self.contact(float(np.interp(offset, self._offsets, self._attitudes)))

    @property
    def legs_reach(self) -> bool:
        """Whether legs take up what the pelvis has not turned."""
        return bool(self._hips)

    def placed(self, pose: Array, missing: float) -> Array:
        """A pose (nu,) with legs turned for a pelvis that has so far still to turn [rad]."""
        placed = pose.copy()
        low, high = self._model.joint_range[self._hips].T
        placed[self._hips] = np.minimum(np.maximum(placed[self._hips] - missing, low), high)
        return placed
