"""Advancing the physics by one control period: an interface, and MuJoCo's own stepping."""

import ctypes
from collections.abc import Callable
from functools import lru_cache
from math import isfinite
from typing import Protocol

import mujoco
import numpy as np

from rotctl.maths.rotations import Array
from rotctl.mechanics.contacts import Contacts
from rotctl.mechanics.model import Model
from rotctl.mechanics.pair_limit import crowded
from rotctl.native.library import library
from rotctl.simulation.ground_forces import GroundForces, ground_forces

WARNINGS = {
    mujoco.mjtWarning.mjWARN_INERTIA: "nearly singular inertia matrix",
    mujoco.mjtWarning.mjWARN_CONTACTFULL: "too many contacts",
    mujoco.mjtWarning.mjWARN_CNSTRFULL: "too many constraints",
    mujoco.mjtWarning.mjWARN_BADQPOS: "position not finite or too large",
    mujoco.mjtWarning.mjWARN_BADQVEL: "velocity not finite or too large",
    mujoco.mjtWarning.mjWARN_BADQACC: "acceleration not finite or too large",
    mujoco.mjtWarning.mjWARN_BADCTRL: "control not finite",
}


class Stepper(Protocol):
    """A way to step the physics; the state lives in MuJoCo's data.

    Attributes:
        backend: which code steps, for the log.
        notice: what a user should know about that; mostly empty.
    """

    backend: str
    notice: str

    def evaluate(self, data: mujoco.MjData) -> None:
        """Bring positions, contacts and bias up to date with the state in `data`."""
        ...

    def advance(self, data: mujoco.MjData, torque: Array, contacts: Contacts) -> GroundForces:
        """Hold `torque` (nu,) [N m] for one control period that begins with these contacts."""
        ...

    def remark(self) -> str:
        """What the log should tell of the last control period; mostly empty."""
        ...

    def complaint(self, data: mujoco.MjData) -> str:
        """Why the state can no longer be trusted; empty while it can."""
        ...


class MujocoStepper:
    """MuJoCo's soft contacts: `substeps` steps with the torque held.

    Attributes:
        substeps: of a control period.
        period: of control [s].
        periods: made so far.
    """

    backend = "mujoco"
    notice = ""

    def __init__(self, model: Model, substeps: int) -> None:
        """Step `model` `substeps` times per control period."""
        self._mj = model.mj
        self.substeps = substeps
        self.period = substeps * model.mj.opt.timestep
        self._forces = ground_forces(model.mj)
        self._sound = _sound()
        self.periods = 0
        self._crowd = ""

    def evaluate(self, data: mujoco.MjData) -> None:
        """First half of a step, which needs no torque."""
        mujoco.mj_step1(self._mj, data)

    def advance(self, data: mujoco.MjData, torque: Array, contacts: Contacts) -> GroundForces:
        """Second half of the step begun by `evaluate`, then the other substeps."""
        data.ctrl[:] = torque
        self._forces.begin(contacts)
        self._crowd = ""
        mujoco.mj_step2(self._mj, data)
        self._look(data)
        for _ in range(self.substeps - 1):
            mujoco.mj_step(self._mj, data)
            self._look(data)
        self.periods += 1
        return self._forces.result()

    def remark(self) -> str:
        """Of a pair of geoms with all contacts that it can have; the solver is silent."""
        return self._crowd

    def complaint(self, data: mujoco.MjData) -> str:
        """See `trouble`; mostly it is seen at once that there is none."""
        late = abs(data.time - self.periods * self.period) > 0.5 * self.period
        if self._sound and not late and self._sound(self._mj._address, data._address):
            return ""
        return trouble(data, self.periods, self.period)

    def _look(self, data: mujoco.MjData) -> None:
        """At the contacts of a physics step."""
        self._forces.add(data)
        self._crowd = self._crowd or crowded(self._mj, data)


@lru_cache(maxsize=1)
def _sound() -> Callable[[int, int], int] | None:
    """What C can tell at once, if it is built."""
    built = library()
    if built is None:
        return None
    function: Callable[[int, int], int] = built.rotctl_sound
    function.argtypes, function.restype = [ctypes.c_void_p] * 2, ctypes.c_int  # type: ignore[attr-defined]
    return function


def trouble(data: mujoco.MjData, periods: int, period: float) -> str:
    """MuJoCo's warnings, a state that is not finite, or a clock that was reset.

    Args:
        periods: of `period` [s] that the clock should show.
    """
    counts = data.warning.number
    if any(counts.tolist()):
        kind = mujoco.mjtWarning(int(np.flatnonzero(counts)[0]))
        return f"MuJoCo warns: {WARNINGS[kind]}"
    if not isfinite(np.add.reduce(data.qpos) + np.add.reduce(data.qvel)):
        return "the state is not finite"
    if abs(data.time - periods * period) > 0.5 * period:
        return "MuJoCo reset the simulation"
    return ""
