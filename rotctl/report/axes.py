"""What each plot of a run's page shows; every function draws into the axes that it is given."""

from typing import Any

import numpy as np

from rotctl.log import RunLog
from rotctl.maths.rotations import Array
from rotctl.metrics.columns import in_frame
from rotctl.report.signals import Rates, Signals, torque_fractions
from rotctl.report.timeline import Bar

# Okabe and Ito's colours, which the colour-blind can tell apart too.
BLUE, ORANGE, GREEN = "#0072B2", "#D55E00", "#009E73"
BLACK, GREY, LIGHT = "#1c222c", "#68727f", "#b9c1ca"
GOOD, BAD = "#167a4c", "#be2026"


def _three(axes: Any, time: Array, values: Array) -> None:
    """In-plane in front, out-of-plane behind."""
    axes.plot(time, values[:, 0], color=ORANGE, label="forward", lw=0.6)
    axes.plot(time, values[:, 2], color=GREEN, label="up", lw=0.6)
    axes.plot(time, values[:, 1], color=BLUE, label="left", lw=1.0)


def momentum(axes: Any, log: RunLog, rows: slice, run: Signals) -> None:
    """Angular momentum."""
    _three(axes, run.time, in_frame(log, "trajectory/angular_momentum")[rows])
    legend(axes)


def spin(axes: Any, run: Signals) -> None:
    """Angular velocity, and what was wanted."""
    _three(axes, run.time, run.spin)
    ends = run.commanded_time
    if np.isfinite(run.commanded_spin) and len(ends):
        wanted = np.full(len(ends), run.commanded_spin)
        axes.plot(ends, wanted, color=BLACK, ls="--", lw=0.9, label="wanted")
    legend(axes)


def in_plane(axes: Any, run: Signals) -> None:
    """In-plane excursion, and what the wanted angular velocity adds up to."""
    axes.plot(run.time, run.turns[:, 1], color=BLUE, label="achieved", lw=1.0)
    ends = run.commanded_time
    if np.isfinite(run.commanded_spin) and len(ends):
        wanted = run.turns[0, 1] + run.commanded_spin * (ends - ends[0])
        axes.plot(ends, wanted, color=BLACK, ls="--", lw=0.9, label="wanted")
    legend(axes)


def out_of_plane(axes: Any, run: Signals) -> None:
    """Out-of-plane excursion."""
    axes.plot(run.time, 360.0 * run.turns[:, 0], color=ORANGE, label="forward")
    axes.plot(run.time, 360.0 * run.turns[:, 2], color=GREEN, label="up")
    legend(axes)


def rate(axes: Any, time: Array, rates: Rates, axis: int) -> None:
    """Limits that show nearly everything: impacts must not flatten the rest."""
    shown = (("realised", LIGHT, 0.5), ("predicted", ORANGE, 0.6), ("wanted", BLUE, 0.8))
    values = (rates.realised, rates.predicted, rates.desired)
    ends: list[Array] = []
    for (label, colour, width), all_three in zip(shown, values, strict=True):
        each = all_three[:, axis]
        axes.plot(time, each, color=colour, lw=width, label=label)
        finite = each[np.isfinite(each)]
        spared = 3.0 if label == "realised" else 0.5  # [%] at each end
        ends.append(np.percentile(finite, [spared, 100.0 - spared]) if len(finite) else np.zeros(2))
    low, high = float(np.min(ends)), float(np.max(ends))
    room = max(0.1 * (high - low), 0.1)  # [N or N m] at least: a rate of 0 has none
    axes.set_ylim(low - room, high + room)


def blend(axes: Any, run: Signals) -> None:
    """Between the two poses."""
    axes.fill_between(run.time, run.blend, color=BLUE, alpha=0.25, lw=0)
    axes.plot(run.time, run.blend, color=BLUE, lw=0.6)
    axes.set_ylim(-0.03, 1.03)
    axes.set_yticks([0.0, 0.5, 1.0], ["0: pose b", "0.5", "1: pose a"])
    axes.set_ylabel("")


def count(axes: Any, run: Signals) -> None:
    """How many contacts."""
    axes.fill_between(run.time, run.count, step="post", color=LIGHT, lw=0, label="all")
    axes.fill_between(run.time, run.used, step="post", color=ORANGE, lw=0, label="used")
    axes.set_ylim(0, max(1.0, 1.05 * run.count.max(initial=0)))
    axes.yaxis.get_major_locator().set_params(integer=True)
    legend(axes)


def ground_force(axes: Any, run: Signals, weight: float) -> None:
    """Of the whole body, in body weights."""
    axes.plot(run.time, run.force_peak / weight, color=LIGHT, lw=0.6, label="peak in a step")
    axes.plot(run.time, run.force / weight, color=ORANGE, lw=0.7, label="mean")
    axes.set_ylim(0, None)
    legend(axes)


def height(axes: Any, run: Signals) -> None:
    """Of the centre of mass above the ground below it."""
    axes.plot(run.time, run.height, color=BLUE)
    if np.isfinite(run.height).any():
        axes.set_ylim(min(0.0, np.nanmin(run.height)), None)


def torques(axes: Any, log: RunLog, rows: slice, time: Array) -> None:
    """Rows of colour: seven lines over each other could not be read."""
    groups = torque_fractions(log, rows)
    image = np.array(list(groups.values())) if groups else np.zeros((1, len(time)))
    ends = (time[0], time[-1] + 1e-9, len(image) - 0.5, -0.5)
    drawn = axes.imshow(
        image, aspect="auto", extent=ends, cmap="cividis", vmin=0.0, vmax=1.0,
        interpolation="none",
    )  # fmt: skip
    axes.set_yticks(range(len(groups)), list(groups), parse_math=False)
    axes.grid(visible=False)
    above = axes.inset_axes((0.68, 1.04, 0.32, 0.04))
    bar = axes.figure.colorbar(drawn, cax=above, ticks=[0, 0.5, 1], orientation="horizontal")
    above.xaxis.set_ticks_position("top")
    above.tick_params(length=0, pad=1, labelsize=6)
    bar.outline.set_visible(False)


def gantt(axes: Any, parts: dict[str, list[Bar]]) -> None:
    """Which body part touched the ground when."""
    for i, bars in enumerate(parts.values()):
        for used, colour in ((False, LIGHT), (True, ORANGE)):
            spans = [(bar.start, bar.duration) for bar in bars if bar.used == used]
            axes.broken_barh(spans, (i - 0.38, 0.76), facecolors=colour, lw=0)
    axes.set_yticks(range(len(parts)), list(parts), parse_math=False)
    axes.tick_params(axis="y", labelsize=min(7.5, 75.0 / max(len(parts), 1)))
    axes.set_ylim(max(len(parts), 1) - 0.4, -0.6)
    axes.grid(visible=False, axis="y")
    for label, colour in (("used", ORANGE), ("left out", LIGHT)):
        axes.broken_barh([], (0, 0), facecolors=colour, label=label)
    legend(axes)


def solver(axes: Any, log: RunLog, rows: slice, time: Array) -> None:
    """How good it was, how hard where the solver tells iterations, and where it failed."""
    status, residual = log["solver/status"][rows], log["solver/residual"][rows]
    iterations = log["solver/iterations"][rows]
    told = bool(iterations.any())
    axes.plot(time, np.where(residual > 0, residual, np.nan), color=ORANGE, lw=0.5)
    axes.plot([], [], color=ORANGE, lw=0.8, label="residual" + told * " (left)")
    axes.set_yscale("log")
    axes.minorticks_off()  # whose labels would lie over one another
    for code, label, marker, colour in (
        (1, "solved by a fallback", "v", GREEN),
        (2, "all failed", "x", BAD),
    ):
        at = time[status == code]
        axes.plot(
            at, np.zeros(len(at)), marker, color=colour, ms=4, clip_on=False,
            transform=axes.get_xaxis_transform(), label=f"{label}: {len(at)}",
        )  # fmt: skip
    if told:
        beside = axes.twinx()
        beside.spines["right"].set_visible(True)
        beside.plot(time, iterations, color=BLUE, lw=0.6)
        beside.set_ylim(0, None)
        beside.set_ylabel("iterations")
        beside.grid(visible=False)
        axes.plot([], [], color=BLUE, lw=0.8, label="iterations (right)")
    legend(axes)


def legend(axes: Any, right: float = 1.02) -> None:
    """Above the plot, where it hides nothing."""
    axes.legend(
        loc="lower right", bbox_to_anchor=(right, 0.98), ncols=4, borderaxespad=0.0,
        handlelength=1.2, columnspacing=0.9, handletextpad=0.4,
    )  # fmt: skip
