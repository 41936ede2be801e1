"""Runs on a line each, and a summary in words."""

import os
from dataclasses import replace
from datetime import datetime

import pytest

from rotctl.cli.run_wording import readable
from rotctl.results.lines import LONGEST, MOST, lines
from rotctl.results.stored_runs import DONE, StoredRun

OUTCOME = {"behaviour": "stand", "seed": 3, "duration": 5.0, "success": True, "failure_reason": ""}
RUN = StoredRun("a" * 12, DONE, outcome=OUTCOME, values={"behaviour": "stand", "seed": 3})


def told(run, folder, *others):
    """The line of the first of these runs, by its columns."""
    return lines([run, *others], folder)[0].split("  ")


def test_a_success_says_so(tmp_path):
    assert told(RUN, tmp_path) == ["a" * 12, "stand", "seed 3", "5.0 s", "success"]


def test_a_failure_says_why_on_one_line(tmp_path):
    fell = RUN.outcome | {"success": False, "failure_reason": "sank to 0.30\n of its height"}
    assert told(replace(RUN, outcome=fell), tmp_path)[-1] == "sank to 0.30 of its height"


def test_what_has_no_result_says_what_the_sweep_knows(tmp_path):
    run = replace(RUN, status="failed to run", reason="no such clip", outcome={})
    assert told(run, tmp_path)[1:] == ["stand", "seed 3", "-", "failed to run: no such clip"]


def test_a_log_that_is_gone_has_no_time(tmp_path):
    (tmp_path / "run.h5").touch()
    written = datetime(2026, 3, 4, 5, 6).timestamp()
    os.utime(tmp_path / "run.h5", (written, written))
    there, gone = (told(replace(RUN, log=log), tmp_path) for log in ("run.h5", "gone.h5"))
    assert there == ["a" * 12, "2026-03-04 05:06", *gone[1:]]


def test_values_that_set_runs_apart_are_told(tmp_path):
    long, most = "x" * (LONGEST + 1), {f"key_{i}": i for i in range(MOST + 1)}
    one = replace(RUN, values={"plant.mass": 0.1, "text": long, "parts": {"a": 1, "b": 2}})
    cut = f"{long[: LONGEST - 3]}..."
    assert told(one, tmp_path)[4] == f"plant.mass=0.1 text={cut} parts={{a, b}}"
    assert told(replace(RUN, values=most), tmp_path)[4] == (
        " ".join(f"{key}={i}" for key, i in list(most.items())[:MOST]) + " ..."
    )
    assert told(RUN, tmp_path, one)[4].strip() == "", "keys that this run has not"


@pytest.mark.parametrize(
    ("value", "shown"),
    [(10873.4, "10873 N"), (1000.0, "1000 N"), (999.6, "1000 N"), (7.25, "7.25 N")],
)
def test_thousands_are_told_in_whole_numbers(value, shown):
    summary = OUTCOME | {"criteria": "handspring", "bears_most": value, "solver_failures": 0}
    assert readable(summary).splitlines()[1].endswith(f"  {shown}")
