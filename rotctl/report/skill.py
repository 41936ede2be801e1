"""Which part of a run shows what it can do: the flight of a flip, the push that is stood.

Rolls go on as they began, so that two revolutions show them. Everything else has a beginning and an
end of its own, and most of a run of some seconds comes before or after.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rotctl.maths.rotations import Array
from rotctl.metrics.columns import Arrays, floats, joint_rates
from rotctl.metrics.criteria.chain import again, spans
from rotctl.metrics.criteria.dive import entry
from rotctl.metrics.criteria.flip import longest_flight
from rotctl.report.moments import turns_done

FLIGHT = 0.2  # [s] from so long on it is one, not a hop
BEFORE = 0.5  # [s] of the crouch before a take-off, of the rest before anything else
AFTER = 0.5  # [s] shown when it is still: arms take longer
WET = 0.1  # [s] shown in the water: half of the body is in
LONGEST = 3.0  # [s] after a landing: who is not still then has fallen
SLOW = 0.1  # [m/s] of the centre of mass, that is still
SLOW_TURN = 0.3  # [rad/s] of the whole body
SLOW_JOINTS = 0.5  # [rad/s] of all joints together
QUICK = 0.3  # of the fastest of the centre of mass: from there on something happens
PERIODS = (1e-3, 10.0)  # [s] of a control step; a stranger's log may say anything
TURN = 1.0  # [rev] of a roll before it ends
MOVES, STANDS = 6.0, 1.0  # shares of the parts of a chain


class Part(NamedTuple):
    """Rows from `first` to `last`, and the share of a filmstrip's frames that is theirs."""

    first: int
    last: int
    share: float


def parts(
    log: Arrays, time: Array, stages: Sequence[int] = (), happened: int | None = None
) -> list[Part]:
    """What to show of a run, in order; empty for a roll that goes on.

    Args:
        time: of the rows that can be drawn [s].
        happened: the first row of what `rotctl.report.happenings` finds; not needed of a chain.
        stages: how many each part of a chain has; of what is none they need not be told.
    """
    chained = len(stages) > 1 and not again(log, stages)  # who begins again is shown from the first
    if chained:
        return _of_a_chain(log, stages, len(time))
    shown = _of_one(log, time, happened)
    return [Part(*shown, MOVES)] if shown else []


def _of_a_chain(log: Arrays, stages: Sequence[int], rows: int) -> list[Part]:
    """Of each part what it shows by itself, or a look at it, if it only stands."""
    found = []
    for span in spans(log, stages):
        first, end = span.rows.start, min(span.rows.stop, rows)
        if end - first < 2:
            continue
        shown = _of_one(span, span["trajectory/time"][: end - first])
        rolls = np.ptp(turns_done(span)[: end - first]) > TURN
        begin, last = shown or (0, end - first - 1)
        found.append(Part(first + begin, first + last, MOVES if shown or rolls else STANDS))
    return found


def _of_one(log: Arrays, time: Array, happened: int | None = None) -> tuple[int, int] | None:
    """First and last row of what one behaviour shows; None for a roll that goes on."""
    rows = len(time)
    period = float(np.clip((time[-1] - time[0]) / max(rows - 1, 1), *PERIODS)) if rows > 1 else 0.0
    staged = np.asarray(log["command/stage"])[:rows] if "command/stage" in log else np.zeros(rows)
    if not period:
        return None
    off, down = longest_flight(log)
    first = _begin(log, staged, period, happened)
    last = _still(log, 0, period, rows, poses=True)
    if staged.any() and 0 < off < rows and (down - off) * period > FLIGHT:
        if staged[off] < staged.max():
            return _flight(log, off, min(down, rows - 1), period, rows)
        last = min(last, down + round(LONGEST / period))  # it tumbles, after its last stage began
    return (first, last) if first is not None and last > first else None


def _flight(log: Arrays, off: int, down: int, period: float, rows: int) -> tuple[int, int]:
    """From before a flight to standing still; a dive's ends in the water."""
    first = _before(log, off, round(BEFORE / period))
    wet = entry(log)
    if wet is not None and off < wet <= down and not np.asarray(log["contacts/count"])[wet]:
        return first, min(wet + round(WET / period), rows - 1)
    return first, min(_still(log, down, period, rows), down + round(LONGEST / period))


def _before(log: Arrays, off: int, steps: int) -> int:
    """A moment before a take-off; from the hands, before the handstand was left."""
    first = max(off - steps, 0)
    if "trajectory/trunk_axes" in log and floats(log, "trajectory/trunk_axes")[first, 2, 2] < 0.0:
        held = int(np.argmax(np.asarray(log["command/stage"]) > 0))
        return max(held - steps, 0)
    return first


def _begin(log: Arrays, staged: Array, period: float, happened: int | None) -> int | None:
    """Where a motion of stages begins, a fall, a push, the end of a roll; None if nothing does."""
    turns = np.abs(turns_done(log))
    if staged.any():
        told = int(np.argmax(staged > 0))
        if turns[told] > TURN:
            return int(np.searchsorted(turns[:told], turns[told] - TURN))
        speed = _speed(log)
        begin = min(int(np.argmax(speed > QUICK * speed.max())), told)
    elif turns[-1] > TURN:
        return None
    elif not np.asarray(log["contacts/count"])[0]:
        begin = 0
    else:
        some = [row for row in (first_push(log), happened) if row is not None]
        if not some:
            return None
        begin = min(some)
    return max(begin - round(BEFORE / period), 0)


def first_push(log: Arrays) -> int | None:
    """The row in which something from outside first pushes; None if nothing does."""
    if "disturbance/wrench" not in log:
        return None
    pushed = floats(log, "disturbance/wrench").any(axis=1)
    return int(np.argmax(pushed)) if pushed.any() else None


def _still(log: Arrays, after: int, period: float, rows: int, poses: bool = False) -> int:
    """A moment after the row from which it is still for good; the last row, if it never is.

    Args:
        poses: its joints are to be still, too: what it shows may be arms alone.
    """
    turning = np.sqrt((floats(log, "trajectory/angular_velocity")[:rows] ** 2).sum(axis=1))
    moving = (_speed(log)[:rows] > SLOW) | (turning > SLOW_TURN)
    if poses and "trajectory/qvel" in log:
        joints = joint_rates(log)[:rows]
        moving |= np.sqrt((joints**2).sum(axis=1)) > SLOW_JOINTS
    moving[:after] = True
    late = np.flatnonzero(moving)
    still = int(late[-1]) + 1 if len(late) else 0
    return min(still + round(AFTER / period), rows - 1)


def _speed(log: Arrays) -> Array:
    speed: Array = np.sqrt((floats(log, "trajectory/com_velocity") ** 2).sum(axis=1))
    return speed
