"""Charts of groups; every function draws into the figure that it is given."""

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import fill
from typing import Any

import numpy as np
import pandas as pd

from rotctl.metrics.criteria.kinds import COLUMNS
from rotctl.report.axes import BLUE, GREEN, ORANGE
from rotctl.report.rows import LARGEST
from rotctl.report.site.grid import Grid, labels
from rotctl.report.site.words import quantity, with_unit

METRICS = ("angular_velocity_mean", "speed_mean", "longest_stall")  # of a roll
_COMMANDED = {
    "angular_velocity_mean": "angular_velocity_commanded",
    "speed_mean": "speed_commanded",
}
_HEADINGS = {"angular_velocity_mean": "In-plane [rev/s]", "speed_mean": "Speed [m/s]"}
_COLOURS = (BLUE, ORANGE, GREEN, "#cc79a7", "#e69f00", "#56b4e9", "#8a929c", "#b8860b")
_RATE = "Success rate [%]"
LETTERS = 20  # on a line above a panel
LEAST = 1e-12  # in any unit; what is smaller is 0


@dataclass(frozen=True)
class Paper:
    """The colours of what is no data."""

    paper: str
    ink: str
    soft: str
    grid: str


# ---------------------------------------------------------------- groups, one below the other


def drawn(found: Grid) -> list[str]:
    """The metrics that are drawn: a roll's, or the first that differ of another motion's."""
    rolls = [metric for metric in METRICS if metric in found.metrics]
    own = [
        metric
        for metric in COLUMNS
        if metric in found.metrics and found.groups[f"{metric}_median"].nunique() > 1
    ]
    return rolls or own[: len(METRICS)]


def groups(figure: Any, rows: pd.DataFrame, shown: Sequence[str]) -> None:
    """Rates and medians of each group, with what was commanded."""
    ratios = [1.5, *([1.0] * len(shown))]
    first, *rest = _row_of_axes(figure, 1 + len(shown), sharey=True, width_ratios=ratios)
    places = np.arange(len(rows))
    _dots(first, rows, "success", places, BLUE, scale=100.0)
    first.set_xlim(-3, 103)
    first.set_title(_RATE)
    first.set_yticks(places, rows["label"].tolist())
    first.set_ylim(len(rows) - 0.5, -0.5)
    for axes, metric in zip(rest, shown, strict=True):
        _dots(axes, rows, metric, places, BLUE)
        wanted = _numbers(rows, f"{_COMMANDED.get(metric)}_median")
        if np.isfinite(wanted).any():
            axes.plot(
                wanted, places, ls="", marker="|", ms=11, mew=1.6, color=ORANGE, label="commanded"
            )
        axes.set_title(_heading(metric))
    if any(axes.get_legend_handles_labels()[1] for axes in rest):
        handles, words = rest[0].get_legend_handles_labels()
        figure.legend(handles, words, loc="outside lower right")


def _dots(
    axes: Any, rows: pd.DataFrame, metric: str, places: Any, colour: str, scale: float = 1.0
) -> None:
    low, middle, high = (scale * values for values in _band(rows, metric))
    axes.hlines(places, low, high, color=colour, lw=2.2, alpha=0.45)
    axes.plot(middle, places, ls="", marker="o", ms=5, color=colour)


def said_of_groups(rows: pd.DataFrame) -> str:
    """The best and the worst success rate in words."""
    known = rows[rows["n"] > 0]
    if known.empty:
        return "No run has a result."
    order = known.sort_values("success_rate", kind="stable")
    low, high = order.iloc[0], order.iloc[-1]
    if len(known) == 1:
        return f"Success rate {100 * low['success_rate']:.0f} % ({low['label']})."
    return (
        f"Success rates from {100 * low['success_rate']:.0f} % ({low['label']}) "
        f"to {100 * high['success_rate']:.0f} % ({high['label']})."
    )


# ---------------------------------------------------------------- over one axis, over two


def lines(rows: pd.DataFrame, keys: Sequence[str]) -> dict[str, pd.DataFrame]:
    """The groups by what `keys` call them, in their order."""
    names = labels(rows, keys)
    return {name: rows[[each == name for each in names]] for name in dict.fromkeys(names)}


def curves(figure: Any, found: dict[str, pd.DataFrame], key: str, shown: Sequence[str]) -> None:
    """Rates and medians over a key, with their intervals as bands."""
    all_axes = _row_of_axes(figure, 1 + len(shown))
    for axes, metric in zip(all_axes, ["success", *shown], strict=True):
        scale = 100.0 if metric == "success" else 1.0
        for (name, rows), colour in zip(found.items(), _COLOURS, strict=False):
            ordered = rows.sort_values(key, kind="stable")
            low, middle, high = (scale * values for values in _band(ordered, metric))
            axes.fill_between(_numbers(ordered, key), low, high, color=colour, alpha=0.18, lw=0)
            axes.plot(_numbers(ordered, key), middle, "o-", color=colour, ms=4, lw=1.5, label=name)
        axes.set_title(_RATE if metric == "success" else _heading(metric))
        axes.set_xlabel(key)
    all_axes[0].set_ylim(-4, 104)
    if len(found) > 1:
        handles, words = all_axes[0].get_legend_handles_labels()
        figure.legend(handles, words, loc="outside lower center", ncols=3)


def heat(figure: Any, found: dict[str, pd.DataFrame], x: str, y: str) -> None:
    """Success rate over two keys, a map for each choice of the others."""
    columns = min(3, len(found))
    made = figure.subplots(-(-len(found) // columns), columns, squeeze=False)
    drawn = None
    for axes, (name, rows) in zip(made.flat, found.items(), strict=False):
        table = rows.pivot_table(index=y, columns=x, values="success_rate", aggfunc="mean")
        drawn = axes.pcolormesh(
            100.0 * np.asarray(table, dtype=float), cmap="cividis", vmin=0.0, vmax=100.0,
            rasterized=table.size > 400,
        )  # fmt: skip
        axes.set_xticks(np.arange(len(table.columns)) + 0.5, [f"{v:g}" for v in table.columns])
        axes.set_yticks(np.arange(len(table.index)) + 0.5, [f"{v:g}" for v in table.index])
        axes.grid(visible=False)
        axes.set_xlabel(x)
        axes.set_ylabel(y)
        if len(found) > 1:
            axes.set_title(name)
    for axes in made.flat[len(found) :]:
        axes.set_visible(False)
    figure.colorbar(drawn, ax=made, label=_RATE, shrink=0.8)


# ---------------------------------------------------------------- shared


def _row_of_axes(figure: Any, n: int, **settings: Any) -> list[Any]:
    made: list[Any] = figure.subplots(1, n, squeeze=False, **_shared(settings))[0].tolist()
    return made


def _shared(settings: dict[str, Any]) -> dict[str, Any]:
    ratios = settings.pop("width_ratios", None)
    return settings | ({"gridspec_kw": {"width_ratios": ratios}} if ratios else {})


def _heading(metric: str) -> str:
    unit = with_unit("", metric).strip()
    words = _HEADINGS.get(metric) or f"{quantity(metric)}{f' [{unit}]' if unit else ''}"
    return fill(words, LETTERS)


def _band(rows: pd.DataFrame, metric: str) -> list[Any]:
    """Low, middle and high of a metric, or of the success rate."""
    names = (
        ("success_low", "success_rate", "success_high")
        if metric == "success"
        else (f"{metric}_q25", f"{metric}_median", f"{metric}_q75")
    )
    return [_numbers(rows, name) for name in names]


def _numbers(rows: pd.DataFrame, name: str) -> Any:
    """A column as floats; those that an axis has no ticks for are none, or 0."""
    column = rows[name] if name in rows else pd.Series(np.nan, rows.index)
    found = np.asarray(pd.to_numeric(column, errors="coerce"), dtype=float)
    found = np.where(np.abs(found) < LARGEST, found, np.nan)
    return np.where(np.abs(found) < LEAST, 0.0, found)
