"""The charts of a sweep's page, each as two SVG pictures: on light and on dark paper."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from io import BytesIO
from typing import Any

from rotctl.amounts import count
from rotctl.report.site import outcomes, panels, pushes
from rotctl.report.site.grid import Grid
from rotctl.report.site.panels import Paper

LIGHT = Paper("#ffffff", "#1c222c", "#5d6876", "#e3e8ed")
DARK = Paper("#11161d", "#e8edf3", "#9aa7b6", "#28313d")
MOST_GROUPS = 60  # in a list of groups
MOST_LINES = 6  # in a plot of curves
MOST_PANELS = 12
MOST_CELLS = 60_000  # of a success map
_WIDTH, _DOTS = 8.6, 100  # [inch]; per inch, for what is no vector graphic
_STYLE: Mapping[Any, Any] = {
    "font.size": 9.0,
    "font.family": "sans-serif",
    "axes.titlesize": 9.5,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "svg.fonttype": "none",  # text stays text
    "svg.hashsalt": "rotctl",  # the same runs give the same bytes
    "text.parse_math": False,  # a stranger's dollar signs are no formulas
}


@dataclass(frozen=True)
class Chart:
    """A chart.

    Attributes:
        name: of its files.
        heading: what it shows.
        alt: the same with what can be seen in it.
        width: in the page [pixels].
        height: in the page [pixels].
        light: SVG.
        dark: SVG.
    """

    name: str
    heading: str
    alt: str
    width: int
    height: int
    light: bytes
    dark: bytes


def charts(found: Grid) -> list[Chart]:
    """The charts that make sense for a sweep, most telling first."""
    groups, runs = found.groups, found.runs
    some = len(groups) <= MOST_GROUPS
    shown = panels.drawn(found)
    made = []
    if some:
        made.append(
            _chart(
                "groups",
                "Success rates with 95 % intervals"
                + ("; medians and quartiles of the rest" if shown else ""),
                panels.said_of_groups(groups),
                (_WIDTH, 1.3 + 0.27 * len(groups)),
                lambda figure, _: panels.groups(figure, groups, shown),
            )
        )
    if found.axes:
        key, *more = found.axes
        lines = panels.lines(groups, [*more, *found.others])
        if len(lines) <= MOST_LINES:
            made.append(
                _chart(
                    "curves",
                    f"Over {key}: success rate with its 95 % interval"
                    + (", medians with quartiles" if shown else ""),
                    f"Curves over {key}. {panels.said_of_groups(groups)}",
                    (_WIDTH, 3.0),
                    lambda figure, _: panels.curves(figure, lines, key, shown[:2]),
                )
            )
    if len(found.axes) > 1:
        x, y, *more = found.axes
        maps = panels.lines(groups, [*more, *found.others])
        if len(maps) <= MOST_PANELS:
            made.append(
                _chart(
                    "heat",
                    f"Success rate over {x} and {y}",
                    f"Heat map over {x} and {y}. {panels.said_of_groups(groups)}",
                    (_WIDTH, 0.5 + 2.7 * -(-len(maps) // 3)),
                    lambda figure, _: panels.heat(figure, maps, x, y),
                )
            )
    if {pushes.DIRECTION, pushes.IMPULSE} <= set(found.axes) and pushes.RECOVERED in runs:
        pushed = pushes.maps(runs, found.others)
        if 0 < len(pushed) <= MOST_PANELS:
            told = pushes.said(pushed) + pushes.said_of_phases(runs)
            made.append(
                _chart(
                    "pushes",
                    "Runs that roll on after a push, by its direction and its impulse [N s]. "
                    + told,
                    f"Polar maps of recovery. {told}",
                    (_WIDTH, 0.5 + 3.2 * -(-len(pushed) // 3)),
                    lambda figure, _: pushes.draw(figure, pushed),
                )
            )
    if some and outcomes.failures_of(runs).size:
        made.append(
            _chart(
                "failures",
                "Runs that failed, by reason",
                outcomes.said_of_failures(runs),
                (_WIDTH, 0.9 + 0.2 * outcomes.lines_of_legend(runs) + 0.27 * len(groups)),
                lambda figure, _: outcomes.failures(figure, runs),
            )
        )
    seeds = runs["seed"].nunique()
    if seeds > 1 and len(groups) * seeds <= MOST_CELLS:
        made.append(
            _chart(
                "starts",
                "Every start: blue succeeded, orange failed, empty has no result",
                f"Success map of {count(len(groups), 'group')} by {seeds} seeds. "
                f"{panels.said_of_groups(groups)}",
                (_WIDTH, 1.0 + min(8.0, 0.27 * len(groups))),
                lambda figure, paper: outcomes.starts(figure, runs, some, paper),
            )
        )
    return made


def _chart(
    name: str,
    heading: str,
    alt: str,
    size: tuple[float, float],
    draw: Callable[[Any, Paper], None],
) -> Chart:
    width, height = (round(_DOTS * side) for side in size)
    light, dark = (_svg(size, draw, paper) for paper in (LIGHT, DARK))
    return Chart(name, heading, alt, width, height, light, dark)


def _svg(size: tuple[float, float], draw: Callable[[Any, Paper], None], paper: Paper) -> bytes:
    import matplotlib
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure

    colours: dict[Any, Any] = {
        "figure.facecolor": paper.paper,
        "axes.facecolor": paper.paper,
        "text.color": paper.ink,
        "axes.labelcolor": paper.ink,
        "axes.edgecolor": paper.soft,
        "xtick.color": paper.soft,
        "ytick.color": paper.soft,
        "ytick.labelcolor": paper.ink,
        "grid.color": paper.grid,
    }
    with matplotlib.rc_context({**_STYLE, **colours}):
        figure = Figure(figsize=size, dpi=_DOTS, layout="constrained")
        FigureCanvasSVG(figure)
        draw(figure, paper)
        packed = BytesIO()
        figure.savefig(packed, format="svg", metadata={"Date": None})
    return packed.getvalue()
