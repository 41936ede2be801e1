"""A run as one page of plots, drawn from the log alone: PNG, SVG or PDF."""

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

from rotctl import files
from rotctl.engine import mujoco_without_opengl
from rotctl.log import RunLog
from rotctl.report import axes as draw
from rotctl.report import character, stored_model
from rotctl.report.rows import drawable, moderate, window
from rotctl.report.signals import angular_rates, linear_rates, signals
from rotctl.report.timeline import contact_bars
from rotctl.report.title import title

FORMATS = {".png": "png", ".svg": "svg", ".pdf": "pdf"}
SIZE = (8.27, 11.69)  # [inch] A4
LEFT, RIGHT = 0.1, 0.935  # of the page's width, where words and plots begin and end
DOTS = 200  # per inch, in PNG
_STYLE: dict[Any, Any] = {
    "font.size": 7.5,
    "axes.titlesize": 8.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.titley": 1.0,
    "axes.labelsize": 7.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": draw.GREY,
    "axes.linewidth": 0.6,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e6eaee",
    "grid.linewidth": 0.6,
    "lines.linewidth": 0.8,
    "xtick.color": draw.GREY,
    "ytick.color": draw.GREY,
    "legend.fontsize": 6.8,
    "legend.frameon": False,
    "pdf.fonttype": 42,  # text stays text
    "svg.fonttype": "none",
    "svg.hashsalt": "rotctl",  # the same log gives the same bytes
}


def plot(log: RunLog, out: Path, start: float | None = None, end: float | None = None) -> None:
    """Plot a run.

    Args:
        out: a .png, .svg or .pdf file; replaced if it is there.
        start: first time [s]; the run's first by default.
        end: last time [s]; the run's last by default.

    Raises:
        InputError: `out` has another ending or cannot be written, or a time is not in the log.
        LogError: the log is damaged or its model is not safe to load.
    """
    write(log, out, SIZE, _draw, start, end)


def write(
    log: RunLog,
    out: Path,
    size: tuple[float, float],
    draws: Callable[[Any, RunLog, slice], object],
    start: float | None,
    end: float | None,
) -> None:
    """Write a figure of a run; see `plot`.

    Args:
        size: of the figure [inch].
        draws: fills it, given the figure, the log, and its rows from `start` to `end`.
    """
    files.require_ending(out, *FORMATS)
    log = moderate(log)
    first, last = window(drawable(log, log["trajectory/qpos"]), start, end)
    kind = FORMATS[out.suffix.lower()]
    mujoco_without_opengl()
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with matplotlib.rc_context(_STYLE):
        figure = Figure(figsize=size, dpi=DOTS)
        FigureCanvasAgg(figure)
        draws(figure, log, slice(first, last + 1))
        packed = BytesIO()
        nothing = {"Date": None} if kind == "svg" else {"CreationDate": None}
        figure.savefig(packed, format=kind, metadata={} if kind == "png" else nothing)
    files.replace(out, packed.getvalue())


def _draw(figure: Any, log: RunLog, rows: slice) -> None:
    from matplotlib.ticker import MaxNLocator

    run = signals(log, rows)
    model = stored_model.load(log)
    pull = max(character.weight(model), 1.0)
    heading(figure, log)
    grid = figure.add_gridspec(
        8, 6, left=LEFT, right=RIGHT, top=0.922, bottom=0.045, hspace=0.7, wspace=1.3,
        height_ratios=[1, 1, 1, 1, 0.75, 0.8, 1.5, 0.9],
    )  # fmt: skip

    left, right = slice(0, 3), slice(3, 6)

    def axes(row: int, columns: slice, heading: str, unit: str) -> Any:
        made = figure.add_subplot(grid[row, columns])
        made.set_title(heading)
        made.set_ylabel(unit)
        made.set_xlim(run.time[0], max(run.time[-1], run.time[0] + 1e-3))
        made.xaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
        return made

    draw.momentum(axes(0, left, "Angular momentum H", "kg m\u00b2/s"), log, rows, run)
    draw.spin(axes(0, right, "Angular velocity \u03c9", "rev/s"), run)
    draw.in_plane(axes(1, left, "Excursion, in-plane", "rev"), run)
    draw.out_of_plane(axes(1, right, "Integral of ω, out-of-plane", "deg"), run)
    linear, angular = linear_rates(log, rows, character.gravity(model)), angular_rates(log, rows)
    for i, axis in enumerate(("forward", "left", "up")):
        third = slice(2 * i, 2 * i + 2)
        name = {"left": f"{axis} (in-plane)"}.get(axis, axis)
        draw.rate(axes(2, third, f"dL/dt, {axis}", "N" if i == 0 else ""), run.time, linear, i)
        draw.rate(axes(3, third, f"dH/dt, {name}", "N m" if i == 0 else ""), run.time, angular, i)
        if i == 1:
            draw.legend(figure.axes[-2], right=1.38)
    if run.blends:
        draw.blend(axes(4, left, "Blend \u03b3", "1"), run)
    draw.count(axes(4, right if run.blends else slice(0, 6), "Contacts", "1"), run)
    draw.ground_force(axes(5, left, "Ground force", "body weights"), run, pull)
    draw.height(axes(5, right, "Centre of mass above the ground", "m"), run)
    draw.torques(axes(6, left, "Torque as a fraction of its limit", ""), log, rows, run.time)
    draw.gantt(axes(6, right, "Contacts by body part", ""), contact_bars(log, rows, model))
    draw.solver(axes(7, slice(0, 6), "Solver", "residual"), log, rows, run.time)
    for each in figure.axes:
        if each.get_subplotspec().is_last_row():
            each.set_xlabel("time [s]")


def heading(figure: Any, log: RunLog, top_of: float = SIZE[1]) -> None:
    """What was run and how it went, at the top of a page so high [inch]."""
    top = title(log)
    first, second = (1.0 - (1.0 - y) * SIZE[1] / top_of for y in (0.968, 0.950))
    colour = {True: draw.GOOD, False: draw.BAD, None: draw.GREY}[top.success]
    # parse_math: a stranger's dollar signs are no formulas.
    figure.text(LEFT, first, top.name, size=13, weight="bold", parse_math=False)
    figure.text(RIGHT, first, top.about, size=8, color=draw.GREY, ha="right", parse_math=False)
    verdict = figure.text(
        LEFT, second, top.verdict, size=9, color=colour, weight="bold", parse_math=False
    )
    room = (RIGHT - LEFT) * figure.bbox.width
    verdict.set_size(9 * min(1.0, room / verdict.get_window_extent().width))
