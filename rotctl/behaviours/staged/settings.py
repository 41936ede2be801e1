"""What a behaviour of stages is told, and the checks on it."""

from dataclasses import field
from typing import Annotated, Literal

from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.aerial.flight_settings import TUCK
from rotctl.behaviours.facing import TurnAbout
from rotctl.behaviours.staged.aims import Hold, Turn
from rotctl.behaviours.staged.staged import Staged
from rotctl.behaviours.staged.stages import Stage, TaskSettings, kinds_of
from rotctl.behaviours.staged.touching import Launched
from rotctl.control import ControllerSettings
from rotctl.errors import InputError
from rotctl.mechanics.excursion import ExcursionName, ExcursionSettings
from rotctl.mechanics.model import Model
from rotctl.motion import RollAbout
from rotctl.settings.fields import SPARSE, STRICT, Finite, Positive


@validated(frozen=True, config=STRICT)
class StagedSettings:
    """A behaviour as stages.

    Attributes:
        roll_about: the trunk's axis that lies to the left.
        heading: of forward, from +x towards +y [deg].
        tasks: of every stage, by name; the controller has gains under the same names.
        target_excursion: how far to turn [deg], about
        turn_about: left, or up, or forward; about the latter two stages are of a turn to the left,
            and mirrored for one to the right.
        targets: that it can turn by [deg]; any, if it does not say.
        shape: in which it flies, if it does; see `rotctl.behaviours.aerial.flight`.
        take_off: upward speed at which it takes off, in place of the launch's own [m/s].
    """

    name: str
    kind: Literal["staged"]
    roll_about: RollAbout
    heading: Finite
    stages: Annotated[tuple[Stage, ...], Field(min_length=1, max_length=50)]
    tasks: dict[str, TaskSettings] = field(default_factory=dict)
    target_excursion: Finite = 0.0
    turn_about: TurnAbout = "left"
    shape: str = TUCK
    take_off: Positive | None = None
    targets: tuple[Finite, ...] | None = field(default=None, metadata=SPARSE)
    source: str = ""
    description: str = ""

    def __post_init__(self) -> None:
        if self.turn_about != "left" and self.roll_about != "left":
            about = self.turn_about
            raise ValueError(f"turn_about {about} needs roll_about left, not {self.roll_about}")
        if self.targets and self.target_excursion not in self.targets:
            valid = " or ".join(f"{each:g}" for each in self.targets)
            given = f"target_excursion={self.target_excursion:g}"
            raise ValueError(f"{given}: {self.name} is a motion of {valid} deg")
        if self.stages[0].poses is None:
            raise ValueError("the first stage must have poses: a run starts in them")
        if self.shape != TUCK and not any(stage.flight for stage in self.stages):
            raise ValueError(f"shape={self.shape}: nothing flies here")
        if self.take_off and not any(isinstance(s.until, Launched) for s in self.stages):
            raise ValueError(f"take_off={self.take_off:g}: no stage ends as it is launched")
        names = [stage.name for stage in self.stages]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"two stages are called {name!r}; each needs a name of its own")
        for stage in self.stages:
            if stage.otherwise and stage.otherwise.stage not in names:
                there = ", ".join(names)
                raise ValueError(f"otherwise: no stage {stage.otherwise.stage!r}; valid: {there}")
        for stage in self.stages[:-1]:
            if stage.until is None:
                raise ValueError(f"the stage {stage.name!r} has no until, and others follow it")

    @property
    def commanded(self) -> dict[str, float]:
        """What is asked for, as columns of the summary [deg]."""
        return {"target_excursion": self.target_excursion}

    @property
    def halts(self) -> tuple[()]:
        """Stages have none."""
        return ()

    @property
    def kinds(self) -> dict[str, str]:
        """Kinds of its tasks by the names of their gains."""
        return kinds_of(self.tasks, self.stages)

    @property
    def by_excursion(self) -> bool:
        """Whether a task goes by the whole of AE; the phase is measured in any case."""
        every = [self.tasks, *(stage.tasks for stage in self.stages)]
        spins = [task for tasks in every for task in tasks.values() if task.kind == "spin"]
        return any(isinstance(task.aim, Hold | Turn) for task in spins)

    def make(
        self, model: Model, control: ControllerSettings, measured: ExcursionSettings
    ) -> Staged:
        """The behaviour of one run.

        Raises:
            InputError: as for `Staged`, or nothing here is measured so.
        """
        self._require_measured(measured.measure)
        return Staged(self, model, control, measured)

    def _require_measured(self, measure: ExcursionName) -> None:
        """Raises InputError where a measure acts on nothing."""
        here = f"behaviour={self.name}, a list of stages,"
        lacking = {
            "clock": f"looks poses up by time, which {here} does not",
            "root": f"is about the velocity of a roll, which {here} has not",
        }
        if not self.by_excursion:
            lacking["integral"] = f"acts where a task turns or holds, and in {here} none does"
        if measure in lacking:
            raise InputError(f"excursion={measure}: {lacking[measure]}; choose excursion=oriented")
