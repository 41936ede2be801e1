"""Continuous rolling, [Brown2013] section 6.

A character rolls to +x, about +y. Which of the trunk's axes it keeps there makes the roll:
`left` a forward roll, `right` a backward roll (facing -x), `head` a log roll (lying across).

In-plane (about the rolling axis y, along the rolling direction x) the angular velocity and
the speed are held constant and their integrals are left free; out of plane, AE and AV are
held at zero and the lateral and vertical velocities are damped. All of that is gains: a
zero in-plane stiffness leaves the excursion and the distance free. The in-plane excursion
that is wanted runs ahead at the commanded rate all the same; with a stiffness it is tracked,
which the paper shows to fail. ROOT control, which fails too, compares the root's orientation
and angular velocity with what is wanted of the whole body's.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import Strict
from pydantic.dataclasses import dataclass as validated

from rotctl.control import ControllerSettings, Desired
from rotctl.errors import InputError
from rotctl.linear import product
from rotctl.mechanics import excursion
from rotctl.mechanics.excursion import Excursion
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State
from rotctl.motion import (
    Angle,
    PosePair,
    ReferencePair,
    ReferenceSettings,
    RollAbout,
    load_clip,
    make_pose_pair,
    make_reference_pair,
)
from rotctl.rotations import Array, cross, dot, rotate
from rotctl.settings import STRICT, Finite

ROLLING_AXIS = np.array([0.0, 1.0, 0.0])
ALONG = np.array([1.0, 0.0, 1.0])  # free along the way and up; the line of travel is y = 0


@dataclass(frozen=True)
class Facing:
    """How a trunk lies on the rolling axis.

    Attributes:
        trunk_axis: (3,) what it rolls about, unit, in the trunk's frame of front, left, up.
        orientation: (4,) of the trunk at phase 0, unit quaternion: takes that axis to +y.
    """

    trunk_axis: Array
    orientation: Array


FACING: dict[RollAbout, Facing] = {
    "left": Facing(np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0, 0.0])),
    "right": Facing(np.array([0.0, -1.0, 0.0]), np.array([0.0, 0.0, 0.0, 1.0])),
    "head": Facing(np.array([0.0, 0.0, 1.0]), np.array([0.5, -0.5, -0.5, -0.5])),
}


@validated(frozen=True, config=STRICT)
class Poses:
    """Key poses r_a and r_b by joint name, see `rotctl.motion.pose_pair`."""

    a: dict[str, Angle]
    b: dict[str, Angle]


@validated(frozen=True, config=STRICT)
class RollingSettings:
    """What Table 1 varies, and the poses: two key poses, or a reference motion.

    Attributes:
        angular_velocity: commanded in-plane angular velocity [rev/s]; negative is backward.
        speed: commanded in-plane speed of the centre of mass [m/s].
        roll_about: the trunk's axis that is kept on the rolling axis, see `FACING`.
        align_with_slope: whether that speed is along the slope (section 6) or level.
    """

    name: str
    kind: Literal["rolling"]
    roll_about: RollAbout
    angular_velocity: Finite
    speed: Finite
    align_with_slope: Annotated[bool, Strict()]
    poses: Poses | None = None
    reference: ReferenceSettings | None = None
    source: str = ""
    description: str = ""

    def __post_init__(self) -> None:
        if (self.poses is None) == (self.reference is None):
            raise ValueError("give either poses or a reference, not both and not neither")


class Rolling:
    """The rolling behaviour of one run.

    Attributes:
        orientation: (4,) of the trunk at phase 0 on level ground, unit quaternion.
    """

    def __init__(
        self,
        settings: RollingSettings,
        model: Model,
        control: ControllerSettings,
    ) -> None:
        """Prepare the poses.

        Args:
            control: how AE and the phase are measured, and how often.
        """
        facing = FACING[settings.roll_about]
        self.orientation = facing.orientation
        self._trunk_axis = facing.trunk_axis
        self._name = control.excursion
        self._correction_time = control.correction_time
        self._phase_time = control.phase_time
        self._period = 1.0 / control.rate
        self._angular_velocity = 2.0 * math.pi * settings.angular_velocity * ROLLING_AXIS
        self._slope = model.ground.slope
        self._front = rotate(facing.orientation, np.array([1.0, 0.0, 0.0]))
        along = self._slope if settings.align_with_slope else 0.0
        self._velocity = settings.speed * np.array([np.cos(along), 0.0, np.sin(along)])
        self._poses = _poses(settings, model)

    def pose(self, phase: float) -> Array:
        """The pose (nu,) [rad] a run starts in at that phase."""
        return self._poses.start(phase)  # the start's pitch is relative to the slope

    def begin(self, phase: float) -> Excursion:
        """Excursion at the start: phi_0 is the pelvis's pitch against the slope."""
        return excursion.start(phase, ROLLING_AXIS)

    def trunk_axis(self, state: State) -> Array:
        """The trunk's axis (3,) that should stay on the rolling axis, unit, world."""
        return product(state.trunk_axes, self._trunk_axis)

    def advance(self, before: Excursion, state: State) -> Excursion:
        """Excursion now, from that of the previous control step."""
        now = excursion.integrate(
            before,
            state.momentum.angular_velocity,
            self.trunk_axis(state),
            ROLLING_AXIS,
            self._period,
            self._correction_time,
        )
        now = excursion.keep_phase(now, self._turned(state), self._period, self._phase_time)
        if self._name == "root":
            return excursion.on_root(now, state.position[3:7], self.orientation)
        return now

    def phase(self, now: Excursion) -> float:
        """Phase theta [rad], turned from upright, or from lying on the back in a log roll.

        Forward, pi/2 is face down and pi on the upper back; backward, pi/2 is on the back.
        """
        return now.phase

    def _turned(self, state: State) -> float:
        """How far the trunk's front has turned from phase 0 [rad], within a revolution."""
        front = state.trunk_axes[:, 0]
        across = dot(ROLLING_AXIS, cross(self._front, front))
        return math.atan2(across, dot(self._front, front)) + self._slope

    def desired(self, state: State, now: Excursion) -> Desired:
        """What rolling wants at this instant."""
        pose_a, pose_b = self._poses.at(self.phase(now))
        target = self._angular_velocity * state.time  # phi_hat
        velocity = self._angular_velocity
        if self._name == "root":  # AV that is off by as much as the root's velocity is
            velocity = velocity + state.momentum.angular_velocity - state.root_angular_velocity
        return Desired(
            com=ALONG * state.momentum.com,
            com_velocity=self._velocity,
            excursion_error=excursion.error(now, target, ROLLING_AXIS, self._name),
            angular_velocity=velocity,
            pose_a=pose_a,
            pose_b=pose_b,
        )


def _poses(settings: RollingSettings, model: Model) -> PosePair | ReferencePair:
    if settings.poses:
        return make_pose_pair(model, settings.poses.a, settings.poses.b)
    assert settings.reference  # __post_init__
    reference = settings.reference
    clip = load_clip(reference.clip)
    if clip.roll_about != settings.roll_about:
        raise InputError(
            f"behaviour.reference.clip={reference.clip}: rolls about {clip.roll_about}, "
            f"but behaviour.roll_about={settings.roll_about}"
        )
    return make_reference_pair(model, clip, reference)
