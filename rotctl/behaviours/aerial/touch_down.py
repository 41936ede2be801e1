"""The end of a flight: the body as it meets the ground, and how long it is until then."""

from math import radians, sqrt

import mujoco
import numpy as np

from rotctl.behaviours.aerial.flight_settings import EntrySettings, FlightSettings
from rotctl.behaviours.aerial.landing import Contact, Landing
from rotctl.maths.rotations import Array, quaternion_from_rotation_vector
from rotctl.mechanics.bodies import ROOT_BODY, body_ids, is_character, lowest_and_highest
from rotctl.mechanics.model import Model
from rotctl.motion import make_pose

ROUNDING = 1e-6  # [m]
LEAST_TIME = 1e-3  # [s] to the landing


class TouchDown:
    """The landing of one run's flight.

    Attributes:
        feet: that it lands on as its motion asks for; None where it always lands alike.
        usual: contact that is always alike, or that of who stands.
        bodies: that land.
    """

    def __init__(
        self, settings: FlightSettings, model: Model, axis: Array, target: float, key: str
    ) -> None:
        """For a turn about an axis (3,) of the trunk to a target [rad]; `key` has the settings.

        Raises:
            InputError: a joint or a body is not there, or an angle is none of its joint.
        """
        if settings.feet:
            make_pose(model, settings.feet.pose, f"{key}.feet.pose")
        self._model, self._axis, self._target = model, axis, target
        self.feet = Landing(settings.feet, model, f"{key}.feet") if settings.feet else None
        if settings.entry:
            self.usual = self._entry(settings.entry, f"{key}.entry")
        elif self.feet:
            self.usual = self.feet.at(0.0)
        landing = settings.entry or settings.feet
        assert landing  # as the settings ask for
        self.bodies = landing.bodies

    def _entry(self, entry: EntrySettings, key: str) -> Contact:
        """The body as it lands."""
        attitude, pose = radians(entry.attitude), make_pose(self._model, entry.pose, f"{key}.pose")
        data = self._landed(attitude, pose)
        low = self._lowest(data, body_ids(self._model.mj, entry.bodies, f"{key}.bodies"))
        return Contact(attitude, pose, 0.0, float(data.subtree_com[ROOT_BODY, 2]) - low)

    def _landed(self, attitude: float, pose: Array) -> mujoco.MjData:
        """The body at the target and past it by an attitude [rad], in a pose (nu,) [rad]."""
        mj, data = self._model.mj, mujoco.MjData(self._model.mj)
        data.qpos[3:7] = quaternion_from_rotation_vector((self._target + attitude) * self._axis)
        data.qpos[self._model.angles] = pose
        mujoco.mj_kinematics(mj, data)
        mujoco.mj_comPos(mj, data)
        return data

    def _lowest(self, data: mujoco.MjData, bodies: list[int]) -> float:
        """Lowest z of what is solid of these bodies [m]."""
        mj = self._model.mj
        chosen = np.isin(mj.geom_bodyid, bodies) & (mj.geom_contype > 0)
        return lowest_and_highest(mj, data, chosen)[0]

    def lands(self) -> bool:
        """Whether what is to land is lowest after the turn that is the target."""
        data, mj = self._landed(self.usual.attitude, self.usual.pose), self._model.mj
        own = np.flatnonzero(is_character(mj)).tolist()
        landing = body_ids(mj, self.bodies)
        return self._lowest(data, landing) <= self._lowest(data, own) + ROUNDING

    def contact(self, momentum: float, forward: float, up: float, over: float) -> Contact:
        """The body as it is to land.

        Args:
            momentum: about left [kg m2/s].
            forward, up: velocity of the centre of mass [m/s], and
            over: its height over the ground where it lands [m], at one and the same instant.
        """
        if self.feet is None:
            return self.usual
        fall = -float(self._model.gravity[2])
        height = self.usual.height
        down = sqrt(up * up + 2.0 * fall * max(over - height, 0.0))
        return self.feet.at(self.feet.offset(momentum, forward, down, height))

    def time(self, up: float, over: float, contact: Contact) -> float:
        """To the landing [s]: 2 v / g, [AlBorno2014], and more where it lands lower.

        Args:
            up: velocity of the centre of mass [m/s]; over: its height over the ground [m].
        """
        fall = -float(self._model.gravity[2])
        higher = max(over - contact.height, 0.0)
        return max((up + sqrt(up * up + 2.0 * fall * higher)) / fall, LEAST_TIME)

    def usual_time(self, up: float, over: float) -> float:
        """To a landing as usual [s]; see `time`."""
        return self.time(up, over, self.usual)
