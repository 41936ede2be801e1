"""A roll that tips over its side catches itself with the limbs on that side.

Who waits over hands and feet stands on a narrow base; what tips there lies on its side 0.7 s later,
and no gain of the balance brings it back. An arm further out on the low side widens the base just
there, a leg that pulls in turns the pelvis up over its foot, and upright nothing changes. The side
is told by the rolling axis: that end sinks, or is about to.
"""

from typing import Annotated

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.bodies import SIDES
from rotctl.mechanics.model import Model
from rotctl.motion import RollAbout, Turn
from rotctl.settings.fields import STRICT, NonNegative, Positive


@validated(frozen=True, config=STRICT)
class CatchSettings:
    """How far limbs go out on the side to which the roll tips.

    Attributes:
        out: how far each joint goes at most, by its name without a side; positive is outwards on
            either [rad].
        gain: share of that for the sine of the rolling axis's tilt [-].
        free: sine up to which they stay [-].
        lead: for how long ahead the tilt is reckoned, by how it changes [s].
    """

    out: Annotated[dict[str, Turn], Field(min_length=1)]
    gain: Positive
    free: Annotated[NonNegative, Field(lt=1)]
    lead: NonNegative = 0.0


class Catch:
    """The catching of one run.

    Attributes:
        settings: of it.
        motors: (2, joints) of the limbs at the end of the rolling axis that is to the left of the
            way, and at the other one.
        out: (joints,) how far they go at most [rad].
        low, high: (nu,) ends of all joints [rad].
    """

    def __init__(self, settings: CatchSettings, model: Model, about: RollAbout) -> None:
        """For a roll about the trunk's left or right.

        Raises:
            InputError: there is no such joint, or not on both sides.
        """
        self.settings = settings
        known = {name: motor for motor, name in enumerate(model.joint_names)}
        limbs = [name[: -len(SIDES[0])] for name in known if name.endswith(SIDES)]
        both = {limb for limb in limbs if {limb + side for side in SIDES} <= known.keys()}
        for joint in settings.out:
            if model.motors(joint, f"behaviour.catch.out.{joint}") and joint not in both:
                where = "one side alone" if joint in limbs else "no limb on either side"
                raise InputError(
                    f"behaviour.catch.out.{joint} is of {where}; "
                    f"valid joints: {', '.join(sorted(both))}"
                )
        sides = SIDES if about == "left" else SIDES[::-1]
        self.motors = [[known.get(joint + side, -1) for joint in settings.out] for side in sides]
        self.out = list(settings.out.values())
        self.low, self.high = np.ascontiguousarray(model.joint_range.T)

    def share(self, sine: float) -> float:
        """Of how far the limbs go, by the sine with which their end sinks [-]."""
        s = self.settings
        return min(max(s.gain * (sine - s.free), 0.0), 1.0)

    def rise(self, axis: Array, turning: Array) -> float:
        """Of the left end of a unit along the rolling axis, soon [-].

        Args:
            axis: (3,) that unit.
            turning: (3,) angular velocity [rad/s].
        """
        rate = turning[0] * axis[1] - turning[1] * axis[0]
        return float(axis[2] + self.settings.lead * rate)

    def spread(self, pose: Array, rise: float) -> Array:
        """A pose (nu,) with the limbs moved that are on the low side, within their joints' ranges.

        Args:
            rise: of the rolling axis's left end, which is the higher one where it is positive [-].
        """
        spread = pose.copy()
        for motors, sine in zip(self.motors, (-rise, rise), strict=True):
            share = self.share(sine)
            for motor, out in zip(motors, self.out, strict=True):
                if motor < 0:
                    continue
                angle, ends = pose[motor], (self.low[motor], self.high[motor])
                low, high = min(ends[0], angle), max(ends[1], angle)
                spread[motor] = min(max(angle + share * out, low), high)
        return spread
