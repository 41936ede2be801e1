"""The groups of a sweep as a grid: which keys tell them apart, and which of those are axes."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from rotctl.report.site.words import OFTEN, values
from rotctl.results.group_table import IN_FILES_ONLY
from rotctl.results.groups import Groups, grouped
from rotctl.results.table import Table

FEWEST = 3  # different numbers that make an axis


@dataclass(frozen=True)
class Grid:
    """Groups of runs.

    Attributes:
        groups: one a row, as `rotctl.results.groups` measures them, with its `label`.
        runs: the table's rows with the `label` of their group.
        axes: keys with numbers, in the order of the sweep.
        others: the keys that tell groups apart beside the axes.
        metrics: that were measured: those that all motions share, and what `summarise` prints.
        notes: what a reader should know of the groups, one line each.
    """

    groups: pd.DataFrame
    runs: pd.DataFrame
    axes: list[str]
    others: list[str]
    metrics: list[str]
    notes: list[str]


def grid(table: Table) -> Grid:
    """The groups of a table: what differs but the seed."""
    found = grouped(table)
    keys = telling(found)
    groups = found.rows.assign(label=labels(found.rows, keys))
    seeds = pd.to_numeric(table.rows["seed"], errors="coerce")  # a stranger's may be words
    runs = table.rows.assign(label=labels(table.rows, keys), seed=seeds)
    axes = [key for key in keys if _is_axis(groups[key])]
    others = [key for key in keys if key not in axes]
    return Grid(groups, runs, axes, others, _of_interest(found), found.notes)


def _of_interest(found: Groups) -> list[str]:
    """Metrics of a page: the usual ones, then those of this kind of motion, in a run at least."""
    there = [m for m in found.metrics if found.rows[f"{m}_median"].notna().any()]
    usual = [metric for metric in OFTEN if metric in there]
    return usual + [m for m in there if m not in (*usual, *IN_FILES_ONLY)]


def telling(found: Groups) -> list[str]:
    """As few keys as tell the groups apart: of keys that change together the first."""
    keys = [key for key in found.keys if found.rows[key].nunique(dropna=False) > 1]
    for key in reversed(keys.copy()):
        fewer = [other for other in keys if other != key]
        if fewer and not found.rows.duplicated(fewer).any():
            keys = fewer
    return keys


def labels(rows: pd.DataFrame, keys: Sequence[str]) -> list[str]:
    """What each row is called by these keys."""
    records: list[dict[Any, Any]] = rows[list(keys)].to_dict("records")
    return [values(record) for record in records] if keys else ["all runs"] * len(rows)


def _is_axis(column: pd.Series) -> bool:
    known = column.dropna().unique().tolist()
    return len(known) >= FEWEST and all(
        isinstance(value, int | float) and not isinstance(value, bool) for value in known
    )
