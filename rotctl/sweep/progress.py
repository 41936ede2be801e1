"""What a person sees of a sweep: a bar on a terminal, else a line now and then."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rotctl.bars import bars
from rotctl.sweep.launch import Tally

EVERY = 10.0  # [s] between lines


@contextmanager
def shown(total: int, before: int, quiet: bool) -> Iterator[Callable[[Tally], None]]:
    """Something to call with the tally after every run; it writes to stderr.

    Args:
        total: runs of the sweep.
        before: how many of them were there already, and are no part of the rate.
        quiet: write nothing.
    """
    if quiet:
        yield lambda tally: None
    elif sys.stderr.isatty():
        with _bar(total, before) as update:
            yield update
    else:
        yield _lines(total, before)


@contextmanager
def _bar(total: int, before: int) -> Iterator[Callable[[Tally], None]]:
    with bars()(total=total, initial=before, unit="run", smoothing=0.05, dynamic_ncols=True) as bar:

        def update(tally: Tally) -> None:
            bar.set_postfix_str(_counts(tally), refresh=False)
            bar.update(tally.count - bar.n)

        yield update


def _lines(total: int, before: int) -> Callable[[Tally], None]:
    begin = last = time.monotonic()

    def update(tally: Tally) -> None:
        nonlocal last
        moment = time.monotonic()
        if moment - last < EVERY or tally.count == before:
            return
        last = moment
        rate = (tally.count - before) / (moment - begin)
        left = (total - tally.count) / rate
        sys.stderr.write(
            f"{tally.count}/{total} runs, {rate:.2g} run/s, {duration(left)} left, "
            f"{_counts(tally)}\n"
        )

    return update


def _counts(tally: Tally) -> str:
    broken = f", {len(tally.broken)} failed to run" if tally.broken else ""
    return f"{tally.succeeded} succeeded, {tally.fell} did not{broken}"


def duration(seconds: float) -> str:
    """A time span for people."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    if seconds < 5400:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h"
