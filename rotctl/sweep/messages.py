"""What a sweep says before and after: what there is to do, what was found, what failed."""

import json
import os
import shlex
import time
from dataclasses import replace
from pathlib import Path

from rotctl.amounts import count
from rotctl.config.schema import Config
from rotctl.errors import InputError
from rotctl.log import LOG_NAME
from rotctl.results import index
from rotctl.runs.run import make
from rotctl.sweep.keep import NEVER, Keep
from rotctl.sweep.launch import Tally
from rotctl.sweep.plan import Plan, Planned, suffices
from rotctl.sweep.progress import duration

FEW = 5  # runs of a dry run that are listed
TRIAL = 2.0  # [s] of simulated time, to estimate the whole


def without_running(
    runs: list[Planned], folder: Path, workers: int, keep: Keep, points: int
) -> str:
    """What there is to do, with estimates of time and disk from a short trial of the first run.

    Args:
        points: of the grid.

    Raises:
        InputError: the first run cannot be simulated.
    """
    listed, wish = index.read(folder).rows, keep.of(run.run_id for run in runs)
    left = [
        run
        for run in runs
        if not os.path.lexists(folder / run.run_id / LOG_NAME)
        and (run.run_id not in listed or not suffices(listed[run.run_id], wish(run.run_id)))
    ]
    lines = _fewer(points, len(runs))
    lines.append(f"{count(len(runs), 'run')}, {len(left)} of them not yet in {folder}")
    lines += [f"  {run.run_id}  {_values(run)}" for run in left[:FEW]]
    if len(left) > FEW:
        lines.append(f"  ... and {len(left) - FEW} more")
    if left:
        cost, log, lasted = _trial(left[0].config)
        seconds = cost * sum(run.config.duration for run in left) / max(1, workers)
        on = count(max(1, workers), "worker")
        lines.append(f"about {duration(seconds)} on {on}, if they are as fast as this machine")
        stored = sum(run.config.duration for run in left if wish(run.run_id) != NEVER)
        most = "up to " if keep.mode == "failures" else ""
        size = _size(log / lasted * stored)
        told = f"{most}about {size} of logs, if all are as the first"
        lines.append(told if stored else "no logs are kept")
    return "\n".join(lines)


def _trial(config: Config) -> tuple[float, int, float]:
    """What a run costs: time [s/s], the bytes of a log and the simulated time that it is of [s].

    From its beginning; from all of it where its beginning alone is refused, as a push comes later.
    """
    rate = config.controller.rate
    short = replace(config, duration=min(config.duration, round(TRIAL * rate) / rate))
    begin = time.perf_counter()
    try:
        tried, log = short, make(short).log
    except InputError:
        begin = time.perf_counter()
        tried, log = config, make(config).log
    return (time.perf_counter() - begin) / tried.duration, len(log), tried.duration


def _size(size: float) -> str:
    """Bytes for people."""
    return f"{size / 1e9:.1f} GB" if size >= 1e9 else f"{max(1.0, size / 1e6):.0f} MB"


def at_the_start(
    plan: Plan, folder: Path, where: str, points: int, runs: int, others: int = 0
) -> str:
    """What was found in the folder, and what will be done where.

    Args:
        points: of the grid; runs: that they are.
        others: runs of other sweeps there, where claims are to be judged.
    """
    lines = [*plan.notes, *(f"simulated again: {reason}" for reason in plan.replaced)]
    lines += _fewer(points, runs)
    for code, n in plan.other_code.items():
        were, them = ("was", "it") if n == 1 else ("were", "them")
        lines.append(f"{n} of the runs there {were} made by {code}; --strict redoes {them}")
    if others:
        are = "is" if others == 1 else "are"
        lines.append(
            f"{count(others, 'run')} of other sweeps {are} in {folder}: the claims are judged over "
            "all that they are about, there too; --out DIR keeps them apart"
        )
    are = "is" if len(plan.done) == 1 else "are"
    there = f", {len(plan.done)} {are} there already" if plan.done else ""
    lines.append(f"{count(len(plan.left), 'run')} to do in {folder}{there}; on {where}")
    return "\n".join(lines)


def _fewer(points: int, runs: int) -> list[str]:
    """A line on points of a grid that are fewer runs; none if they are as many."""
    why = "some are the same, or set a key that a later one sets again"
    return [f"{points} points are {count(runs, 'run')}: {why}"] if points > runs else []


def at_the_end(tally: Tally, plan: Plan, folder: Path) -> str:
    """The result in a line, and where to look next."""
    were = "was" if len(plan.done) == 1 else "were"
    before = f", {len(plan.done)} of them {were} there before" if plan.done else ""
    return (
        f"{count(tally.count, 'run')}: {tally.succeeded} succeeded, {tally.fell} did not, "
        f"{len(tally.broken)} failed to run{before}\n"
        f"next       rotctl summarise {shlex.quote(str(folder))}"
    )


def failures(tally: Tally, runs: list[Planned]) -> str:
    """All runs without a result and why, one a line, in the order of the sweep."""
    listed = [run for run in runs if run.run_id in tally.broken]
    lines = [f"  {run.run_id}  {_values(run)}: {tally.broken[run.run_id]}" for run in listed]
    return "\n".join([f"{count(len(listed), 'run')} failed to run:", *lines])


def _values(run: Planned) -> str:
    return " ".join(
        f"{key}={value if isinstance(value, str) else json.dumps(value)}"
        for key, value in run.values.items()
    )
