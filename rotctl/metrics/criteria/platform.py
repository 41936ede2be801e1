"""How near a dive comes to the platform that it leaves, on its way down from there."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from rotctl.metrics.columns import Arrays, floats, frame
from rotctl.metrics.criteria.flip import longest_flight

PLATFORM = 0.0  # [m] height of its top


class Corner(NamedTuple):
    """What a dive is to keep from.

    Attributes:
        ahead: (3,) the way from there to where nothing is, unit, world.
        end: how far that way it lies [m].
        floor: its height [m].
    """

    ahead: np.ndarray
    end: float
    floor: float


_Finder = Callable[[Arrays, int, np.ndarray], Corner]


def middle(log: Arrays, names: tuple[str, ...]) -> np.ndarray:
    """Mean place of watched points (steps, 3), world [m]."""
    tasks = [name.decode("utf-8", "replace") for name in np.asarray(log["model/task"]).tolist()]
    missing = np.asarray(log["command/error"])[:, [tasks.index(name) for name in names]]
    along = frame(log)
    away = sum(missing[..., i : i + 1] * along[i] for i in range(3))
    return np.asarray(floats(log, "trajectory/com") - np.mean(away, axis=1))


def _falling(log: Arrays, row: int, hands: bool) -> slice:
    """The rows of the way down to the entry in `row`.

    From the highest point of the flight on: before it the feet are still at the edge. Or, from the
    `hands`, from where the centre of mass is below the platform: they leave it last.
    """
    first, _ = longest_flight(log)
    heights = floats(log, "trajectory/com")[first:row, 2]
    return slice(first + int(np.argmax(heights < PLATFORM if hands else heights)), row)


def touched(log: Arrays, row: int, hands: bool = False) -> bool:
    """Whether anything touches it on the way down; nothing but the platform is there."""
    way = _falling(log, row, hands)
    return bool((np.asarray(log["contacts/body"])[way] >= 0).any())


def clearance(log: Arrays, row: int, sense: float, corner: _Finder, hands: bool = False) -> float:
    """How near the watched points come to a corner of the platform, or behind it [m].

    Who turns backward (`sense` -1) goes backward. Who was spawned in the air stood nowhere: NaN,
    and nothing is asked of it.
    """
    first, _ = longest_flight(log)
    if not first:
        return math.nan
    way = _falling(log, row, hands)
    ahead, end, floor = corner(log, first, sense * frame(log)[0])
    if math.isnan(end):
        return math.nan
    near, up = math.inf, frame(log)[2]
    for names in (("hand_l", "hand_r"), ("foot_l", "foot_r"), ("head",), ("pelvis",)):
        place = middle(log, names)[way]
        beyond = np.maximum((place * ahead).sum(axis=1) - end, 0.0)
        over = np.maximum((place * up).sum(axis=1) - floor, 0.0)
        near = min(near, float(np.sqrt(beyond**2 + over**2).min()))
    return near


def stood(log: Arrays, first: int, ahead: np.ndarray) -> Corner:
    """The foremost place that it last stood on.

    Args:
        first: row of the flight.
        ahead: (3,) the way that it goes.
    """
    places = np.asarray(log["contacts/position"])[first - 1]
    used = np.asarray(log["contacts/body"])[first - 1] >= 0
    end = max(float((place * ahead).sum()) for place in places[used])
    return Corner(ahead, end, float(places[used][0, 2]))


def edge(log: Arrays, first: int, ahead: np.ndarray) -> Corner:
    """Where the ground below the centre of mass falls away; an end of NaN if it never does.

    Half-way between the two steps around it, which is within half a step's way of it. Whoever goes
    over it aslant, it is a line across x.
    """
    falls = np.flatnonzero(np.diff(floats(log, "trajectory/ground_height")) < 0.0)
    x = floats(log, "trajectory/com")[falls[0] : falls[0] + 2, 0] if len(falls) else math.nan
    return Corner(np.array([1.0, 0.0, 0.0]), float(np.mean(x)), PLATFORM)
