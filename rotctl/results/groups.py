"""Success rates with their uncertainty, and quartiles of the metrics, by group."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.metrics.measured import simulated
from rotctl.metrics.rates import wilson
from rotctl.results.stored_runs import DONE
from rotctl.results.table import Table
from rotctl.suggestion import instead

YES_OR_NO = ("recovered",)  # of many runs a share says more than a median
Name = tuple[object, ...]  # of a group: the values of its keys
QUARTILES = {"q25": 0.25, "median": 0.5, "q75": 0.75}


@dataclass(frozen=True)
class Groups:
    """Groups as rows.

    Attributes:
        rows: the keys, `n`, `succeeded`, `success_rate`, `success_low`, `success_high`,
            `distinct`, `no_result`, and `_q25`, `_median`, `_q75` of every metric; of one that is
            yes or no also `_rate`, the share of yes among the runs that have it; of one that only
            some runs with a result have also `_n`, how many.
        keys: the columns that name a group.
        metrics: those that were measured and are no words, such as the kind of the criteria.
        alike: of the metrics those that all runs with a result have, and with one value as shown.
        notes: what a reader should know, one line each.
    """

    rows: pd.DataFrame
    keys: list[str]
    metrics: list[str]
    alike: frozenset[str]
    notes: list[str]


def grouped(table: Table, by: Sequence[str] | None = None, mixed: bool = False) -> Groups:
    """Group the runs of a table.

    Args:
        by: columns; None: all config keys but the seed.
        mixed: average over runs of different code; otherwise `code` is one more key.

    Raises:
        InputError: there is no such column.
    """
    keys = list(by) if by is not None else [key for key in table.keys if key != "seed"]
    for i, key in enumerate(keys):
        if key in keys[:i]:
            raise InputError(f"--by: names {key!r} twice")
        if key not in table.rows.columns:
            raise InputError(f"--by: no column {key!r}; {instead(key, table.rows.columns)}")
    codes = sorted(set(table.rows["code"]) - {""})
    notes = []
    if len(codes) > 1:
        how = "averaged all the same" if mixed else "kept apart; --mixed averages over them"
        notes.append(f"made by {len(codes)} versions of the code, {how}: {'; '.join(codes)}")
        if not mixed and "code" not in keys:
            keys.append("code")
    metrics = [metric for metric in table.metrics if not _words(table.rows[metric])]
    done = (table.rows["status"] == DONE).to_numpy()
    numbers = {m: pd.to_numeric(table.rows[m], errors="coerce") for m in metrics}
    values = {m: column.to_numpy(dtype=float) for m, column in numbers.items()}
    rows: list[dict[str, Any]] = [
        dict(zip(keys, name, strict=True)) | measured
        for name, measured in _measured(table.rows, keys, done, values)
    ]
    alike = frozenset(metric for metric in metrics if _alike(values[metric][done]))
    n, apart = sum(row["n"] for row in rows), sum(row["distinct"] for row in rows)
    if apart < n:
        notes.append(
            f"{n} runs, {apart} distinct: the others are the same to the bit, and intervals count "
            "them once; seeds draw nothing there, of a recorded start they do with start.scatter"
        )
    return Groups(pd.DataFrame(rows), keys, metrics, alike, notes)


def _words(column: pd.Series) -> bool:
    """Whether no run has a number, and one has something else."""
    numbers = pd.to_numeric(column, errors="coerce").notna().any()
    return bool(column.notna().any() and not numbers)


def _alike(values: Array) -> bool:
    """Whether there are runs, all have a number, and a reader sees the same one of each."""
    return len(values) > 0 and shown(values.min()) == shown(values.max()) != shown(math.nan)


def _measured(
    made: pd.DataFrame, keys: list[str], done: NDArray[np.bool_], numbers: Mapping[str, Array]
) -> Iterator[tuple[Name, dict[str, Any]]]:
    """Keys of each group and how its runs did; read into arrays once, as groups may be many."""
    success = made["success"].eq(True).to_numpy()  # may be missing
    values = np.array(list(numbers.values())).T
    known = ~np.isnan(values[done]) if numbers else np.zeros((0, 0), dtype=bool)
    some = set(np.flatnonzero(known.any(axis=0) & ~known.all(axis=0)).tolist())
    same, _ = pd.factorize(simulated(made))
    for name, runs in _in_order(made, keys):
        with_result = runs[done[runs]]
        n, succeeded = len(with_result), int(success[with_result].sum())
        apart = len(np.unique(same[with_result]))
        low, high = wilson(succeeded, n, apart)
        row: dict[str, Any] = {
            "n": n,
            "succeeded": succeeded,
            "success_rate": succeeded / n if n else None,
            "success_low": low,
            "success_high": high,
            "distinct": apart,
            "no_result": len(runs) - n,
        }
        if numbers:
            for metric, found in zip(numbers, _quartiles(values[with_result]), strict=True):
                row |= {f"{metric}_{q}": x for q, x in zip(QUARTILES, found, strict=True)}
            for i, metric in enumerate(numbers):
                if i in some:
                    row[f"{metric}_n"] = int((~np.isnan(values[with_result, i])).sum())
                if metric in YES_OR_NO:
                    there = values[with_result, i]
                    there = there[~np.isnan(there)]
                    row[f"{metric}_rate"] = float(there.mean()) if len(there) else None
        yield name, row


def _in_order(rows: pd.DataFrame, keys: list[str]) -> Iterator[tuple[Name, NDArray[np.intp]]]:
    """Groups and which rows they are, in the order of the table, which is sorted.

    Runs without a value are a group too.
    """
    if not keys:
        yield (), np.arange(len(rows))
        return
    named = rows[keys].reset_index(drop=True)
    for name, group in named.groupby(keys, sort=False, dropna=False):
        yield name, group.index.to_numpy()


def _quartiles(values: Array) -> Array:
    """Of each column of values, of those that are there; NaN where there is none."""
    found = np.full((values.shape[1], len(QUARTILES)), np.nan)
    there = ~np.isnan(values)
    whole = there.all(axis=0) & (len(values) > 0)
    shares = list(QUARTILES.values())
    if whole.any():
        found[whole] = np.quantile(values[:, whole], shares, axis=0).T
    for i in np.flatnonzero(~whole & there.any(axis=0)):
        found[i] = np.quantile(values[there[:, i], i], shares)
    return found


def shown(value: float) -> str:
    """A number as a reader of a table sees it."""
    return "-" if math.isnan(value) else f"{value:.3g}"
