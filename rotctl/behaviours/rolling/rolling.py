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
from typing import TYPE_CHECKING

import numpy as np

from rotctl.behaviours.behaviour import Placement, Signals, gains_of
from rotctl.behaviours.facing import UP
from rotctl.behaviours.rolling.alighting import Alighting
from rotctl.behaviours.rolling.bearing import Bearing, Bearings
from rotctl.behaviours.rolling.catching import Catch
from rotctl.behaviours.rolling.compiled import CompiledRoll
from rotctl.behaviours.rolling.pacing import Pace
from rotctl.behaviours.rolling.remembering import Remembering, RollingMemory
from rotctl.behaviours.rolling.waiting import Waiting
from rotctl.control import Command, ControllerSettings
from rotctl.control.kinds import kind
from rotctl.control.task import task
from rotctl.errors import InputError
from rotctl.maths.rotations import Array, advance, dot
from rotctl.mechanics import excursion
from rotctl.mechanics.bodies import body_ids
from rotctl.mechanics.excursion import ExcursionSettings
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State
from rotctl.motion import over_phase

if TYPE_CHECKING:  # which makes this one
    from rotctl.behaviours.rolling.settings import RollingSettings


class Rolling:
    """The rolling behaviour, of one run at a time."""

    def __init__(
        self,
        settings: "RollingSettings",
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
        bearings = Bearings(settings.roll_about, settings.heading, slope, aligned)
        self._bearing = bearings.at(0.0)
        self.axes = axes = self._bearing.frame.axes
        self._measured, self._follows = measured, settings.course is not None
        self._period, self._oblique = 1.0 / control.rate, settings.oblique
        self._lift = settings.lift
        self._rate, self._speed = 2.0 * math.pi * settings.angular_velocity, settings.speed
        given = settings.pace
        self._pace = (
            Pace(given, settings.angular_velocity, settings.speed) if given is not None else None
        )
        if self._pace:
            self._pace.check(-float(model.gravity[2]))
        self._remembering = Remembering(settings, bearings, self._pace, measured, self._period)
        self._over = body_ids(model.mj, list(given.over), "behaviour.pace.over") if given else []
        self._poses = settings.make_poses(model)
        self._waiting = Waiting(given.pose, model) if given is not None and given.pose else None
        about, catch = settings.roll_about, settings.catch
        self._catch = Catch(catch, model, about) if catch is not None else None
        alights = settings.alighting
        self._alighting = Alighting(alights, model) if alights is not None else None
        gains = gains_of(control, self.tasks)
        by_momentum = settings.angular_momentum is not None
        if by_momentum and measured.measure == "root":
            raise InputError(
                "behaviour.angular_momentum: excursion=root controls the root's angular velocity"
            )
        for part in ("pace", "course", "oblique"):
            if getattr(settings, part) and measured.measure == "root":
                raise InputError(
                    f"behaviour.{part}: excursion=root controls the root's angular velocity"
                )
        if settings.pace and measured.measure == "clock":
            raise InputError(
                "behaviour.pace: waits at a phase of the body, excursion=clock goes by time"
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
        return self._remembering.begin(pitch, state)

    def ahead(self, memory: RollingMemory, state: State) -> float:
        """How far the centre of mass is ahead of what its pace waits over [m]."""
        middle = state.data.xipos[self._over].mean(axis=0)
        return float(dot(memory.bearing.frame.axes[0], state.momentum.com - middle))

    def from_waiting(self, memory: RollingMemory) -> float:
        """How far it is before the phase in which its pace waits, at most half [rev]."""
        return self._pace.before(memory.excursion.phase) if self._pace else 0.0

    def advance(self, before: RollingMemory, state: State, goes: bool = True) -> RollingMemory:
        """Memory now, from that of the previous control step; `goes` on, or waits for good."""
        return self._remembering.advance(before, state, goes)

    def command(self, memory: RollingMemory, state: State) -> Command:
        """What rolling wants at this instant."""
        now, measure, on = memory.excursion, self._measured.measure, memory.bearing
        phase, waits = now.phase, 0.0
        velocity, spin = self._speed * on.way, self._rate * on.left
        self._velocities[:] = self._constant(on)
        if self._pace:
            ahead = self.ahead(memory, state)
            speed = float(dot(on.frame.axes[0], state.momentum.com_velocity))
            rate = float(dot(on.frame.axes[1], state.momentum.angular_velocity)) / math.tau
            wanted = self._pace.at(now.phase, ahead, memory.clock.late, state.time, speed, rate)
            self._velocities[0] = wanted.speed * on.way
            self._velocities[1] = math.tau * wanted.rate * on.left
            self._damping[:] = self._usual
            self._damping[0, 0] *= wanted.brake
            self._damping[1, 1] *= wanted.brake
            phase -= math.tau * wanted.back
            waits = wanted.waits
        if self._lift is not None:
            turning = float(dot(on.frame.axes[1], state.momentum.angular_velocity)) / math.tau
            # upwards alone, as in C: what is 0 keeps its sign
            self._velocities[0, 2] += turning * over_phase(self._lift, now.phase)
        pose_a, pose_b = self._poses.at(phase)
        if self._waiting is not None:
            settled = self._waiting.settled
            pose_a, pose_b = settled(pose_a, waits), settled(pose_b, waits)
        if self._catch is not None:
            rise = self._catch.rise(memory.axis, state.momentum.angular_velocity)
            pose_a, pose_b = self._catch.spread(pose_a, rise), self._catch.spread(pose_b, rise)
        if self._alighting is not None:
            turns = self._alighting.turns(state, memory.axis, on.left)
            pose_a, pose_b = (self._alighting.moved(pose, turns) for pose in (pose_a, pose_b))
        self._targets[0] = memory.origin + state.time * velocity
        target = memory.angle + state.time * spin  # phi_hat
        self._targets[1] = excursion.error(now, target, on.left, measure)
        if measure == "root":  # AV that is off by as much as the root's velocity is
            aside = state.momentum.angular_velocity - state.root_angular_velocity
            self._velocities[1] = spin + aside
        if self._follows:
            self._axes[:] = on.frame.axes
            self._targets[0] = self._remembering.place(memory, state)
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

    def compiled(self) -> CompiledRoll | None:
        """The same for C, which works on the same tasks; None where it has not what is asked.

        That is `root`, `clock`, and a course.
        """
        if self._measured.measure in ("root", "clock") or self._follows:
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
        if self._oblique is not None:
            made.add_oblique(self._oblique)
        if self._lift is not None:
            made.add_lift(self._lift)
        if self._catch is not None:
            made.add_catch(self._catch)
        if self._alighting is not None:
            made.add_alighting(self._alighting)
        if self._pace:
            made.add_pace(self._pace, on.way, self._over, self._usual)
        if self._waiting is not None:
            made.add_waiting(self._waiting)
        return made
