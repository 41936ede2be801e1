"""What changes of the simulated world in a run: a body takes up a load, ground turns slippery.

Control is not told: it goes on with the model that it knows. No force acts as the change comes,
so no velocity jumps; a load that is taken up moves as the body does.
"""

from collections.abc import Callable
from math import nan, radians
from typing import ClassVar, Literal

import mujoco
import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.bodies import body_id
from rotctl.mechanics.model import Model
from rotctl.mechanics.onset import Onset, Phase, Time
from rotctl.settings.complaints import brief
from rotctl.settings.fields import STRICT, Drawn, ends

HEAVIEST = 1000.0  # [kg] that a body may take up


@validated(frozen=True, config=STRICT)
class Load:
    """A body's mass changes in the run, at its centre of mass.

    Attributes:
        body: that takes it up.
        mass: [kg] what is added, taken away if negative; as time and phase a range to draw from,
            or a number.
        time: when [s].
        phase: of the behaviour [deg] that it waits for from then on; null does not wait.
    """

    name: str
    kind: Literal["load"]
    body: str
    mass: Drawn
    time: Time
    phase: Phase | None = None
    description: str = ""
    changes_model: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if ends(self.mass)[1] > HEAVIEST:
            raise ValueError(f"mass={brief(self.mass)}: must be at most {HEAVIEST:g} kg")

    def make(self, model: Model, axes: Array, generator: np.random.Generator) -> "Change":
        """For one run, which has `model` alone.

        Raises:
            InputError: there is no such body, or it would be left without mass.
        """
        mj = model.mj
        added = float(generator.uniform(*ends(self.mass)))
        onset = _onset(self.time, self.phase, generator)
        body = body_id(mj, self.body, "disturbance.body")
        has = float(mj.body_mass[body])
        if has + ends(self.mass)[0] <= 0.0:
            raise InputError(
                f"disturbance.mass={ends(self.mass)[0]:g}: {self.body} has {has:.3g} kg"
            )

        def change() -> None:
            mj.body_mass[body] += added
            mujoco.mj_setConst(mj, mujoco.MjData(mj))

        return Change(mj, onset, change, f"{self.body} takes up {added:.3g} kg")


@validated(frozen=True, config=STRICT)
class Slip:
    """The ground's friction changes in the run, everywhere.

    Attributes:
        friction: a factor on it [-]; as time and phase a range to draw from, or a number.
        time: when [s].
        phase: of the behaviour [deg] that it waits for from then on; null does not wait.
    """

    name: str
    kind: Literal["slip"]
    friction: Drawn
    time: Time
    phase: Phase | None = None
    description: str = ""
    changes_model: ClassVar[bool] = True

    def __post_init__(self) -> None:
        low, high = ends(self.friction)
        if not 0.0 < low <= high <= 100.0:
            raise ValueError(
                f"friction={brief(self.friction)}: must be a factor above 0 and at most 100"
            )

    def make(self, model: Model, axes: Array, generator: np.random.Generator) -> "Change":
        """For one run, which has `model` alone."""
        mj = model.mj
        factor = float(generator.uniform(*ends(self.friction)))

        def change() -> None:
            mj.geom_friction *= factor

        onset = _onset(self.time, self.phase, generator)
        return Change(mj, onset, change, f"the ground has {factor:.3g} of its friction")


class Change:
    """A change of the simulated model that waits for its moment, and stays."""

    def __init__(
        self, mj: mujoco.MjModel, onset: Onset, change: Callable[[], None], told: str
    ) -> None:
        """Do `change` of `mj` at `onset`, and tell so."""
        self._mj, self._onset, self._change, self._told = mj, onset, change, told
        self._done, self.remark = False, ""

    def awaited(self, time: float) -> str:
        """See `rotctl.mechanics.disturbance.Disturbance`."""
        return "" if self._done else self._told

    def idle(self, time: float, period: float) -> bool:
        """See `rotctl.mechanics.disturbance.Disturbance`."""
        return False

    def apply(self, data: mujoco.MjData, period: float, phase: float = nan) -> Array:
        """See `rotctl.mechanics.disturbance.Disturbance`: no force acts."""
        self.remark = ""
        if not self._done and self._onset.come(data.time, phase):
            self._change()
            mujoco.mj_step1(self._mj, data)  # the step that has begun is all of the changed model
            self._done, self.remark = True, self._told
        return np.zeros(6)


def _onset(time: Drawn, phase: Drawn | None, generator: np.random.Generator) -> Onset:
    begin = float(generator.uniform(*ends(time)))
    return Onset(begin, None if phase is None else radians(generator.uniform(*ends(phase))))
