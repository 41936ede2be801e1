"""What a roll remembers from one control step to the next, and how that goes on.

AE and the phase are integrals of the whole body's angular velocity; with a course they turn along
with the way, and a pace has a clock of how far the roll is behind.
"""

import math
from typing import TYPE_CHECKING, NamedTuple

from rotctl.behaviours.facing import UP
from rotctl.behaviours.rolling import obliqueness
from rotctl.behaviours.rolling.bearing import Bearing, Bearings
from rotctl.behaviours.rolling.course import Course, Going
from rotctl.behaviours.rolling.pace_settings import SLIP
from rotctl.behaviours.rolling.pacing import Clock, Pace
from rotctl.maths.rotations import Array, about_up, dot, rotate
from rotctl.mechanics import excursion
from rotctl.mechanics.excursion import Excursion, ExcursionSettings
from rotctl.mechanics.state import State

if TYPE_CHECKING:  # which makes the roll that this is a part of
    from rotctl.behaviours.rolling.settings import RollingSettings


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


class Remembering:
    """What one roll remembers, over the control steps of its run."""

    def __init__(
        self,
        settings: "RollingSettings",
        bearings: Bearings,
        pace: Pace | None,
        measured: ExcursionSettings,
        period: float,
    ) -> None:
        """At the start of a run.

        Args:
            measured: how AE and the phase are measured.
            period: of control [s].
        """
        self._bearings, self._bearing = bearings, bearings.at(0.0)
        self._axes = self._bearing.frame.axes
        self._course = settings.course.make() if settings.course is not None else None
        self._measured, self._period, self._pace = measured, period, pace
        self._oblique = settings.oblique
        self._rate = math.tau * settings.angular_velocity
        given = settings.pace
        self._travel = given.travel if given is not None and given.keep == "speed" else 0.0

    def begin(self, pitch: float, state: State) -> RollingMemory:
        """Memory at the start: phi_0 is the pelvis's pitch against the slope [rad]."""
        on, com = self._bearing, state.momentum.com
        aside = dot(on.left, com - state.position[:3])  # of the pelvis, through which its line goes
        line = com - aside * on.left if self._course is None else com
        now = excursion.start(pitch, on.left)
        axis = self._axis(on, state, pitch)
        memory = RollingMemory(now, line, now.angle, axis, on)
        return memory._replace(clock=Clock(self._come(memory, state)))

    def advance(self, before: RollingMemory, state: State, goes: bool = True) -> RollingMemory:
        """Memory now, from that of the previous control step; `goes` on, or waits for good."""
        past, spin = before, state.momentum.angular_velocity
        if self._course is not None:
            past = self._turned(before, state)
            turn = past.course.turned - before.course.turned
            spin = spin - turn / self._period * UP  # that is left to who turns along
        on = past.bearing
        axis = self._axis(on, state, past.excursion.phase)
        now = excursion.integrate(
            past.excursion, spin, axis, on.left, self._period, self._measured.correction_time
        )
        turned = on.frame.turned(state.trunk_axes) + on.slope
        now = excursion.keep_phase(now, turned, self._period, self._measured.phase_time)
        if self._measured.measure == "clock":
            now = now._replace(phase=past.excursion.phase + self._rate * self._period)
        if self._measured.measure == "root":
            now = excursion.on_root(now, state.position[3:7], on.frame.orientation)
        memory = past._replace(excursion=now, axis=axis)
        if self._pace is None:
            return memory
        come = self._come(memory, state)
        clock = self._pace.tick(before.clock, come, state.time, self._period)
        return memory._replace(clock=clock if goes else Clock(come - SLIP, -SLIP))

    def place(self, memory: RollingMemory, state: State) -> Array:
        """The nearest place (3,) of its way [m]; where it is, if that has none."""
        if memory.course.place is None:
            return state.momentum.com
        x, y = memory.course.place
        return memory.origin + x * self._axes[0] + y * self._axes[1]

    def _axis(self, on: Bearing, state: State, phase: float) -> Array:
        """The trunk's axis (3,) that should stay on the rolling axis, unit, world."""
        trunk = state.trunk_axes
        return obliqueness.axis(on.frame.axis(trunk), trunk[:, 2], self._oblique, phase)

    def _turned(self, before: RollingMemory, state: State) -> RollingMemory:
        """What it remembers, turned with its way."""
        assert self._course is not None
        momentum = state.momentum
        x, y = (float(dot(each, momentum.com - before.origin)) for each in self._axes[:2])
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

    def _come(self, memory: RollingMemory, state: State) -> float:
        """How far it has come along what its pace keeps [rev]."""
        if not self._travel:
            return float(dot(memory.bearing.left, memory.excursion.angle)) / math.tau
        if self._course is not None:
            return memory.course.along / self._travel
        return float(dot(self._axes[0], state.momentum.com - memory.origin)) / self._travel
