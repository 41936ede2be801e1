"""A run from above: where it went, how the trunk lay, and the way that it was to follow."""

from pathlib import Path
from typing import Any

import numpy as np

from rotctl.log import RunLog
from rotctl.maths.rotations import Array
from rotctl.metrics.columns import floats, nearest_places, turns
from rotctl.report import axes as draw
from rotctl.report.moments import turns_done
from rotctl.report.plot import LEFT, RIGHT, heading, write

SIZE = (6.4, 6.0)  # [inch]
ACROSS = 0.5  # [m] of the line that shows how the trunk lies; shoulders are so wide
MARK = 5.0  # [s] from one time that is written to the next
LEAST = 2.0  # [m] that is shown to either side of who stays where it is


def plan(log: RunLog, out: Path, start: float | None = None, end: float | None = None) -> None:
    """Plot a run from above; arguments and errors are those of `rotctl.report.plot.plot`."""
    write(log, out, SIZE, _draw, start, end)


def _draw(figure: Any, log: RunLog, rows: slice) -> None:
    heading(figure, log, SIZE[1])
    axes = figure.add_subplot(
        figure.add_gridspec(1, 1, left=LEFT, right=RIGHT, top=0.88, bottom=0.09)[0]
    )
    place, time = floats(log, "trajectory/com")[rows, :2], log["trajectory/time"][rows]
    way = nearest_places(log)[rows, :2] if turns(log) else place
    if (way != place).any():  # rates alone are a way without places
        axes.plot(*way.T, color=draw.BLACK, ls="--", lw=0.9, label="the way")
    axes.plot(*place.T, color=draw.BLUE, lw=1.0, label="centre of mass")
    axis = floats(log, "trajectory/trunk_axis")[rows, :2]
    for i in _whole(turns_done(log)[rows]):
        ends = np.array([place[i] - 0.5 * ACROSS * axis[i], place[i] + 0.5 * ACROSS * axis[i]])
        axes.plot(*ends.T, color=draw.ORANGE, lw=1.2)
    axes.plot([], [], color=draw.ORANGE, lw=1.2, label="trunk's axis, once a revolution")
    for mark in np.arange(np.ceil(time[0] / MARK) * MARK, time[-1] + 1e-9, MARK):
        i = int(np.searchsorted(time, mark - 1e-9))
        axes.plot(*place[i], "o", color=draw.BLUE, ms=2.5)
        axes.annotate(f"{mark:g} s", place[i], (3, 3), textcoords="offset points", color=draw.GREY)
    axes.set_aspect("equal", adjustable="datalim")
    middle = 0.5 * (place.min(axis=0) + place.max(axis=0))
    axes.update_datalim([middle - LEAST, middle + LEAST])
    axes.autoscale_view()
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    draw.legend(axes, right=1.0)


def _whole(turned: Array) -> list[int]:
    """Rows in which another whole revolution is made, of excursions (n,) [rev]."""
    furthest = np.floor(np.maximum.accumulate(np.abs(turned)))
    found: list[int] = (np.flatnonzero(np.diff(furthest)) + 1).tolist()
    return found
