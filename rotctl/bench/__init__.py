"""Where the time goes. Ratios taken in one run mean something; bare times hardly do."""

from collections.abc import Iterator
from pathlib import Path

from rotctl import files
from rotctl.bench import overhead, scaling, solvers, split, startup, whole

STATES = 150  # for the comparison of solvers; literal OSQP takes tens of milliseconds on each


def bench(repeats: int, picture: Path | None) -> Iterator[str]:
    """All tables, one after the other as they are measured.

    Args:
        repeats: medians are over so many.
        picture: where to plot the cost against contacts, or None.
    """
    if picture is not None:
        files.require_ending(picture, ".svg", ".png", ".pdf")
    yield whole.table(repeats)
    yield split.split(repeats)
    yield startup.processes(repeats)
    yield solvers.compare(STATES)
    costs = scaling.measure()
    yield scaling.table(costs)
    if picture is not None:
        scaling.plot(costs, picture)
    yield overhead.sweeps()
