"""Orientation control in numbers, [Brown2013] section 6: the trunk's turn, and if it rests."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.metrics.columns import Arrays, Column, floats, frame, in_frame
from rotctl.settings.fields import STRICT, Positive

COLUMNS = (
    Column("turned", "Turned about the long axis", "deg"),
    Column("turned_most", "Furthest towards the target", "deg"),
    Column("target_excursion", "Target", "deg"),
    Column("error_end", "Largest error over the time it is to rest", "deg"),
    Column("arrival", "Within the error for good from", "s"),
    Column("level_end", "Tilt of the long axis over the time it is to rest", "deg"),
    Column("sat_up", "Furthest that the long axis rose on the way", "deg"),
    Column("speed_end", "Fastest of the centre of mass over the time it is to rest", "m/s"),
)


@validated(frozen=True, config=STRICT)
class OrientationCriteria:
    """Limits of turning over; see `conf/criteria/orientation.yaml`.

    Attributes:
        error: of the trunk's turn against the target [deg].
        rest: how long at the end it holds [s].
        within: from the start, that it is within the error for good [s].
        level: tilt of the long axis meanwhile [deg].
        sat_up: that the long axis may rise on the way [deg]: sitting up is no turning over.
        speed: of the centre of mass at the end [m/s].
    """

    name: str
    kind: Literal["orientation"]
    error: Positive
    rest: Positive
    within: Positive
    level: Positive
    sat_up: Positive
    speed: Positive
    description: str = ""


@dataclass(frozen=True)
class OrientationMetrics:
    """What a log says of a turn; see `COLUMNS`. NaN where it has no rows."""

    turned: float
    turned_most: float
    target_excursion: float
    error_end: float
    arrival: float
    level_end: float
    sat_up: float
    speed_end: float


def measure(
    log: Arrays, criteria: OrientationCriteria, target: float, period: float
) -> OrientationMetrics:
    """Measure a run.

    Args:
        target: how far the trunk was to turn about left since the start [deg].
        period: of the control [s].
    """
    turned = trunk_turn(log)
    if not len(turned):
        return OrientationMetrics(*[math.nan] * len(COLUMNS))
    error = np.abs(turned - target)
    late = np.flatnonzero(error > criteria.error)
    sine = np.clip(np.abs(in_frame(log, "trajectory/trunk_axis")[:, 2]), 0, 1)
    rise = np.degrees([math.asin(one) for one in sine.tolist()])
    speed = np.sqrt((floats(log, "trajectory/com_velocity") ** 2).sum(axis=1))
    last = slice(-round(criteria.rest / period), None)
    return OrientationMetrics(
        turned=float(turned[-1]),
        turned_most=float(turned.max() if target >= 0 else turned.min()),
        target_excursion=target,
        error_end=float(error[last].max()),
        arrival=float((late[-1] + 1) * period) if len(late) else 0.0,
        level_end=float(rise[last].max()),
        sat_up=float(rise.max()),
        speed_end=float(speed[last].max()),
    )


def trunk_turn(log: Arrays) -> np.ndarray:
    """How far the trunk's front has turned about left since the posture it began in (steps,) [deg].

    What the start is off that posture counts, as a target is for the posture.
    """
    forward, _, up = frame(log)
    front = floats(log, "trajectory/trunk_axes")[:, :, 0]
    pairs = zip((front * forward).sum(axis=1), (front * up).sum(axis=1), strict=True)
    angle = np.unwrap(np.array([math.atan2(f, u) for f, u in pairs]))
    begin = floats(log, "trajectory/phase")[:1]
    whole = math.tau * np.round((angle[:1] - begin) / math.tau)
    return np.asarray(np.degrees(angle - begin - whole))


def failure(metrics: OrientationMetrics, criteria: OrientationCriteria, duration: float) -> str:
    """Why it is no turn to the target; empty if it is one. `duration` is the run's [s]."""
    m, c = metrics, criteria
    short = f"turned {m.turned:.0f} deg of {m.target_excursion:.0f}"
    if abs(m.turned - m.target_excursion) < c.error:
        short += f", but {duration - m.arrival:.2f} s before the end only"
    rules = (
        (m.error_end < c.error, short),
        (m.arrival <= c.within, f"turned in {m.arrival:.1f} s, is to in {c.within:g}"),
        (m.sat_up < c.sat_up, f"sat up by {m.sat_up:.0f} deg on the way"),
        (m.level_end < c.level, f"lies {m.level_end:.0f} deg off level at the end"),
        (m.speed_end < c.speed, f"still moves at {m.speed_end:.2f} m/s at the end"),
        (duration > c.rest - 1e-6, f"ends after {duration:.2f} s, is to rest for {c.rest:g}"),
    )
    return next((reason for kept, reason in rules if not kept), "")
