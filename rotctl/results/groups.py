"""Success rates with their uncertainty, and quartiles, by group; for people and for programs."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rotctl import files
from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.metrics import appearance, pace, peaks
from rotctl.metrics.claims import simulated
from rotctl.metrics.criteria import rolling
from rotctl.metrics.rates import wilson
from rotctl.results.stored_runs import DONE
from rotctl.results.table import Table
from rotctl.suggestion import instead

YES_OR_NO = ("recovered",)  # of many runs a share says more than a median
# Too many for a table that people read: files have them, and a failure names its own.
OF_ROLLS_IN_FILES_ONLY = (
    *rolling.OF_REVOLUTIONS,
    "setback",
    "height_least",
    "height_most",
    "lateral_rms",
    "penetration",
    "ground_force_p99",
    "ground_force_peak",
    "jerk",
    "chatter",
    "sticking",
)
IN_FILES_ONLY = {
    *OF_ROLLS_IN_FILES_ONLY,
    *(column.name for kind in (appearance, pace, peaks) for column in kind.COLUMNS),
}
Name = tuple[object, ...]  # of a group: the values of its keys
LONGEST = 80  # letters of a value in a table of the command line; files have all of it
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
    return len(values) > 0 and _shown(values.min()) == _shown(values.max()) != _shown(math.nan)


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


def markdown(groups: Groups) -> str:
    """The groups as a Markdown table: rates in percent, other metrics as median [quartiles].

    Keys but the first, and metrics, with one value throughout are told below it, to keep it narrow;
    of metrics that no run has nothing is.
    """
    missing = bool(groups.rows["no_result"].any())
    repeated = bool((groups.rows["distinct"] < groups.rows["n"]).any())
    rows: list[dict[Any, Any]] = groups.rows.to_dict("records")
    told = {m: [_spread(row, m) for row in rows] for m in groups.metrics if m not in IN_FILES_ONLY}
    spreads = {metric: texts for metric, texts in told.items() if set(texts) != {"-"}}
    varying = [metric for metric in spreads if metric not in groups.alike]
    named = {key: [_text(row[key], "g") for row in rows] for key in groups.keys}
    alike = {  # of a long value the text is its beginning
        key: named[key][0]
        for key in groups.keys[1:]
        if all(_text(row[key], "g", None) == _text(rows[0][key], "g", None) for row in rows)
    }
    keys = [key for key in groups.keys if key not in alike]
    counts = {"n": "n"} | ({"distinct": "distinct"} if repeated else {})
    counts |= {"no_result": "no result"} if missing else {}
    lines = [[*keys, *counts.values(), "success [95 %]", *varying]]
    for i, row in enumerate(rows):
        lines.append(
            [
                *(named[key][i] for key in keys),
                *(str(row[count]) for count in counts),
                _rate(row),
                *(spreads[metric][i] for metric in varying),
            ]
        )
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    lines.insert(1, ["-" * width for width in widths])
    table = [
        "| " + " | ".join(f"{c:{w}}" for c, w in zip(line, widths, strict=True)) + " |"
        for line in lines
    ]
    shared = {m: next(text for text in spreads[m] if text != "-") for m in spreads}
    alike |= {metric: text for metric, text in shared.items() if metric in groups.alike}
    same = [
        f"{name} {text}"
        for name, text in alike.items()
        if not name.startswith("config.") or alike.get(name.removeprefix("config.")) != text
    ]
    return "\n".join(table + ([f"\nThe same in all runs: {', '.join(same)}."] if same else []))


def _rate(row: Mapping[str, Any]) -> str:
    rate = f"{100 * row['success_rate']:.0f} %" if row["n"] else "-"
    return f"{rate} [{100 * row['success_low']:.0f}, {100 * row['success_high']:.0f}]"


def _spread(row: Mapping[str, Any], metric: str) -> str:
    """Median and quartiles, or the share of yes; of how many runs, where others lack it."""
    if f"{metric}_rate" in row:
        rate = row[f"{metric}_rate"]
        told = "-" if rate is None or rate != rate else f"{100 * rate:.0f} %"
    else:
        low, middle, high = (_shown(row[f"{metric}_{name}"]) for name in QUARTILES)
        told = middle if low == middle == high else f"{middle} [{low}, {high}]"
    of = row.get(f"{metric}_n", row["n"])
    return told if of in (0, row["n"]) else f"{told} of {of}"


def _shown(value: float) -> str:
    return _text(value, ".3g")


def _text(value: Any, form: str, longest: int | None = LONGEST) -> str:
    if value is None or value != value:
        return "-"
    text = format(value, form) if isinstance(value, float) else str(value)
    if longest is not None and len(text) > longest:
        text = f"{text[: longest - 3]}..."
    return text.replace("|", "\\|").replace("\n", " ")


def written(folder: Path, runs: pd.DataFrame, groups: pd.DataFrame) -> list[Path]:
    """Write `summary.csv`, `groups.csv`, and `summary.parquet` where pyarrow is installed.

    Raises:
        InputError: one of them cannot be written.
    """
    paths = [folder / "summary.csv", folder / "groups.csv"]
    files.replace(paths[0], files.encoded(runs.to_csv(index=False)))
    files.replace(paths[1], files.encoded(groups.to_csv(index=False)))
    if find_spec("pyarrow"):
        paths.append(folder / "summary.parquet")
        files.replace(paths[2], runs.to_parquet(index=False))
    return paths
