"""What disturbs a run, drawn from its seed: pushes, and what `wind` and `changes` beside it have.

Forces act on bodies through MuJoCo's `xfrc_applied` and are told in the log. Control knows of them
only where `controller.sees_disturbance` says so.
"""

from dataclasses import dataclass
from math import cos, nan, radians, sin
from typing import Annotated, ClassVar, Literal, Protocol

import mujoco
import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.maths.linear import product
from rotctl.maths.rotations import Array, cross
from rotctl.mechanics.bodies import ROOT_BODY, body_id
from rotctl.mechanics.changes import Load, Slip
from rotctl.mechanics.model import Model
from rotctl.mechanics.onset import SHORTEST, Onset, Phase, Time, far_from
from rotctl.mechanics.wind import Wind
from rotctl.settings.fields import STRICT, Drawn, NonNegative, Positive, ends

DISTURBANCE_STREAM = 2  # beside the start's, which is drawn from the seed alone, and the terrain's


class Disturbance(Protocol):
    """What disturbs one run."""

    @property
    def remark(self) -> str:
        """What the log should tell of the control step that began last; mostly empty."""
        ...

    def awaited(self, time: float) -> str:
        """What has not come by a time [s]; empty if nothing is to."""
        ...

    def apply(self, data: mujoco.MjData, period: float, phase: float) -> Array:
        """Set the forces of the control step that begins, which stay for its `period` [s].

        Args:
            phase: of the behaviour, a control step ago [rad]; NaN at the first.

        Returns:
            Their sum and their moment about the centre of mass (6,) [N, N m].
        """
        ...

    def idle(self, time: float, period: float) -> bool:
        """Whether the control step of that `period` that begins at `time` [s] can do without it.

        Nothing acts in it, and nothing that acted before is left to be taken away.
        """
        ...


@validated(frozen=True, config=STRICT)
class Calm:
    """Nothing disturbs."""

    name: str
    kind: Literal["none"]
    description: str = ""
    changes_model: ClassVar[bool] = False

    def make(self, model: Model, axes: Array, generator: np.random.Generator) -> "Nothing":
        """For one run."""
        return Nothing()


@validated(frozen=True, config=STRICT)
class Push:
    """One push, level.

    Attributes:
        body: that is pushed, at its centre of mass.
        impulse: [N s]; duration: it is spread over [s].
        direction: from forward towards left [deg]; as time and phase a range to draw from, or
            a number.
        time: when it begins [s].
        phase: of the behaviour [deg, from -360 to 360] that it waits for from then on; null does
            not wait.
    """

    name: str
    kind: Literal["push"]
    body: str
    impulse: NonNegative
    duration: Annotated[Positive, Field(ge=SHORTEST)]
    direction: Drawn
    time: Time
    phase: Phase | None = None
    description: str = ""
    changes_model: ClassVar[bool] = False

    def make(
        self, model: Model, axes: Array, generator: np.random.Generator
    ) -> "OnePush | PushAtPhase":
        """For one run whose forward, left and up are the rows of `axes`.

        Raises:
            InputError: there is no such body.
        """
        angle = radians(generator.uniform(*ends(self.direction)))
        way = product(np.array([cos(angle), sin(angle), 0.0]), axes)
        begin = float(generator.uniform(*ends(self.time)))
        body = body_id(model.mj, self.body, "disturbance.body")
        push = OnePush(body, self.impulse / self.duration * way, begin, begin + self.duration)
        if self.phase is None:
            return push
        return PushAtPhase(push, radians(generator.uniform(*ends(self.phase))))


DisturbanceSettings = Annotated[Calm | Push | Wind | Load | Slip, Field(discriminator="kind")]
"""What can disturb. Where one `changes_model`, the run has a model of its own."""


class Nothing:
    """Leaves everything as it is."""

    remark = ""

    def awaited(self, time: float) -> str:
        """See `Disturbance`."""
        return ""

    def apply(self, data: mujoco.MjData, period: float, phase: float = nan) -> Array:
        """See `Disturbance`."""
        return np.zeros(6)

    def idle(self, time: float, period: float) -> bool:
        """See `Disturbance`."""
        return True


@dataclass(frozen=True)
class OnePush:
    """A force (3,) [N] on a body from `begin` to `end` [s]."""

    body: int
    force: Array
    begin: float
    end: float
    remark: ClassVar[str] = ""

    def awaited(self, time: float) -> str:
        """See `Disturbance`."""
        return "the push" if time <= self.begin else ""

    def apply(self, data: mujoco.MjData, period: float, phase: float = nan) -> Array:
        """See `Disturbance`; a step that holds a part of the push gets that part of it."""
        overlap = min(data.time + period, self.end) - max(data.time, self.begin)
        if overlap <= 0.0:
            data.xfrc_applied[self.body, :3] = 0.0
            return np.zeros(6)
        force = self.force * (overlap / period)
        data.xfrc_applied[self.body, :3] = force
        lever = data.xipos[self.body] - data.subtree_com[ROOT_BODY]
        return np.concatenate((force, cross(lever, force)))

    def idle(self, time: float, period: float) -> bool:
        """See `Disturbance`."""
        return far_from(time, period, self.begin, self.end)


class PushAtPhase:
    """A push that waits until the behaviour comes through a phase."""

    remark = ""

    def __init__(self, push: OnePush, phase: float) -> None:
        """Begin `push` where it would have begun, or later, at that phase [rad]."""
        self._push, self._onset, self._begun = push, Onset(push.begin, phase), False

    def awaited(self, time: float) -> str:
        """See `Disturbance`."""
        return "" if self._begun else "the push"

    def apply(self, data: mujoco.MjData, period: float, phase: float = nan) -> Array:
        """See `Disturbance`."""
        push = self._push
        if not self._begun and self._onset.come(data.time, phase):
            lasting = push.end - push.begin
            self._push = OnePush(push.body, push.force, data.time, data.time + lasting)
            self._begun = True
        return self._push.apply(data, period) if self._begun else np.zeros(6)

    def idle(self, time: float, period: float) -> bool:
        """See `Disturbance`; while it waits for its phase it is asked at each step."""
        return self._push.idle(time, period) and (self._begun or time < self._push.begin)
