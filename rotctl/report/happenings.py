"""What happens in a run that no force tells: a load taken up, slippery ground, another command."""

import re
from math import inf
from typing import Any, NamedTuple

import numpy as np

from rotctl.errors import InputError
from rotctl.log import RunLog
from rotctl.report.title import plain
from rotctl.settings.documents import from_yaml
from rotctl.settings.plain import NOTHING, find

# What `rotctl.mechanics.changes` tells; other events are of solvers.
_CHANGES = re.compile(r"\S+ takes up \S+ kg|the ground has \S+ of its friction")
_LARGEST = 1e300
_STALL = {"stall_progress": 0.1, "stall_time": 1.5}  # [rev, s] of the usual criteria


class Happening(NamedTuple):
    """One of them.

    Attributes:
        row: of the log, the first that it is true of.
        told: in words.
    """

    row: int
    told: str


def happenings(log: RunLog) -> list[Happening]:
    """All of a run, in order."""
    time = log["trajectory/time"]
    found = [each for each in log.events if _CHANGES.fullmatch(each[1])] + _commands(log)
    within = [(when, told) for when, told in found if time[0] < when <= time[-1]]
    rows = np.searchsorted(time, [when - 1e-9 for when, _ in within]).tolist()
    return sorted(
        Happening(row, f"{when:.2f} s: {plain(told)}")
        for row, (when, told) in zip(rows, within, strict=True)
    )


def halts(log: RunLog) -> list[tuple[float, float]]:
    """When a roll is told to halt, and until when [s]."""
    told = _schedule(_config(log, "behaviour"), "pace")
    ends = [*(time for time, _ in told[1:]), inf]
    return [(time, end) for (time, value), end in zip(told, ends, strict=False) if not value]


def stall(log: RunLog) -> tuple[float, float]:
    """Less progress [rev] in so long [s] is one, by the run's criteria."""
    criteria = _config(log, "criteria")
    rolls = find(criteria, ("roll",))  # of one that ends on its feet
    told = [find(criteria if rolls is NOTHING else rolls, (key,)) for key in _STALL]
    least, lasting = (
        float(one) if _number(one) and one > 0 else usual
        for one, usual in zip(told, _STALL.values(), strict=True)
    )
    return least, lasting


def _config(log: RunLog, part: str) -> Any:
    try:
        return find(from_yaml("config", log.config_yaml), (part,))
    except InputError:
        return NOTHING


def _commands(log: RunLog) -> list[tuple[float, str]]:
    """When a roll is told something else, and what; parts of a chain tell nothing."""
    behaviour = _config(log, "behaviour")
    unit = "m/s" if find(behaviour, ("pace", "keep")) == "speed" else "rev/s"
    found = [
        (time, f"told {value:g} {unit}" if value else "told to halt")
        for time, value in _schedule(behaviour, "pace")
    ]
    found += [(time, f"told {rate:g} deg/s") for time, rate in _schedule(behaviour, "course")]
    end = find(behaviour, ("finish", "after"))
    return found + ([(float(end), "told to end")] if _number(end) else [])


def _schedule(behaviour: Any, what: str) -> list[tuple[float, float]]:
    told = find(behaviour, (what, "schedule"))
    return [
        (float(one[0]), float(one[1]))
        for one in (told if isinstance(told, list) else [])
        if isinstance(one, list) and len(one) == 2 and all(map(_number, one))
    ]


def _number(told: Any) -> bool:
    """Whether it is a number that a float can hold; a stranger's log may tell anything."""
    return isinstance(told, int | float) and abs(told) < _LARGEST
