"""Runs as one tidy table: a row a run, also where there is no result; config keys as columns."""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from rotctl.results.keys import name_of, value_at
from rotctl.results.stored_runs import DAMAGED, FAILED, MISSING, StoredRun, stored_runs

MOST = 200  # config keys, and as many metrics: a stranger's logs may differ in everything
MOST_SWEEPS = 20  # of a folder, each of other keys: a stranger's may be of as many as runs
_PARTS, _CRITERIA = "behaviour.parts", "criteria.parts"  # of a chain
# What no metric is called: other columns, and what `rotctl.results.groups` and the report add.
TAKEN = (
    *("run_id", "behaviour", "seed", "success", "failure_reason", "status", "code", "log"),
    *("n", "succeeded", "success_rate", "success_low", "success_high", "distinct", "no_result"),
    *("trajectory", "label"),
)


@dataclass(frozen=True)
class Table:
    """Runs as rows.

    Attributes:
        rows: `run_id`, `status`, the keys, the summary, `code`, `log` and `trajectory`.
        keys: the columns that are config keys: what was overridden, and what differs.
        metrics: the columns that were measured.
        notes: what a reader should know, one line each.
    """

    rows: pd.DataFrame
    keys: list[str]
    metrics: list[str]
    notes: list[str]


def table(folder: Path) -> Table:
    """All runs below a folder, in the order of their keys.

    Raises:
        InputError: there is no such folder, or no run in it.
    """
    return tabulated(*stored_runs(folder))


def tabulated(runs: Sequence[StoredRun], notes: list[str]) -> Table:
    """Runs that were found, in the order of their keys."""
    configs = {run.run_id: run.config for run in runs if run.config}
    keys = list(dict.fromkeys(["behaviour", *(k for run in runs for k in run.values), "seed"]))
    keys += [key for key in differing(configs.values()) if key not in keys]
    if len(keys) > MOST:
        notes = [*notes, f"the configs differ in {len(keys)} keys; {MOST} of them are columns"]
    keys = [*[key for key in keys if key != "seed"][: MOST - 1], "seed"]
    metrics = list(dict.fromkeys(k for run in runs for k in run.outcome if k not in TAKEN))[:MOST]
    columns = _columns(keys, metrics)
    rows = []
    for run in runs:
        data = configs.get(run.run_id)
        values = {k: value_at(data, k) if data else run.values.get(k) for k in keys}
        rows.append(
            {
                "run_id": run.run_id,
                "status": run.status,
                **{columns[key]: _cell(value) for key, value in values.items()},
                "success": run.outcome.get("success"),
                "failure_reason": run.outcome.get("failure_reason", run.reason),
                **{name: run.outcome.get(name) for name in metrics},
                "code": run.code,
                "log": run.log,
                "trajectory": run.trajectory,
            }
        )
    notes = notes + _fill(rows, runs, columns)
    rows.sort(key=lambda row: [_order(row[name]) for name in [*columns.values(), "run_id"]])
    return Table(pd.DataFrame(rows), list(columns.values()), metrics, notes + _missing(runs))


def _fill(
    rows: list[dict[str, Any]], runs: Sequence[StoredRun], columns: dict[str, str]
) -> list[str]:
    """Give rows without a config what all runs have of whom the sweep says the same but the seed.

    So a run that is not there is told beside those of its group, and makes none of its own.

    Returns:
        Notes on those of which that was not looked for.
    """
    known = [row for row, run in zip(rows, runs, strict=True) if run.config]
    lacking: dict[tuple[str, ...], list[dict[str, Any]]] = {}
    for row, run in zip(rows, runs, strict=True):
        if run.values and not run.config:
            told = tuple(columns[key] for key in run.values if key in columns and key != "seed")
            lacking.setdefault(told, []).append(row)
    for told in list(lacking)[:MOST_SWEEPS]:
        others = [name for name in columns.values() if name not in (*told, columns["seed"])]
        alike: dict[tuple[Any, ...], list[set[Any]]] = {}
        for row in known:
            each = alike.setdefault(tuple(row[name] for name in told), [set() for _ in others])
            for values, name in zip(each, others, strict=True):
                values.add(row[name])
        for row in lacking[told]:
            found = alike.get(tuple(row[name] for name in told), [])
            named = zip(others, found, strict=False)  # of none there is nothing
            row |= {name: next(iter(values)) for name, values in named if len(values) == 1}
    left = sum(len(lacking[told]) for told in list(lacking)[MOST_SWEEPS:])
    if not left:
        return []
    many = f"{left} runs without a result stand apart from their groups"
    if left == 1:
        many = "1 run without a result stands apart from its group"
    return [
        f"{many}: groups are looked up for runs of {MOST_SWEEPS} sweeps, and here are "
        f"{len(lacking)}"
    ]


def _columns(keys: Iterable[str], metrics: Iterable[str]) -> dict[str, str]:
    """Config keys to columns: `config.<key>` where something that is measured is called so."""
    columns: dict[str, str] = {}
    taken = {*metrics, *TAKEN} - {"behaviour", "seed"}
    for key in keys:
        column = key
        while column in taken:
            column = f"config.{column}"
        columns[key] = column
        taken.add(column)
    return columns


def _missing(runs: Iterable[StoredRun]) -> list[str]:
    notes = [
        f"{run.run_id}: {run.status}: {run.reason}"
        for run in runs
        if run.status in (FAILED, DAMAGED)
    ]
    count = sum(run.status == MISSING for run in runs)
    if count:
        many = f"{count} runs of the sweep are" if count > 1 else "1 run of the sweep is"
        notes.append(f"{many} not there; the same command does what is left")
    return notes


def differing(configs: Iterable[Mapping[str, Any]]) -> list[str]:
    """The keys in which configs differ; within a group, among those of the same choice."""
    distinct = list({id(config): config for config in configs}.values())
    keys: list[str] = []
    for part in dict.fromkeys(part for config in distinct for part in config):
        choices: dict[Any, list[Any]] = {}
        for config in distinct:
            value = config.get(part)
            name = _cell(value["name"]) if isinstance(value, dict) and "name" in value else None
            choices.setdefault(name, []).append(value)
        keys += [part] if len(choices) > 1 else []
        for same in choices.values():
            keys += _leaves_that_differ(part, same)
    brought = _brought(distinct) if _CRITERIA in keys else ()
    return [key for key in dict.fromkeys(keys) if key not in brought]


def _brought(configs: Iterable[Mapping[str, Any]]) -> tuple[str, ...]:
    """The criteria of a chain's parts, where they are no other than what the parts bring along."""
    each = {(id(c.get("behaviour")), id(c.get("criteria"))): c for c in configs}.values()
    pairs = {tuple(str(value_at(c, key)) for key in (_PARTS, _CRITERIA)) for c in each}
    return (_CRITERIA,) if len(pairs) == len({parts for parts, _ in pairs}) else ()


def _leaves_that_differ(key: str, values: list[Any]) -> list[str]:
    first = values[0]
    if all(value is first or value == first for value in values):
        return []
    if key not in (_PARTS, _CRITERIA) and _are_of_the_same_names(values):
        return [
            leaf
            for i in range(len(first))
            for leaf in _leaves_that_differ(f"{key}.{i}", [value[i] for value in values])
        ]
    alike: dict[str | None, list[Any]] = {}
    for value in values:
        if isinstance(value, dict):
            alike.setdefault(name_of(value), []).append(value)
    whole = len(alike) == 1 and all(isinstance(value, dict) for value in values)
    leaves = [
        leaf
        for same in alike.values()
        for part in dict.fromkeys(part for value in same for part in value)
        for leaf in _leaves_that_differ(f"{key}.{part}", [value.get(part) for value in same])
    ]
    return leaves if whole else [key, *leaves]


def _are_of_the_same_names(values: list[Any]) -> bool:
    """Whether they are lists of keys with values, such as stages, of the same names each."""
    if not all(isinstance(value, list | tuple) and value for value in values):
        return False
    named = [[name_of(one) for one in value] for value in values]
    return None not in named[0] and all(names == named[0] for names in named)


def _cell(value: Any) -> Any:
    return json.dumps(value) if isinstance(value, list | tuple | dict) else value


def _order(value: Any) -> tuple[int, Any]:
    """Numbers before text, and what is not there last; each in its own order."""
    if value is None:
        return 2, ""
    return (1, value) if isinstance(value, str) else (0, value)
