"""Whole control periods of a roll in one call of C each, from the state to its row of the log.

Serves what most runs are: a roll in MuJoCo's own physics that control knows, while nothing
disturbs it. It does what `Episode.step` and `record` do, to the same bits; where something is out
of the ordinary (a push, a solver that fails, a body that leaves the ground) C leaves a period to
them.
"""

import ctypes
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import mujoco
from numpy.typing import NDArray

from rotctl.behaviours.rolling.compiled import CompiledRoll, put, taken
from rotctl.behaviours.rolling.rolling import Rolling
from rotctl.control import Controller
from rotctl.control.compiled import FAILED, CompiledStep
from rotctl.log import TrajectoryBuffer
from rotctl.mechanics.disturbance import Nothing
from rotctl.mechanics.pair_limit import LIMIT, crowded
from rotctl.native.layout import structure
from rotctl.native.library import library
from rotctl.simulation.episode import Episode, Moment, Parts
from rotctl.simulation.stepping import MujocoStepper

# What no such period has stays as it was allocated, or is Python's: the ground's height.
ZERO = {"stage", "wrench", "status", "iterations", "fallback"}
HERE = {"ground_height"}


def compiled_periods(
    parts: Parts, episode: Episode, buffer: TrajectoryBuffer
) -> "CompiledPeriods | None":
    """For one run that begins; None where C has not what it asks for."""
    behaviour, controller, stepper = parts.behaviour, parts.controller, parts.stepper
    roll = behaviour.compiled() if type(behaviour) is Rolling else None
    step = controller.step if type(controller) is Controller else None
    known = parts.senses.exact and parts.motors.prompt
    if roll is None or step is None or not known or type(stepper) is not MujocoStepper:
        return None
    return CompiledPeriods(parts, stepper, step, roll, episode, buffer)


class CompiledPeriods:
    """The control periods of one run.

    Attributes:
        remark: of the physics in the last one; mostly empty.
    """

    def __init__(
        self,
        parts: Parts,
        stepper: MujocoStepper,
        step: CompiledStep,
        roll: CompiledRoll,
        episode: Episode,
        buffer: TrajectoryBuffer,
    ) -> None:
        """Hand over where everything is."""
        self._made, self._step, self._stepper, self._episode = _function(), step, stepper, episode
        self._crowds: list[str] = []
        crowd = _look(parts.model.mj, episode.data, self._crowds)
        rows = _rows(buffer)
        self._run = run = structure("Run")(
            **step.addresses,
            data=episode.data._address,
            roll=ctypes.addressof(roll.constants),
            rows=ctypes.addressof(rows),
            crowd=ctypes.c_void_p.from_buffer(crowd).value,  # a cast would keep all of this alive
            period=stepper.period,
            substeps=stepper.substeps,
            most=LIMIT,
        )
        ground = parts.model.ground
        run.extent[:] = ground.extent.begin, ground.extent.end, ground.extent.aside
        self._memory = run.memory
        self._address, self._kept = ctypes.addressof(run), (parts, roll, crowd, rows, buffer)
        self._height, self._trajectory = ground.height, buffer.trajectory
        self._outside = None if type(parts.disturbance) is Nothing else parts.disturbance
        self._period = 1.0 / parts.controller.settings.rate
        self._ready = False

    def follow(self, moment: Moment) -> None:
        """Go on from a control period that the episode made."""
        self._ready = self._calm() and self._step.ask(moment.command, moment.decision.blend)
        if self._ready:
            put(self._episode.memory, self._memory)

    def make(self, i: int) -> bool:
        """Make the control period of row `i`; False where that is left to the episode.

        Raises:
            mujoco.FatalError: MuJoCo gave up.
        """
        if not self._ready:
            return False
        if not self._calm():
            self._give_back()
            self._ready = False
            return False
        if self._made(self._address, i) == FAILED:
            self._give_back()
            return False
        self._stepper.periods += 1
        rows = self._trajectory
        x, y, _ = rows.com[i].tolist()
        rows.ground_height[i] = self._height(x, y)
        return True

    @property
    def remark(self) -> str:
        """Of the physics in the last period, told once; mostly empty."""
        remark = next(filter(None, self._crowds), "")
        self._crowds.clear()
        return remark

    def _calm(self) -> bool:
        """Whether nothing from outside acts in the control period that begins."""
        outside = self._outside
        return outside is None or outside.idle(self._episode.data.time, self._period)

    def _give_back(self) -> None:
        run, episode = self._run, self._episode
        if run.error:
            raise mujoco.FatalError(run.error.decode(errors="replace"))
        episode.memory = taken(self._memory, episode.memory)
        episode.blend = self._step.blend
        episode.phase = episode.memory.excursion.phase


def _rows(buffer: TrajectoryBuffer) -> ctypes.Structure:
    """Where the rows of a buffer are."""
    arrays: dict[str, NDArray[Any]] = buffer.per_step()
    rows = structure("Rows")(
        capacity=buffer.contacts.body.shape[1], tasks=buffer.command.target.shape[1]
    )
    for name in set(arrays) - ZERO - HERE:
        setattr(rows, name, arrays[name].ctypes.data)
    return rows


def _look(mj: mujoco.MjModel, data: mujoco.MjData, told: list[str]) -> Any:
    """What C calls where a pair of geoms may be full of contacts."""
    return ctypes.CFUNCTYPE(None)(lambda: told.append(crowded(mj, data)))


@lru_cache(maxsize=1)
def _function() -> Callable[[int, int], int]:
    function: Callable[[int, int], int] = library().rotctl_period  # type: ignore[union-attr]
    function.argtypes, function.restype = [ctypes.c_void_p, ctypes.c_int], ctypes.c_int  # type: ignore[attr-defined]
    return function
