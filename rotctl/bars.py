"""Progress bars: on a terminal alone, and only where the work takes a while."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tqdm import tqdm


def bar(what: str, unit: str, total: int | None = None, hidden: bool = False) -> "tqdm[Any]":
    """A bar that goes when it is done.

    Args:
        total: how many units there are, if that is known.
        hidden: also on a terminal.
    """
    nowhere = hidden or None  # None: only where somebody watches
    return bars()(total=total, desc=what, unit=unit, leave=False, disable=nowhere, delay=0.2)


def bars() -> "type[tqdm[Any]]":
    """What makes bars, less the thread that watches them: beside it no worker is forked."""
    from tqdm import tqdm

    tqdm.monitor_interval = 0
    return tqdm


def following(shown: "tqdm[Any]") -> Callable[[int, int], None]:
    """What moves a bar when it is told how much is done, and of how much."""

    def progress(done: int, total: int) -> None:
        shown.total = total
        shown.update(done - shown.n)

    return progress
