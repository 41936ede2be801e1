"""A roll in C: its constants as `native/roll.c` takes them, and its memory to and fro."""

import ctypes
from collections.abc import Sequence
from typing import Any

import numpy as np

from rotctl.behaviours.facing import Frame
from rotctl.behaviours.rolling.alighting import Alighting
from rotctl.behaviours.rolling.catching import Catch
from rotctl.behaviours.rolling.pacing import Clock, Pace
from rotctl.behaviours.rolling.remembering import RollingMemory
from rotctl.behaviours.rolling.waiting import Waiting
from rotctl.maths.rotations import Array
from rotctl.mechanics.excursion import Excursion, ExcursionSettings
from rotctl.motion import PosePair, ReferencePair
from rotctl.native.layout import structure

PACE = (  # its settings that C takes as they are
    *("travel", "own", "calm", "swing", "swing_from", "surge", "surge_from", "wait", "width"),
    *("back", "ahead", "brake", "gain", "most", "patience"),
)


class CompiledRoll:
    """What C needs of one roll.

    Attributes:
        constants: the structure `Roll`.
    """

    def __init__(
        self,
        frame: Frame,
        measured: ExcursionSettings,
        period: float,
        slope: float,
        velocities: tuple[Array, Array],
        poses: PosePair | ReferencePair,
        tasks: Array,
    ) -> None:
        """Hand the constants over.

        Args:
            period: of control [s].
            slope: of the way [rad].
            velocities: (3,) wanted of the centre of mass [m/s] and about it [rad/s].
            tasks: the two that the roll's command holds, with the same memory.
        """
        self._kept: list[object] = []  # what the addresses are of
        self.constants = constants = structure("Roll")(
            sign=frame.sign,
            slope=slope,
            period=period,
            correction_time=measured.correction_time,
            phase_time=measured.phase_time,
            column=frame.column,
            integral=measured.measure == "integral",
            task=self._at(tasks),
        )
        constants.axes[:], constants.front[:] = frame.axes.ravel(), frame.mark
        constants.velocity[:], constants.angular_velocity[:] = velocities
        names: tuple[str, ...] = ("coefficients", "low", "high")
        if isinstance(poses, ReferencePair):
            constants.rows, names = len(poses.table), ("table", "rise")
        else:
            constants.waves = poses.coefficients.shape[1]
        for name in names:
            setattr(constants, name, self._at(np.ascontiguousarray(getattr(poses, name))))

    def add_pace(self, pace: Pace, way: Array, over: list[int], damping: Array) -> None:
        """Keep a pace, too.

        Args:
            way: (3,) of the speed, unit.
            over: bodies that it waits over.
            damping: (2, 3) of the two tasks where it does not wait [1/s].
        """
        settings = pace.settings
        made = structure("Pace")(
            by_speed=settings.keep == "speed",
            changes=len(pace.times),
            count=len(over),
            easing=settings.easing or 0.0,
            approach=settings.approach or settings.width,
            leave=settings.leave or settings.width,
            times=self._at(np.array(pace.times, float)),
            rates=self._at(np.array(pace.rates, float)),
            over=self._at(np.array(over, np.int32)),
            **{name: getattr(settings, name) for name in PACE},
        )
        made.settling[:], made.usual[:] = settings.settling, damping.ravel()
        self._kept.append(made)
        self.constants.pace, self.constants.way[:] = ctypes.addressof(made), way

    def add_waiting(self, waiting: Waiting) -> None:
        """Settle into a pose while it waits, too."""
        self.constants.waiting = self._at(waiting.angles)

    def add_catch(self, catch: Catch) -> None:
        """Catch itself, too."""
        given = catch.settings
        made = structure("Catch")(
            count=len(catch.out),
            gain=given.gain,
            free=given.free,
            lead=given.lead,
            motor=self._at(np.array(catch.motors, np.int32)),
            out=self._at(np.array(catch.out, float)),
            low=self._at(catch.low),
            high=self._at(catch.high),
        )
        self._kept.append(made)
        self.constants.catch = ctypes.addressof(made)

    def add_alighting(self, alighting: Alighting) -> None:
        """Bring limbs aside as they come down, too."""
        given, limbs = alighting.settings, alighting.limbs
        pairs = [pair for _, joints in limbs for pair in joints]
        ends = np.cumsum([len(joints) for _, joints in limbs])
        made = structure("Alighting")(
            lead=given.lead,
            sinking=given.sinking,
            reach=given.reach,
            most=given.most,
            limbs=len(limbs),
            body=self._at(np.array([body for body, _ in limbs], np.int32)),
            end=self._at(ends.astype(np.int32)),
            motor=self._at(np.array([motor for motor, _ in pairs], np.int32)),
            joint=self._at(np.array([joint for _, joint in pairs], np.int32)),
            low=self._at(alighting.low),
            high=self._at(alighting.high),
        )
        self._kept.append(made)
        self.constants.alighting = ctypes.addressof(made)

    def add_oblique(self, oblique: Sequence[float]) -> None:
        """Keep an oblique axis of the trunk, see `Oblique` [deg]."""
        self.constants.oblique_waves = len(oblique)
        self.constants.oblique[: len(oblique)] = oblique

    def add_lift(self, lift: Sequence[float]) -> None:
        """Go up and down as it turns, see `Lift` [m/rev]."""
        self.constants.lift_waves = len(lift)
        self.constants.lift[: len(lift)] = lift

    def _at(self, array: Any) -> int:
        self._kept.append(array)
        return int(array.ctypes.data)


def put(memory: RollingMemory, there: ctypes.Structure) -> None:
    """What a roll remembers, into a structure `RollMemory`."""
    now = memory.excursion
    there.angle[:], there.orientation[:], there.phase = now
    there.axis[:], there.origin[:], there.first_angle[:] = memory.axis, memory.origin, memory.angle
    there.due, there.late = memory.clock


def taken(there: ctypes.Structure, before: RollingMemory) -> RollingMemory:
    """What it remembers now, of which origin and first angle are those of `before`."""
    now = Excursion(np.array(there.angle), np.array(there.orientation), there.phase)
    clock = Clock(there.due, there.late)
    return before._replace(excursion=now, axis=np.array(there.axis), clock=clock)
