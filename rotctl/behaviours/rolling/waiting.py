"""The pose of a roll that waits for its clock.

What leads a body that turns has, for one that stands still, come too far: it leans onto its hands
with its head down. Who waits has a pose of its own: a squat, hands at or near the ground, head up.
"""

from collections.abc import Mapping

import numpy as np

from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.motion import make_pose

KEY = "behaviour.pace.pose"


class Waiting:
    """What a roll's poses come to as it waits.

    Attributes:
        angles: (nu,) of the joints [rad]; NaN where the roll's own poses stay.
    """

    def __init__(self, angles: Mapping[str, float], model: Model) -> None:
        """Of a model, by the names of joints; one without a side is both.

        Raises:
            InputError: there is no such joint, or an angle is none of that joint.
        """
        wanted = make_pose(model, angles, KEY)
        self.angles = np.full(len(wanted), np.nan)
        for joint in angles:
            motors = model.bending(joint, KEY)
            self.angles[motors] = wanted[motors]
        self._own = np.isnan(self.angles)

    def settled(self, pose: Array, waits: float) -> Array:
        """A pose (nu,) of one that waits so much [-]: at 1 it is the waiting one's."""
        there = pose + waits * (self.angles - pose)
        return np.where(self._own, pose, there)
