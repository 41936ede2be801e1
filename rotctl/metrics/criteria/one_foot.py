"""A turn on one foot in numbers: how far on that foot alone, and whether it stands in the end."""

import math
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.metrics.columns import Arrays, Column, floats
from rotctl.metrics.criteria import flip, standing
from rotctl.metrics.criteria.standing import StandingCriteria
from rotctl.settings.fields import STRICT, Positive

COLUMNS = (
    Column("turned_alone", "Turned on one foot alone", "deg"),
    Column("lean_alone", "Largest lean of the trunk meanwhile", "deg"),
)


@validated(frozen=True, config=STRICT)
class OneFootCriteria:
    """Limits of a turn on one foot; see `conf/criteria/pirouette_one_foot.yaml`.

    Attributes:
        turn: how far the trunk's turn may be off the target in the end [deg].
        alone: share of the target that it is to turn in one piece with one foot alone on the
            ground, always the same one [-].
        hop: longest without any ground [s]: a foot that turns slides and may skip, and what is
            longer is a jump.
        lean: of the trunk on one foot [deg].
        landing: what counts as standing in the end.
    """

    name: str
    kind: Literal["one_foot"]
    turn: Positive
    alone: Positive
    hop: Positive
    lean: Positive
    landing: StandingCriteria
    description: str = ""


@dataclass(frozen=True)
class OneFootMetrics:
    """What a log says of a turn on one foot; NaN where it has no rows."""

    revolved: float
    flight_time: float
    turned_alone: float
    lean_alone: float


def judge(
    log: Arrays, criteria: OneFootCriteria, target: float, period: float
) -> tuple[dict[str, Any], str]:
    """Columns of a run, and why it is no success; empty if it is one.

    Args:
        target: to turn about up [deg].
        period: of the control [s].
    """
    found = measure(log, criteria, target, period)
    stood = standing.measure(log, criteria.landing, period)
    duration = len(floats(log, "trajectory/time")) * period
    reason = standing.failure(stood, criteria.landing, duration)
    least = criteria.alone * abs(target)
    if not abs(found.revolved - target) < criteria.turn:
        reason = f"turned {found.revolved:.0f} deg of {target:g}"
    elif not found.flight_time < criteria.hop:
        reason = f"was in the air for {found.flight_time:.2f} s"
    elif not found.turned_alone >= least:
        reason = f"turned {found.turned_alone:.0f} deg on one foot, is to turn {least:.0f}"
    elif not found.lean_alone < criteria.lean:
        reason = f"leaned by {found.lean_alone:.0f} deg on one foot"
    return {**asdict(stood), **asdict(found)}, reason


def measure(log: Arrays, criteria: OneFootCriteria, target: float, period: float) -> OneFootMetrics:
    """Measure a run; `target` [deg], `period` of the control [s]."""
    turned = flip.turn(log, "up")
    if not len(turned):
        return OneFootMetrics(*[math.nan] * 4)
    first, last = flip.longest_flight(log)
    alone, rows = 0.0, slice(0, 0)
    for foot in criteria.landing.feet:
        for begin, end in _pieces(_alone(log, foot, criteria.hop, period)):
            way = math.copysign(1.0, target) * float(turned[end - 1] - turned[begin])
            if way > alone:
                alone, rows = way, slice(begin, end)
    up = np.clip(floats(log, "trajectory/trunk_axes")[rows, 2, 2], -1.0, 1.0)
    lean = math.degrees(math.acos(float(up.min()))) if len(up) else math.nan
    return OneFootMetrics(float(turned[-1]), (last - first) * period, alone, lean)


def _alone(log: Arrays, foot: str, hop: float, period: float) -> np.ndarray:
    """(steps,) whether this foot alone bears the body; a skip of less than `hop` [s] counts."""
    borne = np.asarray(log["contacts/count"]) > 0
    only = borne & ~standing.on_others(log, (foot,))
    for begin, end in _pieces(~borne):
        if begin > 0 and end < len(only) and (end - begin) * period < hop:
            only[begin:end] = only[begin - 1] and only[end]
    return only


def _pieces(holds: np.ndarray) -> list[tuple[int, int]]:
    """First rows of the pieces in which something holds (steps,), and the rows after them."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], holds, [False])).astype(int)))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))
