"""What a chain of behaviours is told."""

from dataclasses import field, replace
from typing import Annotated, Literal

from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.chain import ways
from rotctl.behaviours.chain.chaining import Chain, Part
from rotctl.behaviours.chain.resting import RestSettings
from rotctl.behaviours.chain.ways import Way, Ways
from rotctl.behaviours.rolling.settings import RollingSettings
from rotctl.behaviours.staged.settings import StagedSettings
from rotctl.control import ControllerSettings
from rotctl.control.settings import Gains
from rotctl.mechanics.excursion import ExcursionSettings
from rotctl.mechanics.model import Model
from rotctl.motion import RollAbout
from rotctl.settings.complaints import clip
from rotctl.settings.fields import MOST_PARTS, SPARSE, STRICT, Positive

LEAST_TURNS = 2.0  # [rev] of a roll that follows another part


@validated(frozen=True, config=STRICT)
class PartSettings:
    """One behaviour of a chain.

    Attributes:
        behaviour: as it is by itself.
        gains: its own; the run's controller's, if it has none.
        excursion: how AE and the phase are measured; as the run measures them, if it does not say.
        said: what it was composed of, for people; empty if that is not known.
    """

    behaviour: Annotated[RollingSettings | StagedSettings, Field(discriminator="kind")]
    gains: Gains | None = None
    excursion: ExcursionSettings | None = None
    said: str = ""

    @property
    def stages(self) -> int:
        """How many it has; a roll is one."""
        if isinstance(self.behaviour, StagedSettings):
            return len(self.behaviour.stages)
        return 1 if self.behaviour.finish is None else 1 + len(self.behaviour.finish.stages)

    def place(self, number: int) -> str:
        """Where it stands in a chain, for a message to begin with.

        By what was said of it where that is known: others may have been put between.

        Args:
            number: of the part.
        """
        return f"behaviour.parts: {clip(self.said)!r}" if self.said else f"behaviour.parts.{number}"

    @property
    def ends(self) -> bool:
        """Whether it comes to an end by itself."""
        return isinstance(self.behaviour, StagedSettings) or self.behaviour.finish is not None

    def make(
        self,
        heading: float,
        model: Model,
        control: ControllerSettings,
        measured: ExcursionSettings,
    ) -> Part:
        """The behaviour of one run, along a heading [deg]."""
        own = control if self.gains is None else replace(control, **vars(self.gains))
        behaviour = replace(self.behaviour, heading=heading)
        return behaviour.make(model, own, self.excursion or measured)


@validated(frozen=True, config=STRICT)
class ChainSettings:
    """Behaviours one after the other.

    Attributes:
        parts: in their order.
        rest: what ends a part whose last stage has no condition.
        again: who lies lower than that in the last stage of all begins with the first part again
            [m]; the centre of mass over the ground. Nobody does if None.
        ways: which parts follow each other, by how the body is as it begins, or begins again; who
            falls back to the first stage of a part chooses anew, too, and who is in the first stage
            of a way among those that begin with stages. All in a row if None.
    """

    name: str
    kind: Literal["chain"]
    parts: Annotated[tuple[PartSettings, ...], Field(min_length=1, max_length=MOST_PARTS)]
    rest: RestSettings
    again: Positive | None = field(default=None, metadata=SPARSE)
    ways: Ways | None = field(default=None, metadata=SPARSE)
    source: str = ""
    description: str = ""

    def __post_init__(self) -> None:
        if self.ways:
            ways.check(self.ways, len(self.parts))
        followed = {part for way in self.taken for part in way.parts[:-1]}
        last = [way.parts[-1] for way in self.taken]
        for number in sorted(followed):
            part = self.parts[number]
            if not part.ends:
                place = part.place(number).removeprefix("behaviour.")
                raise ValueError(
                    f"{place}: {part.behaviour.name} rolls on, and others follow it; "
                    "'behaviour=NAME +finish=stand' comes to an end"
                )
        for number in sorted({part for way in self.taken for part in way.parts[1:]}):
            _require_turns(self.parts[number], number)
        for number in last if self.again is not None else ():
            if not self.parts[number].ends:
                raise ValueError(
                    f"again={self.again:g}: acts on nothing, {self.parts[number].behaviour.name} "
                    "rolls on; 'behaviour=NAME +finish=stand' comes to an end"
                )

    @property
    def taken(self) -> tuple[Way, ...]:
        """The ways; one through all parts, where none are told."""
        return self.ways or (Way(tuple(range(len(self.parts)))),)

    @property
    def roll_about(self) -> RollAbout:
        """Of the first part, that starts."""
        return self.parts[0].behaviour.roll_about

    @property
    def commanded(self) -> dict[str, float]:
        """Nothing of the whole: parts have their own."""
        return {}

    @property
    def halts(self) -> tuple[()]:
        """Nothing of the whole."""
        return ()

    @property
    def kinds(self) -> dict[str, str]:
        """Kinds of the tasks by the names of their gains, of parts without gains of their own."""
        shared = [part.behaviour.kinds for part in self.parts if part.gains is None]
        return {name: kind for kinds in shared for name, kind in kinds.items()}

    @property
    def by_excursion(self) -> bool:
        """Whether a part goes by the whole of AE as the run measures it."""
        return any(part.behaviour.by_excursion for part in self.parts if part.excursion is None)

    def make(self, model: Model, control: ControllerSettings, measured: ExcursionSettings) -> Chain:
        """The behaviour of one run."""
        return Chain(self, model, control, measured)


def _require_turns(part: PartSettings, number: int) -> None:
    """Raises ValueError for a counted roll that is told to end before its first turn is over."""
    behaviour = part.behaviour
    finish = None if isinstance(behaviour, StagedSettings) else behaviour.finish
    if finish is None:
        return
    if not 0.0 < finish.revolutions < LEAST_TURNS:
        return
    place = part.place(number).removeprefix("behaviour.")
    raise ValueError(
        f"{place}: behaviour.finish.revolutions={finish.revolutions:g}: a roll out of a stand that "
        "is told to end in its first revolution stops over its hands; "
        f"give {LEAST_TURNS:g} or more, or 0, which counts none"
    )


def first_stage(settings: ChainSettings | RollingSettings | StagedSettings) -> str:
    """The stage that a behaviour begins with in any start; empty where the start decides."""
    if isinstance(settings, ChainSettings):
        return "" if settings.ways else first_stage(settings.parts[0].behaviour)
    return settings.stages[0].name if isinstance(settings, StagedSettings) else ""
