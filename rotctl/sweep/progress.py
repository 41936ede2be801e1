"""What a person sees of a sweep: a bar on a terminal, else a line now and then."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

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
        yield lambda now: None
    elif sys.stderr.isatty():
        with _bar(total, before) as update:
            yield update
    else:
        yield _lines(total, before)


@contextmanager
def _bar(total: int, before: int) -> Iterator[Callable[[Tally], None]]:
    from tqdm import tqdm

    with tqdm(total=total, initial=before, unit="run", smoothing=0.05, dynamic_ncols=True) as bar:

        def update(now: Tally) -> None:
            bar.set_postfix_str(_counts(now), refresh=False)
            bar.update(now.count - bar.n)

        yield update


def _lines(total: int, before: int) -> Callable[[Tally], None]:
    begin = last = time.monotonic()

    def update(now: Tally) -> None:
        nonlocal last
        moment = time.monotonic()
        if moment - last < EVERY or now.count == before:
            return
        last = moment
        rate = (now.count - before) / (moment - begin)
        left = (total - now.count) / rate
        sys.stderr.write(
            f"{now.count}/{total} runs, {rate:.2g} run/s, {duration(left)} left, {_counts(now)}\n"
        )

    return update


def _counts(now: Tally) -> str:
    broken = f", {len(now.broken)} failed to run" if now.broken else ""
    return f"{now.succeeded} succeeded, {now.fell} did not{broken}"


def duration(seconds: float) -> str:
    """A time span for people."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    if seconds < 5400:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h"
