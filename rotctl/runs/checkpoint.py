"""The beginning of a long run, written now and then: a kill costs seconds, not all of it.

It is a whole log of its own, `interrupted.h5`, whose outcome says that it is no finished run: it
can be looked at like any other, and counts nowhere. The finished run takes its place.
"""

import time
from pathlib import Path

from rotctl.log import TrajectoryBuffer, write_log
from rotctl.runs.encoding import encoded
from rotctl.runs.folder import INTERRUPTED_NAME
from rotctl.runs.scenario import Scenario

LONG = 60.0  # [s] simulated: what is shorter is soon simulated again
EVERY = 5.0  # [s] of computing
LEAST_WORK = 20.0  # times what writing one takes, from one to the next


class Checkpoints:
    """Called after every control step of a run."""

    def __init__(self, scenario: Scenario, folder: Path) -> None:
        """For a run that will lie in `folder`, which is there."""
        self._scenario, self._path = scenario, folder / INTERRUPTED_NAME
        self._wanted = scenario.config.duration > LONG
        self._begin = time.monotonic()
        self._due = self._begin + EVERY
        self._buffer: TrajectoryBuffer | None = None
        self._done = 0

    def __call__(self, buffer: TrajectoryBuffer, done: int) -> None:
        """So many rows are simulated."""
        self._buffer, self._done = buffer, done
        if self._wanted and time.monotonic() > self._due:
            self.write()

    def write(self) -> None:
        """Write what is simulated so far, if the run is a long one.

        Raises:
            InputError: it cannot be written.
        """
        if not self._wanted or self._buffer is None:
            return
        begin = time.monotonic()
        until = self._done / self._scenario.config.controller.rate
        rows, ending = self._buffer.trimmed(self._done), f"interrupted at t = {until:.2f} s"
        write_log(self._path, encoded(self._scenario, rows, ending, begin - self._begin).log)
        end = time.monotonic()
        self._due = end + max(EVERY, LEAST_WORK * (end - begin))
