"""A controller that asks both control steps, and obeys the reference."""

from dataclasses import dataclass, replace
from itertools import islice

from rotctl.control import Command, Controller, Decision
from rotctl.mechanics.state import State
from rotctl.simulation.episode import Episode


@dataclass(frozen=True)
class Asked:
    """One control step twice: what was asked, states read and decisions."""

    command: Command
    blend: float
    expected: State
    found: State
    slow: Decision
    fast: Decision


class Both:
    """Serves an episode as its controller; `asked` is its last step."""

    def __init__(self, model, settings):
        self.settings = settings
        self._fast = Controller(model, replace(settings, backend="compiled"))
        self._slow = Controller(model, replace(settings, backend="reference"))
        assert (self._fast.backend, self._slow.backend) == ("compiled", "reference")

    def read(self, data):
        self._found, self._expected = self._fast.read(data), self._slow.read(data)
        return self._expected

    def decide(self, state, command, blend):
        assert state is self._expected
        slow = self._slow.decide(state, command, blend)
        fast = self._fast.decide(self._found, command, blend)
        self.asked = Asked(command, blend, state, self._found, slow, fast)
        return slow


def along(scenario, steps):
    """What both say along an episode that the reference drives."""
    both = Both(scenario.model, scenario.controller.settings)
    for _ in islice(Episode(replace(scenario, controller=both, observer=both)), steps):
        yield both.asked
