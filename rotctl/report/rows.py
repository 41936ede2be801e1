"""Which rows of a log to show: a run that broke down ends in rows that nobody can draw."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotctl.errors import InputError, LogError
from rotctl.log import RunLog
from rotctl.maths.rotations import Array

MAX_POSITION = 1e5  # [m, rad] a run that broke down is shown until there
MAX_TIME = 1e5  # [s] no run is as long
LARGEST = 1e12  # in any unit; axes of larger numbers would have no ticks


class _Moderate(RunLog):
    """Numbers that are too large are none."""

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Reads one dataset."""
        array = super().__getitem__(name)
        if array.dtype.kind != "f":
            return array
        return np.where(np.abs(array) < LARGEST, array, np.nan)


def moderate(log: RunLog) -> RunLog:
    """The same log, for plots: its numbers are no larger than `LARGEST`, others are NaN."""
    return _Moderate(log.path, log.attributes, log.sizes)


def drawable(log: RunLog, states: Array) -> Array:
    """Times [s] of the rows before the first that cannot be drawn.

    Args:
        states: ``trajectory/qpos`` of the log.

    Raises:
        LogError: there is none.
    """
    time: Array = log["trajectory/time"]
    sound = (np.abs(states) < MAX_POSITION).all(axis=1) & (np.abs(time) < MAX_TIME)
    sound[1:] &= time[1:] > time[:-1]
    last = len(time) if sound.all() else int(np.argmin(sound))
    if last == 0:
        raise LogError(f"{log.path}: has no step that could be drawn")
    return time[:last]


def window(time: Array, start: float | None, end: float | None) -> tuple[int, int]:
    """First and last row from `start` to `end` [s]; all rows where neither is given.

    A run ends a control step after its last row begins: `end` may be there, too.

    Raises:
        InputError: a time is not in the log, or start is not before end.
    """
    first = nearest(time, "start (--from)", float(time[0]) if start is None else start)
    until = float(time[-1])
    over = until + float(time[1] - time[0] if len(time) > 1 else 0.0)
    reached = until if end is None or until < end <= over + 1e-9 else end
    last = nearest(time, "end (--to)", reached)
    if start is not None and end is not None and start >= end:
        raise InputError(f"start (--from) is {start:g} s, valid: less than end = {end:g} s")
    return first, last


def nearest(time: Array, name: str, value: float) -> int:
    """The row nearest to a time [s].

    Raises:
        InputError: the log does not reach there; `name` says what does not.
    """
    if not time[0] <= value <= time[-1] + 1e-9:
        raise InputError(f"{name} is {value:g} s, valid: {time[0]:g} to {time[-1]:g} s")
    return int(np.abs(time - value).argmin())


def at_rate(time: Array, rate: float) -> list[int]:
    """Rows nearest to the instants of a steady rate [1/s], none of them twice."""
    count = int(np.floor((time[-1] - time[0]) * rate + 1e-6)) + 1
    wanted = time[0] + np.arange(count) / rate
    after = np.searchsorted(time, wanted).clip(1, max(1, len(time) - 1))
    if len(time) == 1:
        return [0]
    found = np.where(wanted - time[after - 1] <= time[after] - wanted, after - 1, after)
    return list(dict.fromkeys(found.tolist()))
