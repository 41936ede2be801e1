"""A somersault in numbers: how far it turned, how it flew, and whether it stands."""

import math
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.metrics import peaks
from rotctl.metrics.columns import Arrays, Column, floats, frame
from rotctl.metrics.criteria import standing
from rotctl.metrics.criteria.standing import StandingCriteria
from rotctl.settings.fields import STRICT, Positive

HOP = 0.1  # [s] without a contact that is no flight
COLUMNS = (
    Column("revolved", "Turned about the axis", "deg"),
    Column("flight_time", "Longest time in the air", "s"),
    Column("take_off_speed", "Upward speed of the centre of mass at take-off", "m/s"),
    Column("take_off_momentum", "Angular momentum about the axis at take-off", "kg m2/s"),
)


@validated(frozen=True, config=STRICT)
class FlipCriteria:
    """Limits of a somersault; see `conf/criteria/flip.yaml`.

    Attributes:
        turn: how far the trunk's turn may be off the target in the end [deg].
        about: what it turns about.
        flight: least time in the air [s]: a somersault is no roll.
        landing: what counts as standing in the end.
    """

    name: str
    kind: Literal["flip"]
    turn: Positive
    flight: Positive
    landing: StandingCriteria
    about: Literal["left", "up"] = "left"
    description: str = ""


@dataclass(frozen=True)
class FlipMetrics:
    """What a log says of a somersault; see `COLUMNS`. NaN where it has no rows."""

    revolved: float
    flight_time: float
    take_off_speed: float
    take_off_momentum: float


def judge(
    log: Arrays, criteria: FlipCriteria, target: float, period: float
) -> tuple[dict[str, Any], str]:
    """Columns of a run, and why it is no success; empty if it is one.

    Args:
        target: to turn [deg].
        period: of the control [s].
    """
    flip = measure(log, criteria, period)
    stood = standing.measure(log, criteria.landing, period)
    duration = len(floats(log, "trajectory/time")) * period
    reason = standing.failure(stood, criteria.landing, duration)
    if not abs(flip.revolved - target) < criteria.turn:
        reason = f"turned {flip.revolved:.0f} deg of {target:g}"
    elif not flip.flight_time > criteria.flight:
        reason = f"was in the air for {flip.flight_time:.2f} s"
    worked = peaks.measure(log, longest_flight(log)[1])
    return {**asdict(stood), **asdict(flip), **worked}, reason


def measure(log: Arrays, criteria: FlipCriteria, period: float) -> FlipMetrics:
    """Measure a run; `period` is the control's [s]."""
    turned = turn(log, criteria.about)
    if not len(turned):
        return FlipMetrics(*[math.nan] * len(COLUMNS))
    first, last = longest_flight(log)
    axis = frame(log)[1 if criteria.about == "left" else 2]
    momentum = floats(log, "trajectory/angular_momentum")[first]
    return FlipMetrics(
        revolved=float(turned[-1]),
        flight_time=(last - first) * period,
        take_off_speed=float(floats(log, "trajectory/com_velocity")[first, 2]),
        take_off_momentum=float((momentum * axis).sum()),
    )


def turn(log: Arrays, about: Literal["left", "up", "forward"] = "left") -> np.ndarray:
    """How far the trunk has turned since the start (steps,) [deg]."""
    forward, left, up = frame(log)
    start, aside = {"left": (forward, -up), "up": (forward, left), "forward": (up, -left)}[about]
    axis = floats(log, "trajectory/trunk_axes")[:, :, 2 if about == "forward" else 0]
    pairs = zip((axis * start).sum(axis=1), (axis * aside).sum(axis=1), strict=True)
    angle = np.unwrap(np.array([math.atan2(u, f) for f, u in pairs]))
    return np.asarray(np.degrees(angle - angle[:1]))


def longest_flight(log: Arrays) -> tuple[int, int]:
    """The row in which the longest time without contacts begins, and the row after it."""
    flying = np.asarray(log["contacts/count"]) == 0
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flying, [False])).astype(int)))
    if not len(edges):
        return 0, 0
    best = int(np.argmax(edges[1::2] - edges[::2]))
    return int(edges[2 * best]), int(edges[2 * best + 1])
