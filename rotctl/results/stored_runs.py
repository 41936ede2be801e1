"""The runs below a folder, one by one: those with a log, and those that should have one.

Only the root attributes of a log are read, not its trajectory: a millisecond or two a run.
"""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from rotctl.errors import InputError, LogError
from rotctl.log import LOG_NAME, read_attributes
from rotctl.log.outcome import outcome_of, require_verdict
from rotctl.results import index
from rotctl.results.code import code_of, code_version
from rotctl.results.configs import config_of
from rotctl.results.index import INDEX_NAME, Row
from rotctl.results.manifest import MANIFEST_NAME, Entry, read

ORIGIN = ("machine", "versions", "git_commit", "git_dirty", "wall_time")
DONE, FAILED, MISSING, DAMAGED = "done", "failed to run", "not run", "damaged"


@dataclass(frozen=True)
class StoredRun:
    """A run below the folder, or the place of one.

    Attributes:
        status: `done`, `failed to run`, `not run` or `damaged`.
        reason: why there is no result, if that is known.
        outcome: the summary row; empty if there is no result.
        code: the code that made it.
        log: its log, relative to the folder; empty if it was not kept.
        config: its config; empty if there is no result.
        values: what the sweep says of its config, if a sweep made it.
        trajectory: SHA-256 of what was simulated; empty where no index has it.
        origin: the log's `machine`, `versions`, `git_commit`, `git_dirty` and `wall_time`.
    """

    run_id: str
    status: str
    reason: str = ""
    outcome: Mapping[str, Any] = field(default_factory=dict)
    code: str = ""
    log: str = ""
    config: Mapping[str, Any] = field(default_factory=dict)
    values: Mapping[str, Any] = field(default_factory=dict)
    trajectory: str = ""
    origin: Mapping[str, Any] = field(default_factory=dict)


def stored_runs(folder: Path) -> tuple[list[StoredRun], list[str]]:
    """All runs below a folder, each once, and the logs that were left out as copies.

    Raises:
        InputError: there is no such folder, no run in it, or a `sweep.jsonl` that is none.
    """
    if not os.path.isdir(folder):
        raise InputError(f"{folder}: no such folder")
    places, gone, notes = _places(folder)
    entries: dict[str, Entry] = {}
    runs: dict[str, StoredRun] = {}
    copies = []
    for path, row in sorted(places, key=lambda place: place[0]):
        if path.endswith(MANIFEST_NAME):
            entries |= read(Path(path).parent)
            continue
        log = os.path.relpath(path, folder)
        run = _indexed(row, log if row.log else "") if row else _logged(Path(path), log)
        if run.run_id in runs and runs[run.run_id].status == DONE:
            first = runs[run.run_id].log or "a row"
            copies.append(f"{path}: is the run of {first} again, counted once")
        else:
            runs[run.run_id] = run
    missing = [_unlogged(entry) for name, entry in entries.items() if name not in runs]
    for at, names in gone.items():
        lost = names - runs.keys() - entries.keys()  # what a sweep.jsonl lists is told as not run
        if lost:
            notes.append(f"{at}: {len(lost)} of its runs had logs that are not there, left out")
    if not runs and not missing:
        why = f": {'; '.join(notes)}" if notes else f"; rotctl sweep --out {folder} makes some"
        raise InputError(f"{folder}: no runs in it{why}")
    known = [_with_values(run, entries) for run in runs.values()]
    return known + missing, notes + copies


def _places(
    folder: Path,
) -> tuple[list[tuple[str, Row | None]], dict[str, set[str]], list[str]]:
    """Where logs and manifests lie below a folder, with the rows of indices.

    An index is believed of a log that nobody has touched since, and where none was kept.

    Returns:
        Places with rows; by index the runs whose logs were kept and are not there; and notes.
    """
    places: list[tuple[str, Row | None]] = []
    gone: dict[str, set[str]] = {}
    notes = []
    for at, inside, names in os.walk(folder):
        places += [(f"{at}/{name}", None) for name in names if name in (LOG_NAME, MANIFEST_NAME)]
        if INDEX_NAME not in names:
            continue
        listed, there = index.read(Path(at)), set(inside)
        if listed.complaint:
            notes.append(f"{at}/{INDEX_NAME}: {listed.complaint}")
        for row in listed.rows.values():
            log = f"{at}/{row.run_id}/{LOG_NAME}"
            found = index.stamp(log) if row.run_id in there else None
            if found == row.log:
                there.discard(row.run_id)
                places.append((log, row))
            elif found is None:
                gone.setdefault(f"{at}/{INDEX_NAME}", set()).add(row.run_id)
        inside[:] = there
    return places, gone, notes


def _indexed(row: Row, log: str) -> StoredRun:
    return StoredRun(
        row.run_id,
        DONE,
        outcome=row.outcome,
        code=code_of(row.origin),
        log=log,
        config=row.config,
        trajectory=row.trajectory,
        origin={**row.origin, "wall_time": row.wall_time},
    )


def _logged(path: Path, log: str) -> StoredRun:
    try:
        attributes = read_attributes(path, linked=False)
        outcome = outcome_of(str(attributes["outcome"]))
        require_verdict(outcome)
        return StoredRun(
            str(attributes["run_id"]),
            DONE,
            outcome=outcome,
            code=code_version(attributes),
            log=log,
            config=config_of(str(attributes["config"])),
            origin={name: attributes[name] for name in ORIGIN},
        )
    except LogError as error:
        return StoredRun(path.parent.name, DAMAGED, str(error).removeprefix(f"{path}: "), log=log)


def _unlogged(entry: Entry) -> StoredRun:
    status = FAILED if entry.failure else MISSING
    return StoredRun(entry.run_id, status, entry.failure, values=entry.values)


def _with_values(run: StoredRun, entries: Mapping[str, Entry]) -> StoredRun:
    entry = entries.get(run.run_id)
    return replace(run, values=entry.values) if entry else run
