"""The verdict of a run by its criteria: one kind of criteria for each class of motion."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import mujoco
import numpy as np
from pydantic import Field

from rotctl.metrics import (
    acrobatic,
    appearance,
    disturbed,
    dive,
    early,
    finish,
    flip,
    getting_up,
    orientation,
    pace,
    peaks,
    rolling,
    standing,
)
from rotctl.metrics.acrobatic import AcrobaticCriteria
from rotctl.metrics.columns import Arrays, floats, solver_failures
from rotctl.metrics.dive import DiveCriteria
from rotctl.metrics.finish import FinishCriteria
from rotctl.metrics.flip import FlipCriteria
from rotctl.metrics.getting_up import GettingUpCriteria
from rotctl.metrics.halts import Halts
from rotctl.metrics.orientation import OrientationCriteria
from rotctl.metrics.quantile import percentile
from rotctl.metrics.rolling import RollingCriteria
from rotctl.metrics.rolling_rules import failure_reason
from rotctl.metrics.standing import StandingCriteria

Criteria = Annotated[
    AcrobaticCriteria
    | DiveCriteria
    | FinishCriteria
    | FlipCriteria
    | GettingUpCriteria
    | OrientationCriteria
    | RollingCriteria
    | StandingCriteria,
    Field(discriminator="kind"),
]
_KINDS = (
    rolling,
    appearance,
    pace,
    standing,
    orientation,
    flip,
    dive,
    peaks,
    finish,
    acrobatic,
    getting_up,
    disturbed,
)
COLUMNS = {column.name: column for kind in _KINDS for column in kind.COLUMNS}


@dataclass(frozen=True)
class Judgement:
    """A run in numbers.

    Attributes:
        reason: why it is no success; empty if it is one.
        columns: of the summary row, by name.
    """

    reason: str
    columns: dict[str, Any]


def judge(
    log: Arrays,
    criteria: Criteria,
    commanded: Mapping[str, float],
    period: float,
    wanted: float,
    mj: mujoco.MjModel | None = None,
    halts: Halts = (),
) -> Judgement:
    """Judge a run.

    Args:
        log: arrays by schema path, a `RunLog` or a buffer's; may have no rows.
        commanded: columns that tell what was asked for.
        period: of the control [s].
        wanted: how long the run was to be [s].
        mj: what was simulated; without it nobody sees what a roll looks like, nor how high it
            stands in the end for its size.
        halts: when a roll is told to halt, and until when [s].
    """
    steps = len(floats(log, "trajectory/time"))
    failures = solver_failures(log)
    asked = dict(commanded)
    upright = math.nan if mj is None else finish.upright(mj)
    if isinstance(criteria, RollingCriteria | FinishCriteria):
        direction = commanded.get("angular_velocity_commanded", 1.0)  # a pace is forward
        if isinstance(criteria, FinishCriteria):
            found, reason = finish.judge(log, criteria, commanded, period, upright, halts)
            rolling_log = finish.rolled(log, commanded["finish_commanded"])
            settle = criteria.roll.settle
        else:
            rolled = rolling.measure(log, criteria, direction, period, halts)
            found, reason = dict(vars(rolled)), failure_reason(rolled, criteria, wanted)
            del found["stalled_at"], found["went_on"]  # of people's interest in a reason alone
            rolling_log, settle = log, criteria.settle
        found |= vars(appearance.measure(rolling_log, mj, direction, period))
        means = found["angular_velocity_mean"], found["speed_mean"]
        found |= pace.measure(rolling_log, means, commanded, settle)
    elif isinstance(criteria, StandingCriteria):
        stood, asked = standing.measure(log, criteria, period), {}
        found, reason = dict(vars(stood)), standing.failure(stood, criteria, steps * period)
    elif isinstance(criteria, DiveCriteria):
        found, reason = dive.judge(log, criteria, commanded["target_excursion"], period)
    elif isinstance(criteria, AcrobaticCriteria):
        found, reason = acrobatic.judge(log, criteria, commanded["target_excursion"], period)
    elif isinstance(criteria, FlipCriteria):
        found, reason = flip.judge(log, criteria, commanded["target_excursion"], period)
    elif isinstance(criteria, GettingUpCriteria):
        up, reason = getting_up.judge(log, criteria, period, upright)
        found, asked = dict(up), {}
    else:
        turned = orientation.measure(log, criteria, commanded["target_excursion"], period)
        found, reason = dict(vars(turned)), orientation.failure(turned, criteria, steps * period)
    if reason and steps:
        reason = early.too_short(log, criteria, commanded, found, period) or reason
    if steps * period < wanted - 1e-6:
        reason = f"ended after {steps * period:.2f} of {wanted:g} s"
    elif failures:
        reason = f"every solver failed on {failures} control steps"
    torque = found["torque_p99_fraction"] if "torque_p99_fraction" in found else _torque(log)
    common = {"duration": steps * period, "torque_p99_fraction": torque}
    return Judgement(reason, {**common, **found, **asked, "solver_failures": failures})


def _torque(log: Arrays) -> float:
    """99th percentile of |torque| / limit over joints and time; NaN without rows."""
    torque = np.abs(floats(log, "trajectory/ctrl"))
    return percentile(torque / floats(log, "model/torque_limit"), 99) if len(torque) else math.nan
