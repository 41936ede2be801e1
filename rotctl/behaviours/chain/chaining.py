"""One behaviour after the other in one run: each begins where the one before stands.

A part is what it is by itself: it has its own stages, gains and time, which begins with it. It
heads where the feet point as it begins. What ends it is the condition of its last stage, or,
where that has none, a rest on the feet.
"""

from functools import lru_cache
from math import atan2, degrees, fsum
from typing import TYPE_CHECKING, Any, NamedTuple

from rotctl.behaviours.behaviour import Behaviour, Placement, Signals
from rotctl.behaviours.chain import ways
from rotctl.behaviours.facing import frame_of
from rotctl.behaviours.rolling.finishing import Finishing
from rotctl.behaviours.rolling.rolling import Rolling
from rotctl.behaviours.staged.staged import Staged, StagedMemory
from rotctl.behaviours.support import forward
from rotctl.control import Command, ControllerSettings
from rotctl.errors import InputError
from rotctl.maths.rotations import dot
from rotctl.mechanics.bodies import body_ids
from rotctl.mechanics.excursion import ExcursionSettings
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State

if TYPE_CHECKING:  # which makes this one
    from rotctl.behaviours.chain.settings import ChainSettings

Part = Staged | Rolling | Finishing


class ChainMemory(NamedTuple):
    """What a chain remembers from one control step to the next.

    Attributes:
        way: number of the one that it is on.
        part: number of the part.
        inner: what that remembers.
        heading: of it [deg].
        begun: when it began [s].
        height: of the centre of mass over the ground then [m].
        rested: for how long [s].
    """

    way: int
    part: int
    inner: Any
    heading: float
    begun: float
    height: float
    rested: float = 0.0


class Chain:
    """A chain in one run."""

    def __init__(
        self,
        settings: "ChainSettings",
        model: Model,
        control: ControllerSettings,
        measured: ExcursionSettings,
    ) -> None:
        """Prepare the parts.

        Raises:
            InputError: a part does not fit the model or has no gains, or one that is to begin
                from standing lies.
        """
        self._settings, self._model, self._period = settings, model, 1.0 / control.rate
        self._feet = {*body_ids(model.mj, settings.rest.feet, "behaviour.rest.feet")}
        self._ways = settings.taken
        for number, way in enumerate(self._ways):
            if way.when:
                way.when.check(model, f"behaviour.ways.{number}.when")
        later = {number for way in self._ways for number in way.parts[1:]}
        for number, part in enumerate(settings.parts):
            if number in later and part.behaviour.roll_about == "head":
                raise InputError(
                    f"{part.place(number)}: {part.behaviour.name} rolls about the head, "
                    "lying, and cannot begin from standing"
                )

        @lru_cache(maxsize=len(settings.parts))
        def made(number: int, heading: float) -> Part:
            part = settings.parts[number]
            try:
                return part.make(heading, model, control, measured)
            except InputError as error:
                raise InputError(f"{part.place(number)}: {error}") from None

        self._made = made
        first = [made(i, part.behaviour.heading) for i, part in enumerate(settings.parts)]
        self.axes = first[0].axes
        self.tasks = tuple(dict.fromkeys(name for part in first for name in part.tasks))
        self._slots = [[self.tasks.index(name) for name in part.tasks] for part in first]

    def start(self, pitch: float) -> Placement:
        """As the first part."""
        return self._first.start(pitch)

    def begin(self, pitch: float, state: State) -> ChainMemory:
        """Memory at the start."""
        heading, height = self._settings.parts[0].behaviour.heading, self._height(state)
        way = ways.chosen(self._ways, self._model, state)
        inner = self._first.begin(pitch, state)
        memory = ChainMemory(way, 0, inner, heading, state.time, height)
        first = self._ways[way].parts[0]
        return self._begun(way, first, memory, state, anew=True) if first else memory

    @property
    def _first(self) -> Behaviour[Any]:
        return self._made(0, self._settings.parts[0].behaviour.heading)

    def advance(self, before: ChainMemory, state: State) -> ChainMemory:
        """Memory now; the next part begins where the present one is over, or a try failed."""
        behaviour: Behaviour[Any] = self._part(before)
        inner = behaviour.advance(before.inner, _since(before, state))
        memory = before._replace(inner=inner)
        rested = before.rested + self._period if self._rests(memory, state) else 0.0
        memory = memory._replace(rested=rested)
        if self._failed(before.inner, memory, state):
            way = ways.chosen(self._ways, self._model, state)
            return self._begun(way, self._ways[way].parts[0], memory, state, anew=True)
        if self._at_first(memory):  # who tumbles may come to lie otherwise
            way = ways.chosen(self._ways, self._model, state)
            first = self._ways[way].parts[0]
            if way != memory.way and self._settings.parts[first].behaviour.kind == "staged":
                return self._begun(way, first, memory, state, anew=True)
        following = self._following(memory)
        if following is not None and self._over(memory, state):
            return self._begun(memory.way, following, memory, state)
        return memory

    def _following(self, memory: ChainMemory) -> int | None:
        """The part that comes next on the way, if one does."""
        parts = self._ways[memory.way].parts
        place = parts.index(memory.part) + 1
        return parts[place] if place < len(parts) else None

    def _at_first(self, memory: ChainMemory) -> bool:
        """Whether it is in the first stage of its way."""
        inner, first = memory.inner, self._ways[memory.way].parts[0]
        return memory.part == first and isinstance(inner, StagedMemory) and inner.stage == 0

    def _failed(self, before: Any, memory: ChainMemory, state: State) -> bool:
        """Whether the way has come to nothing, from what the part remembered before."""
        settings, part, inner = self._settings, self._part(memory), memory.inner
        patience = self._ways[memory.way].patience
        at_last = not isinstance(part, Rolling) and part.at_last(inner)
        if settings.ways and isinstance(inner, StagedMemory) and inner.stage == 0 < before.stage:
            return True
        if patience is not None and not at_last and state.time - memory.begun > patience:
            return True
        last = at_last and self._following(memory) is None
        return last and settings.again is not None and self._height(state) < settings.again

    def _over(self, memory: ChainMemory, state: State) -> bool:
        part = self._part(memory)
        assert not isinstance(part, Rolling)  # only the last part rolls on, see ChainSettings
        own = part.over(memory.inner, _since(memory, state))
        # One step more than its rest, so that whoever looks at its last rows sees the whole of it.
        rested = memory.rested > self._settings.rest.seconds + 0.5 * self._period
        return rested if own is None else own

    def _begun(
        self, way: int, number: int, memory: ChainMemory, state: State, anew: bool = False
    ) -> ChainMemory:
        settings = self._settings.parts[number].behaviour
        about = settings.roll_about
        heading = self._facing(memory, state, anew) + (180.0 if about == "right" else 0.0)
        frame = frame_of(about, heading, getattr(settings, "turn_about", "left"))
        begun = ChainMemory(way, number, None, heading, state.time, self._height(state))
        behaviour: Behaviour[Any] = self._part(begun)
        pitch = frame.turned(state.trunk_axes)
        return begun._replace(inner=behaviour.begin(pitch, _since(begun, state)))

    def _part(self, memory: ChainMemory) -> Part:
        return self._made(memory.part, memory.heading)

    def _rests(self, memory: ChainMemory, state: State) -> bool:
        part = self._part(memory)
        if isinstance(part, Rolling) or not part.at_last(memory.inner):
            return False
        return self._settings.rest.seen(state, self._feet, self._height(state), memory.height)

    def _facing(self, memory: ChainMemory, state: State, anew: bool) -> float:
        """Where its feet point, from +x towards +y [deg]: a trunk is turned sooner than they.

        With no foot on the ground, say on its back, it is where the part that ends was heading,
        or, where a way begins anew, across the trunk's left; who rolls backward heads where the
        back points.
        """
        if self._feet.isdisjoint(state.contacts.body.tolist()):
            x, y, _ = state.trunk_axes[:, 1].tolist()
            fronts = [(y, -x)] if anew else [self._front(memory, state)]
        else:
            fronts = [forward(state, foot) for foot in sorted(self._feet)]
        return degrees(atan2(fsum(y for _, y in fronts), fsum(x for x, _ in fronts)))

    def _front(self, memory: ChainMemory, state: State) -> tuple[float, float]:
        """Where the front of the part that ends points, level and unit."""
        behaviour: Behaviour[Any] = self._part(memory)
        signals = behaviour.signals(memory.inner, _since(memory, state))
        x, y, _ = signals.axes[0].tolist()
        backward = dot(signals.axis, state.trunk_axes[:, 1]) < -0.5  # about the trunk's right
        return (-x, -y) if backward else (x, y)

    def _height(self, state: State) -> float:
        x, y, z = state.momentum.com.tolist()
        return float(z) - self._model.ground.height(x, y)

    def command(self, memory: ChainMemory, state: State) -> Command:
        """What the present part wants at this instant."""
        behaviour: Behaviour[Any] = self._part(memory)
        command = behaviour.command(memory.inner, _since(memory, state))
        slots = self._slots[memory.part]
        own = range(len(slots)) if command.slots is None else command.slots
        return command._replace(slots=[slots[slot] for slot in own])

    def signals(self, memory: ChainMemory, state: State) -> Signals:
        """What the log keeps of it; stages are numbered on from part to part."""
        behaviour: Behaviour[Any] = self._part(memory)
        signals = behaviour.signals(memory.inner, _since(memory, state))
        before = sum(part.stages for part in self._settings.parts[: memory.part])
        return signals._replace(stage=signals.stage + before)


def _since(memory: ChainMemory, state: State) -> State:
    """The state at the part's own time."""
    return state._replace(time=state.time - memory.begun)
