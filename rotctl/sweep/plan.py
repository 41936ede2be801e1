"""What a sweep has to do: its runs by id, less those whose logs are there and whole."""

import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rotctl import caching
from rotctl.config.identity import identity, model_hash
from rotctl.config.schema import Config
from rotctl.errors import InputError, LogError
from rotctl.log import LOG_NAME, RunLog, collect
from rotctl.results import index
from rotctl.results.code import code_of, code_version
from rotctl.results.configs import config_of
from rotctl.results.index import INDEX_NAME, ORIGIN, Index, Row
from rotctl.runs.folder import has_all_beside, open_published, publish
from rotctl.runs.run import by_other_criteria, same_criteria
from rotctl.runs.scenario import model_from, model_parts
from rotctl.runs.summary import Summary
from rotctl.sweep.assignments import MOST_POINTS
from rotctl.sweep.keep import Keep, kept
from rotctl.sweep.points import Point


@dataclass(frozen=True)
class Planned:
    """A run of the sweep.

    Attributes:
        values: `behaviour`, `seed` and every overridden config key -> value.
    """

    run_id: str
    config: Config
    values: dict[str, Any]


@dataclass(frozen=True)
class Plan:
    """What is there and what is left.

    Attributes:
        done: run id -> summary of the runs that are there.
        left: the runs to do.
        wish: run id -> when its log is kept, of those.
        index: of the folder.
        unlisted: rows of logs that are there, and not in the index.
        notes: what is wrong in the folder though no run need be made again for it, one line each.
        replaced: why a log that was there has to be made again, one line each.
        other_code: code version -> how many runs of `done` it made, if it is not this code.
    """

    done: dict[str, Summary] = field(default_factory=dict)
    left: list[Planned] = field(default_factory=list)
    wish: dict[str, str] = field(default_factory=dict)
    index: Index = field(default_factory=Index)
    unlisted: list[Row] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    replaced: list[str] = field(default_factory=list)
    other_code: dict[str, int] = field(default_factory=dict)


def planned(points: Iterable[Point]) -> list[Planned]:
    """The runs of the points; points with the same config are one run.

    Raises:
        InputError: a point makes no model.
    """
    runs: dict[str, Planned] = {}
    # Hills are drawn and compiled once a seed.
    hashed = caching.kept(MOST_POINTS)(lambda *parts: model_hash(model_from(*parts)))
    for point in points:
        config = point.config
        name = identity(config, hashed(*model_parts(config)))
        always = {"behaviour": config.behaviour.name, "seed": config.seed}
        run = runs.setdefault(name, Planned(name, config, always | point.values))
        if run.config.criteria != config.criteria:
            raise InputError(
                f"{name}: two points differ in their criteria alone, which simulate nothing; sweep "
                "without them, then rotctl judge DIR criteria=..."
            )
    return list(runs.values())


def plan(
    runs: Sequence[Planned],
    folder: Path,
    strict: bool = False,
    progress: Callable[[], object] = lambda: None,
    keep: Keep = Keep(),  # noqa: B008 (frozen)
) -> Plan:
    """Compare the runs with what is in `folder`; a damaged log is set aside as `.corrupt`.

    Of a log that lies there as the index has it, nothing is read.

    Args:
        strict: do again what other code has made.
        progress: called after every run.
        keep: whose logs shall be there.

    Raises:
        InputError: a damaged log cannot be set aside, or the index cannot be read.
    """
    found, this_code = Plan(index=index.read(folder)), code_version(collect())
    if found.index.complaint:
        found.notes.append(f"{folder / INDEX_NAME}: {found.index.complaint}")
    wish = keep.of(run.run_id for run in runs)
    for run in runs:
        wanted = wish(run.run_id)
        row = _there(run, folder, wanted, found)
        code = code_of(row.origin) if row else ""
        if row and code != this_code and strict:
            found.replaced.append(f"{folder / run.run_id / LOG_NAME}: made by {code}")
            row = None
        if row is None:
            found.left.append(run)
            found.wish[run.run_id] = wanted
        else:
            found.done[run.run_id] = dict(row.outcome)
            if code != this_code:
                found.other_code[code] = found.other_code.get(code, 0) + 1
        progress()
    return found


def suffices(row: Row, wish: str) -> bool:
    """Whether a row without a log is all that is wanted of its run."""
    return row.log is None and not kept(wish, bool(row.outcome["success"]))


def _there(run: Planned, folder: Path, wish: str, found: Plan) -> Row | None:
    """The row of a run that is done; None if it is to be done, also for its log's sake.

    If it was judged by other criteria, it gets another verdict.
    """
    run_id = run.run_id
    path, row = folder / run_id / LOG_NAME, found.index.rows.get(run_id)
    lies = index.stamp(path)
    if row and not same_criteria(row.config, run.config):
        row = None
    if row and lies == row.log and (has_all_beside(path.parent) if lies else suffices(row, wish)):
        return row
    if not os.path.lexists(path):
        return None
    try:
        log, trajectory = open_published(path.parent, run_id)
        if not same_criteria(config_of(log.config_yaml), run.config):
            publish(by_other_criteria(log, run.config, trajectory), path.parent)
            log, lies = RunLog.open(path, linked=False), index.stamp(path)
        origin = {name: log.attributes[name] for name in ORIGIN}
        code_version(origin)
        config, wall = config_of(log.config_yaml), float(log.attributes["wall_time"])
        row = Row(run_id, config, log.outcome, origin, wall, trajectory, lies)
    except LogError as error:
        _set_aside(path)
        found.replaced.append(f"{error}; kept as {path.name}.corrupt")
        return None
    if index.fits(row):
        found.unlisted.append(row)
    return row


def _set_aside(path: Path) -> None:
    try:
        os.replace(path, f"{path}.corrupt")
    except OSError as error:
        raise InputError(f"cannot set {path} aside: {error.strerror}") from None
