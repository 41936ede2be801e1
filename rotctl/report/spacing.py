"""Which moments of a part become frames: more of them where the body changes faster.

A somersault is over in half a second, and standing still after it takes two: frames that were even
in time would miss what is fast. So they are even in a mean of time and of how far the body turned
and its joints moved, none closer to the next than `CLOSEST`; then each stage, push, change and time
upside down that has none gets the nearest that can be spared.
"""

from bisect import bisect_left
from collections.abc import Sequence

import numpy as np

from rotctl.maths.rotations import Array
from rotctl.metrics.columns import Arrays, floats, joint_rates
from rotctl.report.skill import Part

CLOSEST = 1 / 30  # of a part's rows are between two frames at least
CROWDED = 0.4  # and of the mean distance, where so many frames are wanted that this is less
MOVING = 0.7  # of the frames are spread over what moves, the rest over time
SOON = 6  # rows from what happened on, in which a frame shows it
FASTEST = 50.0  # [rad/s] a stranger's log may say anything

Stretch = tuple[int, int]  # first and last row


def even(first: int, last: int, frames: int, ends: bool = True) -> list[int]:
    """So many rows at most, evenly spaced, with or without the last."""
    places = np.linspace(first, last, frames, endpoint=ends)
    return list(dict.fromkeys(np.round(places).astype(int).tolist()))


def spread(
    log: Arrays, chosen: Sequence[Part], frames: int, happened: Sequence[int] = ()
) -> list[int]:
    """So many rows of these parts at most, by their shares; the last row of the last is one.

    Args:
        happened: rows of what `rotctl.report.happenings` finds.
    """
    rows: list[int] = []
    speed = change(log)
    marks = [*_marks(log), *(_soon(row, len(speed)) for row in happened[:frames])]
    left, shares = frames, sum(part.share for part in chosen)
    for part in chosen:
        many = min(left, max(1, round(left * part.share / shares)))
        if many:
            rows += _of_part(part, many, part is chosen[-1], speed, marks)
        left, shares = left - many, shares - part.share
    return list(dict.fromkeys(rows))


def change(log: Arrays) -> Array:
    """How fast the body turns, and its joints on the average (n,) [rad/s]; 0 where none is told."""
    turning = np.sqrt((floats(log, "trajectory/angular_velocity") ** 2).sum(axis=1))
    joints = joint_rates(log) if "trajectory/qvel" in log else np.zeros((1, 0))
    if joints.shape[1]:
        turning = turning + np.sqrt((joints**2).mean(axis=1))
    found: Array = np.nan_to_num(turning, nan=0.0, posinf=0.0).clip(0.0, FASTEST)
    return found


def _of_part(part: Part, frames: int, ends: bool, speed: Array, marks: list[Array]) -> list[int]:
    span = part.last - part.first
    gaps = max(frames - ends, 1)
    closest = min(CLOSEST * span, CROWDED * span / gaps)
    moves = speed[part.first : part.last]
    if span < 1:
        return [part.first]
    # Frames a row, as a share of the mean: at most so many that they are no closer than that.
    share = np.minimum(MOVING * moves / (moves.mean() or 1.0), span / (gaps * closest) - 1.0)
    done = np.concatenate(([0.0], np.cumsum(share + 1.0 - share.mean())))
    places = np.interp(np.linspace(0.0, span, frames, endpoint=ends), done, np.arange(span + 1))
    rows = list(dict.fromkeys((part.first + np.round(places).astype(int)).tolist()))
    return _seen(rows, _stretches(part, marks, frames), int(closest))


def _marks(log: Arrays) -> list[Array]:
    """Numbers of every row, of which each stretch above 0 is to be seen: stages, pushes, turns."""
    found = []
    if "command/stage" in log:
        found.append(floats(log, "command/stage") + 1.0)
    if "disturbance/wrench" in log:
        found.append(floats(log, "disturbance/wrench").any(axis=1).astype(float))
    if "trajectory/trunk_axes" in log:
        down = floats(log, "trajectory/trunk_axes")[:, 2, 2] < 0.0
        found.append(down.astype(float))
    return found


def _soon(row: int, rows: int) -> Array:
    """A mark of the rows in which it is seen what happened in one."""
    mark = np.zeros(rows)
    mark[row : row + SOON] = 1.0
    return mark


def _stretches(part: Part, marks: list[Array], most: int) -> list[Stretch]:
    """Rows over which one of the numbers stays as it is; of what changes more often, none."""
    found: list[Stretch] = []
    for mark in marks:
        here = mark[part.first : part.last + 1]
        edges = [0, *(np.flatnonzero(np.diff(here)) + 1).tolist(), len(here)]
        ranges = zip(edges, edges[1:], strict=False)
        some = [(part.first + a, part.first + b - 1) for a, b in ranges if here[a] > 0]
        found += some if len(some) <= most else []
    return found


def _seen(rows: list[int], wanted: list[Stretch], closest: int) -> list[int]:
    """Rows, in order: one in each stretch, as far as one can be spared and none is too close."""

    def none_in(stretch: Stretch, some: list[int]) -> bool:
        after = bisect_left(some, stretch[0])
        return after == len(some) or some[after] > stretch[1]

    def lost(some: list[int]) -> int:
        return sum(none_in(stretch, some) for stretch in wanted)

    for first, last in wanted:
        if not none_in((first, last), rows):
            continue
        middle = (first + last) // 2
        spared = sorted(rows[1:-1], key=lambda row: abs(row - middle))
        tried = (
            sorted([*(row for row in rows if row != one), place])
            for one in spared
            for place in (middle, first, last)
        )
        before = lost(rows)
        fits = (some for some in tried if np.diff(some).min() >= closest and lost(some) < before)
        rows = next(fits, rows)
    return rows
