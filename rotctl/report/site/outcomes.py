"""Charts of runs one by one; every function draws into the figure that it is given."""

from typing import Any

import numpy as np
import pandas as pd

from rotctl.amounts import count
from rotctl.report.axes import BLUE, GREEN, ORANGE
from rotctl.report.site.panels import Paper
from rotctl.report.site.words import kind
from rotctl.results.stored_runs import DONE

# Blue is for success.
COLOURS = (ORANGE, "#e69f00", "#cc79a7", GREEN, "#8a929c", "#b8860b", "#6a3d9a")
MOST_KINDS = len(COLOURS)  # of failure; the rest is one
LETTERS = 150  # on a line of the legend


def starts(figure: Any, runs: pd.DataFrame, named: bool, paper: Paper) -> None:
    """A cell a run: groups down, seeds across."""
    from matplotlib.colors import ListedColormap

    cells = [float(success) if pd.notna(success) else np.nan for success in runs["success"]]
    table = runs.assign(cell=cells).pivot_table(
        index="label", columns="seed", values="cell", aggfunc="min", dropna=False
    )
    table = table.reindex(
        index=runs["label"].drop_duplicates(), columns=sorted(runs["seed"].dropna().unique())
    )
    axes = figure.subplots()
    axes.pcolormesh(
        np.asarray(table, dtype=float), cmap=ListedColormap([ORANGE, BLUE]), vmin=0.0, vmax=1.0,
        edgecolor=paper.paper, linewidth=0.6, rasterized=table.size > 400,
    )  # fmt: skip
    across = np.unique(np.linspace(0, len(table.columns) - 1, 12).round().astype(int))
    axes.set_xticks(across + 0.5, [f"{table.columns[i]:g}" for i in across])
    axes.set_yticks(np.arange(len(table)) + 0.5 if named else [], table.index if named else [])
    axes.invert_yaxis()
    axes.grid(visible=False)
    axes.set_xlabel("seed")


def failures_of(runs: pd.DataFrame) -> pd.DataFrame:
    """How many runs have no success: a row a group, a column a kind of failure, most first."""
    succeeded = [pd.notna(success) and bool(success) for success in runs["success"]]
    failed = runs[~np.array(succeeded, dtype=bool)]
    kinds = [
        kind(str(reason)) if status == DONE else status
        for reason, status in zip(failed["failure_reason"], failed["status"], strict=True)
    ]
    table = pd.crosstab(failed["label"], pd.Series(kinds, failed.index, dtype=object))
    order = table.sum().sort_values(ascending=False, kind="stable").index
    return table[order].reindex(runs["label"].drop_duplicates(), fill_value=0)


def _shown(table: pd.DataFrame) -> pd.DataFrame:
    """The kinds of failure that have a colour."""
    if len(table.columns) <= MOST_KINDS:
        return table
    rest = table.iloc[:, MOST_KINDS - 1 :].sum(axis=1)
    return table.iloc[:, : MOST_KINDS - 1].assign(other=rest)


def _abreast(table: pd.DataFrame) -> int:
    """How many kinds of failure stand beside each other in the legend, which are sentences."""
    return max(1, min(4, LETTERS // max(len(reason) + 8 for reason in table.columns)))


def lines_of_legend(runs: pd.DataFrame) -> int:
    """How many lines the legend of `failures` takes."""
    table = _shown(failures_of(runs))
    return -(-len(table.columns) // _abreast(table))


def failures(figure: Any, runs: pd.DataFrame) -> None:
    """Bars by group, in pieces by kind of failure."""
    table = _shown(failures_of(runs))
    axes = figure.subplots()
    begin = np.zeros(len(table))
    for reason, colour in zip(table.columns, COLOURS, strict=False):
        axes.barh(np.arange(len(table)), table[reason], left=begin, color=colour, label=reason)
        begin += table[reason].to_numpy()
    axes.set_yticks(np.arange(len(table)), table.index.tolist())
    axes.set_ylim(len(table) - 0.5, -0.5)
    axes.set_xlim(0, max(1.0, 1.02 * begin.max()))
    axes.xaxis.get_major_locator().set_params(integer=True)
    axes.set_xlabel("runs")
    axes.grid(visible=False, axis="y")
    figure.legend(
        *axes.get_legend_handles_labels(), loc="outside upper left", ncols=_abreast(table)
    )


def said_of_failures(runs: pd.DataFrame) -> str:
    """How many runs failed for which reason."""
    total = failures_of(runs).sum()
    return "; ".join(f"{reason}: {count(int(n), 'run')}" for reason, n in total.items())
