"""The revolutions of a roll in numbers, each of which is the worst of all."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotctl.metrics.columns import Arrays, along_way, floats
from rotctl.metrics.turning import revolutions, turned_about, within

OF_REVOLUTIONS = (
    "slowest_revolution",
    "flight_turn",
    "trunk_turn",
    "axis_error",
    "travel_least",
    "travel_most",
)


def worst_revolutions(
    log: Arrays,
    direction: float,
    progress: NDArray[np.float64],
    axis: NDArray[np.float64],
    period: float,
    rolls: NDArray[np.bool_],
) -> dict[str, Any]:
    """The members of `RollingMetrics` about revolutions, which last for as many rows of `rolls`."""
    first, last = revolutions(progress)
    if not len(last):
        return dict.fromkeys(OF_REVOLUTIONS, math.nan)
    x = direction * along_way(log)[:, 0]
    about = floats(log, "trajectory/trunk_axis")
    turn = direction * turned_about(about, floats(log, "trajectory/qpos")[:, 3:7])
    in_air = ~floats(log, "contacts/ground_force").any(axis=1)
    in_flight = np.where(in_air, np.diff(progress, append=progress[-1]), 0.0)
    along = float((within(first, last, axis[:, 1]) / (last - first)).min())
    travel = x[last] - x[first]
    return {
        "slowest_revolution": float(within(first, last, rolls.astype(np.float64)).max() * period),
        "flight_turn": float(within(first, last, in_flight).max()),
        "trunk_turn": float((turn[last] - turn[first]).min()),
        "axis_error": math.degrees(math.acos(min(max(along, -1.0), 1.0))),
        "travel_least": float(travel.min()),
        "travel_most": float(travel.max()),
    }
