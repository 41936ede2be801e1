"""The runs that a command line asks for, and whose fault it is where it asks for none."""

from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager, nullcontext

from rotctl.errors import InputError
from rotctl.results import experiments
from rotctl.sweep.plan import Planned, planned
from rotctl.sweep.points import Point, points


def asked(
    overrides: list[str],
    watched: Callable[[Iterable[Point]], AbstractContextManager[Iterable[Point]]] = nullcontext,
) -> list[Planned]:
    """The runs of a command line's own grid, or of its experiment's.

    Args:
        overrides: as they are typed.
        watched: hands the points on as they are made, and is closed when that is over.

    Raises:
        InputError: a point makes no run; the line names the experiment where its own grid is
            at fault.
    """
    grids = experiments.matrix(overrides)
    try:
        with watched(points(grids)) as seen:
            return planned(seen)
    except InputError as error:
        name = experiments.named(overrides)
        if not name or (len(overrides) > 1 and str(error) != _own_fault(name)):
            raise
        raise InputError(f"{experiments.PREFIX}{name}: {error}") from None


def _own_fault(name: str) -> str:
    """What is wrong with an experiment's grid, whatever the seed; empty if nothing is."""
    try:
        planned(points(experiments.matrix([f"{experiments.PREFIX}{name}", "seed=0"])))
    except InputError as error:
        return str(error)
    return ""
