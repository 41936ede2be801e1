"""An engine without processes, for tests of what is done with its results."""

import pytest

from rotctl.cli.main import main
from rotctl.sweep import engine_choice
from rotctl.sweep.engines import Failure, carried_out


class Here:
    """Carries tasks out in this process, one by one.

    Attributes:
        fails: reasons by index, of tasks that shall fail.
        asked: how many tasks it was given.
    """

    where, workers, together = "this process", 1, 1

    def __init__(self, fails=None):
        self.fails = fails or {}
        self.asked = 0

    def map(self, task, items, retries):
        for index, item in enumerate(items):
            self.asked += 1
            reason = self.fails.get(index)
            yield index, Failure(reason) if reason else carried_out(task, item)

    def close(self):
        pass


def without_processes(patch):
    """Let the commands carry their tasks out here."""
    patch.setattr(engine_choice, "make_engine", lambda jobs, scheduler: Here())


def swept(out, *overrides):
    """Make a sweep, as the command does, but in this process."""
    with pytest.MonkeyPatch.context() as patch:
        without_processes(patch)
        assert main(["sweep", *overrides, "--out", str(out), "--quiet"]) == 0
    return out
