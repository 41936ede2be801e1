"""A roll that ends on its feet: it waits in the squat, and from there stages take over.

What it is to do then are stages as in `rotctl.behaviours.staged`, mostly one that balances and
rises, along the way that it came on. Until they begin the run is the roll's alone, and what they
want is no part of it.
"""

from dataclasses import field, replace
from functools import lru_cache
from math import degrees, tau
from typing import Annotated, NamedTuple

from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.behaviour import Placement, Signals
from rotctl.behaviours.rolling.remembering import RollingMemory
from rotctl.behaviours.rolling.rolling import Rolling
from rotctl.behaviours.staged.settings import StagedSettings
from rotctl.behaviours.staged.staged import Staged, StagedMemory
from rotctl.behaviours.staged.stages import Stage, TaskSettings
from rotctl.behaviours.support import pendulum_rate
from rotctl.control import Command, ControllerSettings
from rotctl.maths.rotations import dot
from rotctl.mechanics.excursion import ExcursionSettings
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State
from rotctl.motion import RollAbout
from rotctl.settings.fields import STRICT, Finite, NonNegative, Positive

AHEAD = 0.9  # [rev] before the last roll is over: it leaves the squat then, hands on the ground


@validated(frozen=True, config=STRICT)
class FinishSettings:
    """How a roll ends.

    Attributes:
        after: from then on it waits when it next comes to its feet [s].
        reach: the stages take over when the capture point along the way is so near to the middle of
            what the pace waits over [m],
        turning: the whole body turns less fast [rev/s],
        within: and the phase is so near to that in which it waits [rev].
        tasks, stages: as a staged behaviour has them.
        revolutions: and it rolls so many before [rev]; 0 counts none. It is told so as it leaves
            the squat before the last one, `AHEAD` of its end.
    """

    after: NonNegative
    reach: Positive
    turning: Positive
    within: Positive
    stages: Annotated[tuple[Stage, ...], Field(min_length=1, max_length=50)]
    tasks: dict[str, TaskSettings] = field(default_factory=dict)
    revolutions: NonNegative = 0.0

    def __post_init__(self) -> None:
        if 0.0 < self.revolutions <= AHEAD:
            raise ValueError(
                f"revolutions={self.revolutions:g}: must be more than {AHEAD:g}, or 0, "
                "which counts none"
            )

    def told(self, time: float, phase: float) -> bool:
        """Whether it is told to end, at a time [s] and a phase from upright [rad]."""
        turned = not self.revolutions or phase >= tau * (self.revolutions - AHEAD)
        return time >= self.after and turned

    def staged(self, roll_about: RollAbout, heading: Finite) -> StagedSettings:
        """The stages as a behaviour of their own.

        Raises:
            ValueError: they make none.
        """
        return StagedSettings("finish", "staged", roll_about, heading, self.stages, self.tasks)


class FinishingMemory(NamedTuple):
    """What it remembers.

    Attributes:
        roll: of the roll; where its way led when the stages began is where they face.
        end: of the stages; None before they begin.
    """

    roll: RollingMemory
    end: StagedMemory | None = None


class Finishing:
    """A roll and its end in one run."""

    def __init__(
        self,
        settings: FinishSettings,
        roll: Rolling,
        staged: StagedSettings,
        model: Model,
        control: ControllerSettings,
        measured: ExcursionSettings,
    ) -> None:
        """Prepare the stages.

        Raises:
            InputError: a body or a joint is not there, or a task has no gains.
        """
        self._settings, self._roll, self._model = settings, roll, model
        self.axes = roll.axes

        @lru_cache(maxsize=1)
        def end(turned: float) -> Staged:
            faced = replace(staged, heading=staged.heading + degrees(turned))
            return Staged(faced, model, control, measured, "behaviour.finish")

        self._end = end
        names = end(0.0).tasks
        ends = [f"{name} at the end" if name in roll.tasks else name for name in names]
        self.tasks = (*roll.tasks, *ends)

    def start(self, pitch: float) -> Placement:
        """As the roll."""
        return self._roll.start(pitch)

    def begin(self, pitch: float, state: State) -> FinishingMemory:
        """Memory at the start."""
        return FinishingMemory(self._roll.begin(pitch, state))

    def advance(self, before: FinishingMemory, state: State) -> FinishingMemory:
        """Memory now; the stages begin where the roll waits on its feet."""
        if before.end is not None:
            return before._replace(end=self._stages(before).advance(before.end, state))
        over = self._settings.told(state.time, before.roll.excursion.phase)
        roll = self._roll.advance(before.roll, state, goes=not over)
        if over and self._waits(roll, state):
            begun = self._end(roll.course.turned).begin(roll.excursion.phase, state)
            return FinishingMemory(roll, begun)
        return FinishingMemory(roll)

    def at_last(self, memory: FinishingMemory) -> bool:
        """Whether it is in its last stage."""
        return memory.end is not None and self._stages(memory).at_last(memory.end)

    def over(self, memory: FinishingMemory, state: State) -> bool | None:
        """Whether the condition of its last stage is met, for what follows; None without one."""
        if memory.end is None:
            return False
        return self._stages(memory).over(memory.end, state)

    def _stages(self, memory: FinishingMemory) -> Staged:
        return self._end(memory.roll.course.turned)

    def _waits(self, roll: RollingMemory, state: State) -> bool:
        s, momentum, axes = self._settings, state.momentum, roll.bearing.frame.axes
        speed = float(dot(axes[0], momentum.com_velocity))
        capture = self._roll.ahead(roll, state) + speed / pendulum_rate(self._model, state)
        turning = abs(float(dot(axes[1], momentum.angular_velocity))) / tau
        off = abs(self._roll.from_waiting(roll))
        return abs(capture) < s.reach and turning < s.turning and off < s.within

    def command(self, memory: FinishingMemory, state: State) -> Command:
        """What the roll or its end wants at this instant."""
        rolling = len(self._roll.tasks)
        if memory.end is None:
            command = self._roll.command(memory.roll, state)
            return command._replace(slots=list(range(rolling)))
        command = self._stages(memory).command(memory.end, state)
        slots = command.slots or []
        return command._replace(slots=[rolling + slot for slot in slots])

    def signals(self, memory: FinishingMemory, state: State) -> Signals:
        """What the log keeps of it; the stages are numbered after the roll, which is 0."""
        if memory.end is None:
            return self._roll.signals(memory.roll, state)
        signals = self._stages(memory).signals(memory.end, state)
        return signals._replace(stage=signals.stage + 1)
