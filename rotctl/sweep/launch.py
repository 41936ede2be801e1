"""A sweep: do what is left of a folder's runs, and put each there as soon as it is done.

Workers hand a run's bytes back, and the driver alone writes: the workers need no shared file
system, and what an orphan of a killed driver still finishes cannot be published twice.
"""

import json
from collections.abc import Callable, Iterable, Mapping
from contextlib import closing, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rotctl.errors import InputError
from rotctl.log import LOG_NAME
from rotctl.results import manifest
from rotctl.results.index import ORIGIN, Row, stamp
from rotctl.results.index_writer import Writer
from rotctl.results.manifest import Entry
from rotctl.runs.folder import EncodedRun, publish
from rotctl.runs.summary import Summary, broke_down
from rotctl.settings.writing import to_dict
from rotctl.sweep import groups
from rotctl.sweep.engines import Engine, Failure
from rotctl.sweep.plan import Plan, Planned
from rotctl.sweep.task import ordered


@dataclass(frozen=True)
class Tally:
    """How far a sweep is.

    Attributes:
        succeeded: rolls that met their criteria.
        fell: rolls that did not: a result, not an error.
        broken: run id -> why there is no result: it could not be run, or the physics broke down.
    """

    succeeded: int
    fell: int
    broken: dict[str, str]

    @property
    def count(self) -> int:
        """All of them."""
        return self.succeeded + self.fell + len(self.broken)

    def plus(self, run_id: str, result: Summary | Failure) -> "Tally":
        """The tally after one more result."""
        if isinstance(result, Failure):
            return replace(self, broken={**self.broken, run_id: result.reason})
        if broke_down(result):
            reason = result["failure_reason"] or f"{result['solver_failures']} solver failures"
            return replace(self, broken={**self.broken, run_id: reason})
        if result["success"]:
            return replace(self, succeeded=self.succeeded + 1)
        return replace(self, fell=self.fell + 1)


def tally(results: Iterable[tuple[str, Summary | Failure]]) -> Tally:
    """Count results."""
    counted = Tally(0, 0, {})
    for run_id, result in results:
        counted = counted.plus(run_id, result)
    return counted


def launch(
    plan: Plan,
    runs: list[Planned],
    folder: Path,
    engine: Engine,
    retries: int,
    progress: Callable[[Tally], object] = lambda so_far: None,
) -> Tally:
    """Do what is left; the caller holds the folder's lock.

    Args:
        runs: all of the sweep, done or not.
        retries: further tries for a run whose worker died.
        progress: called at the start and after every run.

    Raises:
        InputError: the folder cannot be written: the disk is full, say.
        RotctlError: the engine is lost.
    """
    so_far = tally(plan.done.items())
    entries = manifest.read(folder)
    for run in runs:
        earlier = entries[run.run_id].values if run.run_id in entries else {}
        entries[run.run_id] = Entry(run.run_id, {**earlier, **run.values})
    manifest.write(folder, entries.values())
    progress(so_far)
    orders = [ordered(run.config, plan.wish[run.run_id]) for run in plan.left]
    rows = Writer(folder, plan.index)
    try:
        for row in plan.unlisted:
            rows.add(row)
        durations = [run.config.duration for run in plan.left]
        with closing(groups.results(engine, orders, durations, retries)) as results:
            for index, result in results:
                run = plan.left[index]
                if isinstance(result, Failure):
                    entries[run.run_id] = replace(entries[run.run_id], failure=result.reason)
                    so_far = so_far.plus(run.run_id, result)
                else:
                    _put(result, run, folder, rows)
                    so_far = so_far.plus(run.run_id, result.summary)
                progress(so_far)
    except BaseException:
        with suppress(InputError):  # the first trouble is the one to tell
            manifest.write(folder, entries.values())
        raise
    finally:
        rows.close()
    manifest.write(folder, entries.values())
    return so_far


def _put(made: EncodedRun, run: Planned, folder: Path, rows: Writer) -> None:
    """First its log, if it is kept, then its row: a row never speaks of a log that is not there."""
    place = folder / run.run_id
    if made.log:
        publish(made, place)
    there = stamp(place / LOG_NAME) if made.log else None
    origin = {name: _text(made.origin[name]) for name in ORIGIN}
    rows.add(
        Row(
            run.run_id,
            to_dict(run.config),
            made.summary,
            origin,
            made.wall_time,
            made.trajectory,
            there,
        )
    )


def _text(value: Any) -> Any:
    """As a log's attributes have it."""
    return json.dumps(value) if isinstance(value, Mapping) else value
