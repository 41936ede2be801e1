"""Continuous rolling, [Brown2013] section 6.

A character rolls along its heading, about the axis to its left. Which of the trunk's axes it keeps
there makes the roll: `left` a forward roll, `right` a backward roll (its back to the way), `head` a
log roll (lying across).

In-plane (about the rolling axis, along the way) the angular velocity and the speed are held
constant and their integrals are left free; out of plane, AE and AV are held at zero and the
lateral and vertical velocities are damped. All of that is gains, along forward, left and up: a
zero stiffness of `linear` along the way leaves the distance free, one of `spin` about the
rolling axis the excursion. What is wanted runs ahead at the commanded rates all the same; with a
stiffness it is tracked, which the paper shows to fail. ROOT control, which fails too, compares
the root's orientation and angular velocity with what is wanted of the whole body's.
"""

import math
from typing import Annotated, Literal, NamedTuple

import numpy as np
from pydantic import Strict
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.behaviour import Placement, Signals, gains_of
from rotctl.behaviours.compiled_roll import CompiledRoll
from rotctl.behaviours.facing import UP, frame_of
from rotctl.behaviours.finishing import Finishing, FinishSettings
from rotctl.behaviours.pacing import SLIP, Clock, Pace, PaceSettings
from rotctl.control import Command, ControllerSettings
from rotctl.control.kinds import kind
from rotctl.control.task import task
from rotctl.errors import InputError
from rotctl.mechanics import excursion
from rotctl.mechanics.excursion import Excursion, ExcursionSettings
from rotctl.mechanics.model import Model, body_ids
from rotctl.mechanics.state import State
from rotctl.motion import (
    PosePair,
    Poses,
    ReferencePair,
    ReferenceSettings,
    RollAbout,
    load_clip,
    make_pose_pair,
    make_reference_pair,
)
from rotctl.rotations import Array, advance, dot
from rotctl.settings import STRICT, Finite


@validated(frozen=True, config=STRICT)
class RollingSettings:
    """What Table 1 varies, and the poses: two key poses, or a reference motion.

    Attributes:
        angular_velocity: commanded in-plane angular velocity [rev/s]; negative is backward.
        speed: commanded in-plane speed of the centre of mass [m/s].
        roll_about: the trunk's axis that is kept on the rolling axis, see `FACING`.
        heading: of the way it rolls, from +x towards +y [deg].
        angular_momentum: commanded in-plane in place of the angular velocity [kg m2/s]; AV by
            default, section 7.
        align_with_slope: whether that speed is along the slope (section 6) or level.
        pace: how one of the two is kept, whatever the body makes of the pair; none is by default.
        finish: how a roll with a pace ends.
    """

    name: str
    kind: Literal["rolling"]
    roll_about: RollAbout
    angular_velocity: Finite
    speed: Finite
    heading: Finite
    align_with_slope: Annotated[bool, Strict()]
    poses: Poses | None = None
    reference: ReferenceSettings | None = None
    angular_momentum: Finite | None = None
    pace: PaceSettings | None = None
    finish: FinishSettings | None = None
    source: str = ""
    description: str = ""

    def __post_init__(self) -> None:
        if (self.poses is None) == (self.reference is None):
            raise ValueError("give either poses or a reference, not both and not neither")
        if self.pace:
            if min(self.angular_velocity, self.speed) < 0.0:
                raise ValueError(
                    "a pace is kept forward: give angular_velocity and speed from 0 on"
                )
            if self.angular_momentum is not None:
                raise ValueError("a pace commands velocities: give no angular_momentum")
        if self.finish:
            if self.pace is None:
                raise ValueError("a roll without a pace does not wait, so that it has no finish")
            self.finish.staged(self.roll_about, self.heading)

    @property
    def commanded(self) -> dict[str, float]:
        """What is asked for, as columns of the summary [rev/s, m/s, s].

        A pace keeps one of the two velocities, so that the other has no column. That of one that
        a schedule changes is NaN: no number is commanded throughout.
        """
        asked = {
            "angular_velocity_commanded": self.angular_velocity,
            "speed_commanded": self.speed,
        }
        if self.pace:
            rate, speed = asked
            kept = rate if self.pace.keep == "rate" else speed
            asked = {kept: math.nan if self.pace.schedule else asked[kept]}
        return asked if self.finish is None else asked | {"finish_commanded": self.finish.after}

    def make(
        self, model: Model, control: ControllerSettings, measured: ExcursionSettings
    ) -> "Rolling | Finishing":
        """The behaviour of one run."""
        roll = Rolling(self, model, control, measured)
        if self.finish is None:
            return roll
        staged = self.finish.staged(self.roll_about, self.heading)
        return Finishing(self.finish, roll, staged, model, control, measured)


class RollingMemory(NamedTuple):
    """What a roll remembers from one control step to the next.

    Attributes:
        excursion: AE and phase.
        origin: (3,) where the line of travel began [m].
        angle: (3,) phi_0 [rad].
        axis: (3,) the trunk's that should stay on the rolling axis, unit, world.
    """

    excursion: Excursion
    origin: Array
    angle: Array
    axis: Array
    clock: Clock = Clock(0.0)


class Rolling:
    """The rolling behaviour of one run."""

    def __init__(
        self,
        settings: RollingSettings,
        model: Model,
        control: ControllerSettings,
        measured: ExcursionSettings,
    ) -> None:
        """Prepare the poses and the part of the command that stays.

        Args:
            control: gains, by the names of the tasks.
            measured: how AE and the phase are measured.

        Raises:
            InputError: parts that do not fit together.
        """
        self.tasks = ("linear", "spin")
        self._frame = frame = frame_of(settings.roll_about, settings.heading)
        self.axes = axes = frame.axes
        self._left = axes[1]
        self._measured = measured
        self._period = 1.0 / control.rate
        self._angular_velocity = 2.0 * math.pi * settings.angular_velocity * self._left
        self._slope = math.atan(math.tan(model.ground.slope) * axes[0, 0])  # along the way
        along = self._slope if settings.align_with_slope else 0.0
        self._way = math.cos(along) * axes[0] + math.sin(along) * UP
        self._velocity = settings.speed * self._way
        given = settings.pace
        self._pace = (
            Pace(given, settings.angular_velocity, settings.speed) if given is not None else None
        )
        self._over = body_ids(model.mj, list(given.over), "behaviour.pace.over") if given else []
        self._travel = given.travel if given is not None and given.keep == "speed" else 0.0
        self._poses = _poses(settings, model)
        gains = gains_of(control, self.tasks)
        by_momentum = settings.angular_momentum is not None
        if by_momentum and measured.measure == "root":
            raise InputError(
                "behaviour.angular_momentum: excursion=root controls the root's angular velocity"
            )
        if self._pace and measured.measure == "root":
            raise InputError("behaviour.pace: excursion=root controls the root's angular velocity")
        kinds = ("linear", "angular_momentum" if by_momentum else "spin")
        self._tasks = np.concatenate(
            [task(kind(k).number, gains[n], axes) for k, n in zip(kinds, self.tasks, strict=True)]
        )
        rotation = (settings.angular_momentum or 0.0) * self._left
        self._tasks["velocity"] = (
            self._velocity,
            rotation if by_momentum else self._angular_velocity,
        )
        self._targets = self._tasks["target"][:, :3]  # views: cheaper than fields, step by step
        self._velocities = self._tasks["velocity"]
        self._damping, self._usual = self._tasks["damping"], self._tasks["damping"].copy()
        self._control, self._held_out = control, model.excluded

    def start(self, pitch: float) -> Placement:
        """How a run starts at a pitch [rad] of the pelvis against the slope."""
        tilt = (pitch - self._slope) * self._left
        return Placement(advance(self._frame.orientation, tilt), self._poses.start(pitch))

    def begin(self, pitch: float, state: State) -> RollingMemory:
        """Memory at the start: phi_0 is the pelvis's pitch against the slope [rad]."""
        line = state.momentum.com - dot(self._left, state.momentum.com) * self._left
        now = excursion.start(pitch, self._left)
        return RollingMemory(
            now, line, now.angle, self._axis(state), Clock(self._come(now, state, line))
        )

    def _come(self, now: Excursion, state: State, origin: Array) -> float:
        """How far it has come along what its pace keeps [rev]."""
        if self._travel:
            along = state.momentum.com - origin
            return float(dot(self.axes[0], along)) / self._travel
        return float(dot(self._left, now.angle)) / math.tau

    def ahead(self, state: State) -> float:
        """How far the centre of mass is ahead of what its pace waits over [m]."""
        middle = state.data.xipos[self._over].mean(axis=0)
        return float(dot(self.axes[0], state.momentum.com - middle))

    def from_waiting(self, memory: RollingMemory) -> float:
        """How far it is before the phase in which its pace waits, at most half [rev]."""
        return self._pace.before(memory.excursion.phase) if self._pace else 0.0

    def advance(self, before: RollingMemory, state: State, goes: bool = True) -> RollingMemory:
        """Memory now, from that of the previous control step; `goes` on, or waits for good."""
        axis = self._axis(state)
        now = excursion.integrate(
            before.excursion,
            state.momentum.angular_velocity,
            axis,
            self._left,
            self._period,
            self._measured.correction_time,
        )
        turned = self._frame.turned(state.trunk_axes) + self._slope
        now = excursion.keep_phase(now, turned, self._period, self._measured.phase_time)
        if self._measured.measure == "root":
            now = excursion.on_root(now, state.position[3:7], self._frame.orientation)
        clock = before.clock
        if self._pace:
            come = self._come(now, state, before.origin)
            clock = self._pace.tick(clock, come, state.time, self._period)
            if not goes:
                clock = Clock(come - SLIP, -SLIP)
        return RollingMemory(now, before.origin, before.angle, axis, clock)

    def command(self, memory: RollingMemory, state: State) -> Command:
        """What rolling wants at this instant."""
        now, measure = memory.excursion, self._measured.measure
        pose_a, pose_b = self._poses.at(now.phase)
        if self._pace:
            wanted = self._pace.at(now.phase, self.ahead(state), memory.clock.late, state.time)
            self._velocities[0] = wanted.speed * self._way
            self._velocities[1] = math.tau * wanted.rate * self._left
            self._damping[:] = self._usual
            self._damping[0, 0] *= wanted.brake
            self._damping[1, 1] *= wanted.brake
        self._targets[0] = memory.origin + state.time * self._velocity
        target = memory.angle + state.time * self._angular_velocity  # phi_hat
        self._targets[1] = excursion.error(now, target, self._left, measure)
        if measure == "root":  # AV that is off by as much as the root's velocity is
            aside = state.momentum.angular_velocity - state.root_angular_velocity
            self._velocities[1] = self._angular_velocity + aside
        return Command(
            tasks=self._tasks,
            pose_a=pose_a,
            pose_b=pose_b,
            forward=self.axes[0],
            pose=self._control.pose,
            contact=self._control.contact,
            supervisor=self._control.supervisor,
            thresholds=self._control.thresholds,
            held_out=self._held_out,
        )

    def signals(self, memory: RollingMemory, state: State) -> Signals:
        """What the log keeps of it.

        Forward, phase pi/2 is face down and pi on the upper back; backward, pi/2 is on the back.
        """
        now = memory.excursion
        return Signals(angle=now.angle, phase=now.phase, axis=memory.axis, axes=self.axes)

    def compiled(self) -> CompiledRoll | None:
        """The same for C, which works on the same tasks; None under `root`, which it has not."""
        if self._measured.measure == "root":
            return None
        made = CompiledRoll(
            self._frame,
            self._measured,
            self._period,
            self._slope,
            (self._velocity, self._angular_velocity),
            self._poses,
            self._tasks,
        )
        if self._pace:
            made.add_pace(self._pace, self._way, self._over, self._usual)
        return made

    def _axis(self, state: State) -> Array:
        """The trunk's axis (3,) that should stay on the rolling axis, unit, world."""
        return self._frame.axis(state.trunk_axes)


def _poses(settings: RollingSettings, model: Model) -> PosePair | ReferencePair:
    if settings.poses:
        return make_pose_pair(model, settings.poses)
    assert settings.reference  # __post_init__
    reference = settings.reference
    clip = load_clip(reference.clip)
    if clip.roll_about != settings.roll_about:
        raise InputError(
            f"behaviour.reference.clip={reference.clip}: rolls about {clip.roll_about}, "
            f"but behaviour.roll_about={settings.roll_about}"
        )
    if reference.found_for not in ("", clip.name):
        raise InputError(
            f"behaviour.reference.clip={reference.clip}: is {clip.name}, and window, lead and "
            f"offsets were found for {reference.found_for}; give the path of that clip, or "
            "behaviour.reference.found_for='' to bend another by them"
        )
    return make_reference_pair(model, clip, reference)
