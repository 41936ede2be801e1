"""What a long run leaves that is interrupted."""

import itertools

import numpy as np
import pytest

from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.log import RunLog
from rotctl.results.stored_runs import stored_runs
from rotctl.runs import checkpoint
from rotctl.runs.run import make, run

STEPS = 90


@pytest.fixture(autouse=True)
def _a_second_is_long(monkeypatch):
    monkeypatch.setattr(checkpoint, "LONG", 1.0)


def interrupt_after(steps):
    """Progress that raises, as Ctrl-C does."""
    count = itertools.count(1)

    def progress():
        if next(count) == steps:
            raise KeyboardInterrupt

    return progress


def interrupted(out, *overrides):
    with pytest.raises(KeyboardInterrupt):
        run(load(list(overrides)), out, progress=interrupt_after(STEPS + 1))
    return [path for path in out.rglob("*") if path.is_file()]


def test_its_beginning_is_a_log_of_its_own(tmp_path):
    (path,) = interrupted(tmp_path, "duration=3")
    log = RunLog.open(path)
    log.verify()
    whole = make(load(["duration=3"]))
    (tmp_path / "whole.h5").write_bytes(whole.log)
    truth = RunLog.open(tmp_path / "whole.h5")
    assert path.name == "interrupted.h5"
    assert log.steps == STEPS
    assert log.outcome["failure_reason"] == "interrupted at t = 1.50 s"
    assert not log.outcome["success"]
    for name in ("trajectory/qpos", "trajectory/ctrl", "contacts/force_realised"):
        assert np.array_equal(log[name], truth[name][:STEPS])


def test_it_counts_as_no_run_and_goes_when_the_run_is_done(tmp_path):
    (path,) = interrupted(tmp_path, "duration=2")
    with pytest.raises(InputError, match="no runs in it"):
        stored_runs(tmp_path)
    made = run(load(["duration=2"]), tmp_path)
    assert not made.already_there
    assert made.folder == path.parent
    assert not path.exists()


def test_who_names_its_folder_is_told_where_it_is(tmp_path, capsys):
    (path,) = interrupted(tmp_path, "duration=3")
    assert main(["inspect", str(path.parent)]) == 2
    said = f"{path.parent}: was interrupted and is no run; its beginning is {path}"
    assert capsys.readouterr().err == f"rotctl: {said}\n"
    assert main(["inspect", str(path)]) == 0


def test_a_short_run_leaves_nothing(tmp_path):
    with pytest.raises(KeyboardInterrupt):
        run(load(["duration=1"]), tmp_path, progress=interrupt_after(30))
    assert [*tmp_path.iterdir()] == []


def test_it_is_written_now_and_then(tmp_path, monkeypatch):
    """A kill cannot be caught: what it leaves was there before."""
    monkeypatch.setattr(checkpoint, "EVERY", 0.002)
    monkeypatch.setattr(checkpoint, "LEAST_WORK", 0.0)
    seen = []

    def progress():
        seen.extend(path.name for path in tmp_path.rglob("*.h5"))

    run(load(["duration=1.1"]), tmp_path, progress=progress)
    assert set(seen) == {"interrupted.h5"}
