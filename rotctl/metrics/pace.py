"""How near a roll comes to the velocities that it is commanded."""

import math
from collections.abc import Mapping

import numpy as np

from rotctl.metrics.columns import Arrays, Column, in_frame
from rotctl.metrics.quantile import median
from rotctl.metrics.turning import revolutions

COLUMNS = (
    Column("rate_error", "Angular velocity off the command, of it", ""),
    Column("speed_error", "Speed off the command, of it", ""),
    Column("revolution_error", "A revolution's rate off the command, of it", ""),
    Column("travel_mean", "Way in a revolution", "m"),
)


def measure(
    log: Arrays, means: tuple[float, float], commanded: Mapping[str, float], settle: float
) -> dict[str, float]:
    """The columns, the errors as shares of what is commanded; NaN where no number is.

    Args:
        log: arrays by schema path; may have no rows.
        means: in-plane angular velocity [rev/s] and speed [m/s] of the run.
        commanded: the same as they were asked for; see `RollingSettings.commanded`.
        settle: time at the start that is left out of the revolutions [s].
    """
    rate, speed = means
    wanted = commanded.get("angular_velocity_commanded", math.nan)
    time = np.asarray(log["trajectory/time"])
    rows = time >= settle
    turned = in_frame(log, "trajectory/angular_excursion")[rows, 1] / (2 * math.pi)
    each = np.array([math.nan])
    if wanted and len(turned):
        first, last = revolutions(math.copysign(1.0, wanted) * turned)
        if len(last):
            each = np.abs(1.0 / (time[rows][last] - time[rows][first]) - abs(wanted)) / abs(wanted)
    return {
        "rate_error": off(rate, wanted),
        "speed_error": off(speed, commanded.get("speed_commanded", math.nan)),
        "revolution_error": median(each),
        "travel_mean": abs(speed / rate) if rate else math.nan,
    }


def off(value: float, commanded: float) -> float:
    """How far a value is off what is commanded, as a share of it; NaN where that is nothing."""
    return abs(value - commanded) / abs(commanded) if commanded else math.nan
