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

from rotctl.behaviours.bearing import Bearing, Bearings
from rotctl.behaviours.behaviour import Placement, Signals, gains_of
from rotctl.behaviours.compiled_roll import CompiledRoll
from rotctl.behaviours.course import Course, CourseSettings, Going
from rotctl.behaviours.facing import UP
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
from rotctl.rotations import Array, about_up, advance, dot, rotate
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
        course: where it goes from its heading; straight on by default.
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
    course: CourseSettings | None = None
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
        if self.course and self.finish:
            raise ValueError("a roll along a course has no finish: it would stand up aslant")
        if self.course and self.angular_momentum is not None:
            raise ValueError("a course commands velocities: give no angular_momentum")

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
        angle: (3,) phi_0 [rad]; turns with the bearing.
        axis: (3,) the trunk's that should stay on the rolling axis, unit, world.
        bearing: how it lies to the world.
        clock: of its pace.
        course: where its way leads.
    """

    excursion: Excursion
    origin: Array
    angle: Array
    axis: Array
    bearing: Bearing
    clock: Clock = Clock(0.0)
    course: Course = Course()


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
        slope, aligned = model.ground.slope, settings.align_with_slope
        self._bearings = Bearings(settings.roll_about, settings.heading, slope, aligned)
        self._bearing = self._bearings.at(0.0)
        self.axes = axes = self._bearing.frame.axes
        self._course = settings.course.make() if settings.course is not None else None
        self._measured = measured
        self._period = 1.0 / control.rate
        self._rate, self._speed = 2.0 * math.pi * settings.angular_velocity, settings.speed
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
        for part in ("pace", "course"):
            if getattr(settings, part) and measured.measure == "root":
                raise InputError(
                    f"behaviour.{part}: excursion=root controls the root's angular velocity"
                )
        kinds = ("linear", "angular_momentum" if by_momentum else "spin")
        self._tasks = np.concatenate(
            [task(kind(k).number, gains[n], axes) for k, n in zip(kinds, self.tasks, strict=True)]
        )
        self._momentum = settings.angular_momentum
        self._targets = self._tasks["target"][:, :3]  # views: cheaper than fields, step by step
        self._velocities, self._axes = self._tasks["velocity"], self._tasks["axes"]
        self._velocities[:] = self._constant(self._bearing)
        self._damping, self._usual = self._tasks["damping"], self._tasks["damping"].copy()
        self._control, self._held_out = control, model.excluded

    def start(self, pitch: float) -> Placement:
        """How a run starts at a pitch [rad] of the pelvis against the slope."""
        on = self._bearing
        tilt = (pitch - on.slope) * on.left
        return Placement(advance(on.frame.orientation, tilt), self._poses.start(pitch))

    def begin(self, pitch: float, state: State) -> RollingMemory:
        """Memory at the start: phi_0 is the pelvis's pitch against the slope [rad]."""
        on, com = self._bearing, state.momentum.com
        line = com - dot(on.left, com) * on.left if self._course is None else com
        now = excursion.start(pitch, on.left)
        axis = on.frame.axis(state.trunk_axes)
        memory = RollingMemory(now, line, now.angle, axis, on)
        return memory._replace(clock=Clock(self._come(memory, state)))

    def _come(self, memory: RollingMemory, state: State) -> float:
        """How far it has come along what its pace keeps [rev]."""
        if not self._travel:
            return float(dot(memory.bearing.left, memory.excursion.angle)) / math.tau
        if self._course is not None:
            return memory.course.along / self._travel
        return float(dot(self.axes[0], state.momentum.com - memory.origin)) / self._travel

    def ahead(self, memory: RollingMemory, state: State) -> float:
        """How far the centre of mass is ahead of what its pace waits over [m]."""
        middle = state.data.xipos[self._over].mean(axis=0)
        return float(dot(memory.bearing.frame.axes[0], state.momentum.com - middle))

    def from_waiting(self, memory: RollingMemory) -> float:
        """How far it is before the phase in which its pace waits, at most half [rev]."""
        return self._pace.before(memory.excursion.phase) if self._pace else 0.0

    def advance(self, before: RollingMemory, state: State, goes: bool = True) -> RollingMemory:
        """Memory now, from that of the previous control step; `goes` on, or waits for good."""
        past, spin = before, state.momentum.angular_velocity
        if self._course is not None:
            past = self._turned(before, state)
            turn = past.course.turned - before.course.turned
            spin = spin - turn / self._period * UP  # that is left to who turns along
        on = past.bearing
        axis = on.frame.axis(state.trunk_axes)
        now = excursion.integrate(
            past.excursion, spin, axis, on.left, self._period, self._measured.correction_time
        )
        turned = on.frame.turned(state.trunk_axes) + on.slope
        now = excursion.keep_phase(now, turned, self._period, self._measured.phase_time)
        if self._measured.measure == "root":
            now = excursion.on_root(now, state.position[3:7], on.frame.orientation)
        memory = past._replace(excursion=now, axis=axis)
        if self._pace is None:
            return memory
        come = self._come(memory, state)
        clock = self._pace.tick(before.clock, come, state.time, self._period)
        return memory._replace(clock=clock if goes else Clock(come - SLIP, -SLIP))

    def _turned(self, before: RollingMemory, state: State) -> RollingMemory:
        """What it remembers, turned with its way."""
        assert self._course is not None
        momentum = state.momentum
        x, y = (float(dot(each, momentum.com - before.origin)) for each in self.axes[:2])
        speed = float(dot(before.bearing.frame.axes[0], momentum.com_velocity))
        going = Going(x, y, speed)
        course = self._course.follow(before.course, going, state.time, self._period)
        turn = about_up(course.turned - before.course.turned)
        return before._replace(
            excursion=excursion.turned(before.excursion, turn),
            angle=rotate(turn, before.angle),
            bearing=self._bearings.at(course.turned),
            course=course,
        )

    def command(self, memory: RollingMemory, state: State) -> Command:
        """What rolling wants at this instant."""
        now, measure, on = memory.excursion, self._measured.measure, memory.bearing
        pose_a, pose_b = self._poses.at(now.phase)
        velocity, spin = self._speed * on.way, self._rate * on.left
        self._velocities[:] = self._constant(on)
        if self._pace:
            ahead = self.ahead(memory, state)
            wanted = self._pace.at(now.phase, ahead, memory.clock.late, state.time)
            self._velocities[0] = wanted.speed * on.way
            self._velocities[1] = math.tau * wanted.rate * on.left
            self._damping[:] = self._usual
            self._damping[0, 0] *= wanted.brake
            self._damping[1, 1] *= wanted.brake
        self._targets[0] = memory.origin + state.time * velocity
        target = memory.angle + state.time * spin  # phi_hat
        self._targets[1] = excursion.error(now, target, on.left, measure)
        if measure == "root":  # AV that is off by as much as the root's velocity is
            aside = state.momentum.angular_velocity - state.root_angular_velocity
            self._velocities[1] = spin + aside
        if self._course is not None:
            self._axes[:] = on.frame.axes
            self._targets[0] = self._place(memory, state)
            self._velocities[1] += memory.course.rate * UP
        return Command(
            tasks=self._tasks,
            pose_a=pose_a,
            pose_b=pose_b,
            forward=on.frame.axes[0],
            pose=self._control.pose,
            contact=self._control.contact,
            supervisor=self._control.supervisor,
            thresholds=self._control.thresholds,
            held_out=self._held_out,
        )

    def _constant(self, on: Bearing) -> tuple[Array, Array]:
        """What is commanded of the centre of mass and about it, (3,) each, if nothing varies it."""
        turning = self._rate if self._momentum is None else self._momentum
        return self._speed * on.way, turning * on.left

    def signals(self, memory: RollingMemory, state: State) -> Signals:
        """What the log keeps of it.

        Forward, phase pi/2 is face down and pi on the upper back; backward, pi/2 is on the back.
        """
        now = memory.excursion
        axes = memory.bearing.frame.axes
        return Signals(angle=now.angle, phase=now.phase, axis=memory.axis, axes=axes)

    def _place(self, memory: RollingMemory, state: State) -> Array:
        """The nearest place (3,) of its way [m]; where it is, if that has none."""
        if memory.course.place is None:
            return state.momentum.com
        x, y = memory.course.place
        return memory.origin + x * self.axes[0] + y * self.axes[1]

    def compiled(self) -> CompiledRoll | None:
        """The same for C, which works on the same tasks; None where it has not what is asked.

        That is `root`, and a course.
        """
        if self._measured.measure == "root" or self._course is not None:
            return None
        on = self._bearing
        made = CompiledRoll(
            on.frame,
            self._measured,
            self._period,
            on.slope,
            (self._speed * on.way, self._rate * on.left),
            self._poses,
            self._tasks,
        )
        if self._pace:
            made.add_pace(self._pace, on.way, self._over, self._usual)
        return made


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
