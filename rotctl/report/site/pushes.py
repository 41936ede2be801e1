"""Who rolls on after a push: recovery over its impulse and its direction, as a polar map."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from rotctl.report.site.grid import labels
from rotctl.report.site.words import number

DIRECTION, IMPULSE = "disturbance.direction", "disturbance.impulse"
PHASE = "disturbance.phase"
RECOVERED = "recovered"
ENOUGH = 0.95  # of the runs with an impulse


def maps(runs: pd.DataFrame, keys: Sequence[str]) -> dict[str, pd.DataFrame]:
    """Shares of runs that recovered, impulse by direction, for each choice of `keys`."""
    named = runs.assign(name=labels(runs, keys), share=pd.to_numeric(runs[RECOVERED]))
    return {
        str(name): some.pivot_table(index=IMPULSE, columns=DIRECTION, values="share")
        for name, some in named.groupby("name", sort=False)
        if some["share"].notna().any()
    }


def withstood(shares: pd.DataFrame) -> pd.Series:
    """The largest impulse up to which nearly all recover, for each direction; 0 if none."""
    held = (shares >= ENOUGH).cumprod().astype(bool)
    impulse = pd.Series(shares.index, shares.index, dtype=float)
    return held.apply(lambda column: impulse[column].max()).fillna(0.0)


def said(found: dict[str, pd.DataFrame]) -> str:
    """What each withstands in its worst and in its median direction."""
    parts = []
    for name, shares in found.items():
        least = withstood(shares)
        worst = f"{number(least.min())} N s in the worst direction"
        way = number(float(str(least.idxmin())))
        parts.append(f"{name}: {worst} ({way}\u00b0), {number(least.median())} in the median one")
    return f"{100 * ENOUGH:.0f} % recover up to, {'; '.join(parts)}."


def said_of_phases(runs: pd.DataFrame) -> str:
    """At which phase of the motion a push is overcome least, and most; empty without phases."""
    if PHASE not in runs:
        return ""
    phase = pd.to_numeric(runs[PHASE], errors="coerce")  # a range that is drawn from is no number
    shares = pd.to_numeric(runs[RECOVERED]).groupby(phase).mean().dropna()
    if len(shares) < 2:
        return ""
    least, most = float(str(shares.idxmin())), float(str(shares.idxmax()))
    return (
        f" Over all, {100 * shares.min():.0f} % are overcome that come at a phase of "
        f"{number(least)}\u00b0, {100 * shares.max():.0f} % at {number(most)}\u00b0."
    )


def draw(figure: Any, found: dict[str, pd.DataFrame]) -> None:
    """A polar map for each: forward is up, left is left, the impulse goes outwards."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    columns = min(3, len(found))
    made = figure.subplots(
        -(-len(found) // columns), columns, squeeze=False, subplot_kw={"projection": "polar"}
    )
    colours = ScalarMappable(Normalize(0.0, 100.0), cmap="cividis")
    for axes, (name, shares) in zip(made.flat, found.items(), strict=False):
        ways = np.radians(np.asarray(shares.columns, dtype=float))
        for ring, values in enumerate(shares.to_numpy()):
            axes.bar(
                ways, 1.0, 2.0 * np.pi / len(ways), ring, color=colours.to_rgba(100.0 * values)
            )
        axes.set_theta_zero_location("N")
        axes.set_xticks(np.radians([0, 90, 180, 270]), ["forward", "left", "back", "right"])
        rings = [f"{value:g}" for value in shares.index]
        axes.set_yticks(np.arange(len(shares)) + 0.5, [*rings[:-1], f"{rings[-1]} N s"])
        axes.set_axisbelow(False)
        axes.tick_params(labelsize=7)
        axes.tick_params(
            axis="y", labelcolor="#ffffff" if shares.iloc[:, 0].mean() < 0.6 else "#1c222c"
        )
        axes.grid(visible=False)
        axes.set_title(name)
    for axes in made.flat[len(found) :]:
        axes.set_visible(False)
    figure.colorbar(colours, ax=made, label="Recovered [%]", shrink=0.8)
