"""Getting up from the ground, in numbers: when it is up for good, and how it stands then."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.metrics.columns import Arrays, Column, floats
from rotctl.metrics.criteria import standing
from rotctl.settings.fields import STRICT, Positive, SomeNames

COLUMNS = (
    Column("up_from", "On its feet alone, upright and high enough from", "s"),
    Column("attempts", "Times that it began to get up, at least", ""),
    Column("lowest_in_the_end", "Lowest of the centre of mass in the end", "m"),
)


@validated(frozen=True, config=STRICT)
class GettingUpCriteria:
    """Limits of getting up; see `conf/criteria/getting_up.yaml`.

    Attributes:
        feet: bodies that may touch the ground once it is up.
        within: latest time from which it is up for good [s].
        rest: how long that must last, to the end of the run [s].
        height: least of the centre of mass above the ground meanwhile, a share of where it is in
            the body that stands upright, all its angles zero [-].
        lean: of the trunk meanwhile, at most [deg].
        speed: of the centre of mass over the last half of `rest`, at most [m/s].
    """

    name: str
    kind: Literal["getting_up"]
    feet: SomeNames
    within: Positive
    rest: Positive
    height: Positive
    lean: Positive
    speed: Positive
    description: str = ""


@dataclass(frozen=True)
class GettingUpMetrics:
    """What a log says of getting up; see `COLUMNS`. NaN where it has no rows, or never is up."""

    up_from: float
    attempts: int  # at least: a way that begins again in its first stage does not show in a log
    lowest_in_the_end: float
    lean_end: float
    speed_end: float


def measure(
    log: Arrays, criteria: GettingUpCriteria, period: float, upright: float
) -> GettingUpMetrics:
    """Measure a run.

    Args:
        period: of the control [s].
        upright: see `criteria.finish.upright` [m]; NaN where nobody knows, and any height
            will do.
    """
    com = floats(log, "trajectory/com")
    if not len(com):
        return GettingUpMetrics(math.nan, 0, math.nan, math.nan, math.nan)
    height = com[:, 2] - floats(log, "trajectory/ground_height")
    cosine = np.clip(floats(log, "trajectory/trunk_axes")[:, 2, 2], -1.0, 1.0)
    lean = np.degrees([math.acos(one) for one in cosine.tolist()])
    down = standing.on_others(log, criteria.feet)
    down |= (height <= criteria.height * upright) | (lean >= criteria.lean)
    row = int(np.flatnonzero(down)[-1]) + 1 if down.any() else 0
    velocity = floats(log, "trajectory/com_velocity")[-round(0.5 * criteria.rest / period) :]
    last = slice(-round(criteria.rest / period), None)
    stage = np.asarray(log["command/stage"])
    return GettingUpMetrics(
        up_from=row * period if row < len(com) else math.nan,
        attempts=1 + int((np.diff(stage) < 0).sum()),
        lowest_in_the_end=float(height[last].min()),
        lean_end=float(lean[last].max()),
        speed_end=float(np.sqrt((velocity**2).sum(axis=1)).max()),
    )


def judge(
    log: Arrays, criteria: GettingUpCriteria, period: float, upright: float
) -> tuple[Mapping[str, Any], str]:
    """Columns of a run, and why it is no success; empty if it is one. Arguments as of `measure`."""
    m, c = measure(log, criteria, period, upright), criteria
    steps = len(floats(log, "trajectory/time"))
    stood = steps * period - m.up_from
    rules = (
        (m.up_from == m.up_from, "is not on its feet in the end"),
        (m.up_from <= c.within, f"is up from {m.up_from:.2f} s only"),
        (stood > c.rest - 1e-6, f"the run ends {stood:.2f} s after it is up, not {c.rest:g}"),
        (m.speed_end < c.speed, f"still moves at {m.speed_end:.2f} m/s in the end"),
    )
    return vars(m), next((reason for kept, reason in rules if not kept), "")
