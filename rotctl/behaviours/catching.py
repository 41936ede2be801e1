"""A roll that tips over its side catches itself: the arm on that side goes out.

Who waits over hands and feet stands on a narrow base; what tips there lies on its side 0.7 s later,
and no gain of the balance brings it back. An arm further out on the low side widens the base just
there, and upright it changes nothing. The side is told by the rolling axis: that end sinks.
"""

from typing import Annotated

from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.mechanics.bodies import SIDES
from rotctl.mechanics.model import Model
from rotctl.motion import RollAbout
from rotctl.rotations import Array
from rotctl.settings import STRICT, NonNegative, Positive


@validated(frozen=True, config=STRICT)
class CatchSettings:
    """How far a limb goes out on the side to which the roll tips.

    Attributes:
        joint: without its side; a positive angle is outwards on either.
        gain: for the sine of the rolling axis's tilt [rad].
        free: sine up to which it stays [-].
        most: that it goes out [rad].
    """

    joint: str
    gain: Positive
    free: Annotated[NonNegative, Field(lt=1)]
    most: Positive


class Catch:
    """The catching of one run.

    Attributes:
        settings: of it.
        motors: of the limbs at the end of the rolling axis that is to the left of the way, and at
            the other one; -1 where the body has none.
        high: their joints' upper ends [rad].
    """

    def __init__(self, settings: CatchSettings, model: Model, about: RollAbout) -> None:
        """For a roll about the trunk's left or right.

        Raises:
            InputError: there is no such joint.
        """
        self.settings = settings
        model.motors(settings.joint, "behaviour.catch.joint")
        sides = SIDES if about == "left" else SIDES[::-1]
        names = [settings.joint + side for side in sides]
        known = list(model.joint_names)
        self.motors = [known.index(name) if name in known else -1 for name in names]
        self.high = [float(model.joint_range[motor, 1]) for motor in self.motors]

    def out(self, sine: float) -> float:
        """How far a limb goes out [rad], by the sine with which its end has sunk."""
        s = self.settings
        return min(max(s.gain * (sine - s.free), 0.0), s.most)

    def spread(self, pose: Array, rise: float) -> Array:
        """A pose (nu,) with the limb out that is on the low side, within its joint's range.

        Args:
            rise: of a unit along the rolling axis, whose left end is the higher one where it is
                positive [-].
        """
        spread = pose.copy()
        for motor, high, sine in zip(self.motors, self.high, (-rise, rise), strict=True):
            if motor >= 0:
                spread[motor] = min(pose[motor] + self.out(sine), max(high, pose[motor]))
        return spread
