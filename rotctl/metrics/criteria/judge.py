"""The verdict of a run by its criteria."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from rotctl.metrics import appearance, pace
from rotctl.metrics import halts as told_to
from rotctl.metrics.columns import Arrays, floats, no_room, solver_failures
from rotctl.metrics.criteria import (
    acrobatic,
    chain,
    dive,
    early_end,
    finish,
    flip,
    getting_up,
    one_foot,
    orientation,
    rolling,
    standing,
)
from rotctl.metrics.criteria.acrobatic import AcrobaticCriteria
from rotctl.metrics.criteria.chain import Link
from rotctl.metrics.criteria.dive import DiveCriteria
from rotctl.metrics.criteria.finish import FinishCriteria
from rotctl.metrics.criteria.flip import FlipCriteria
from rotctl.metrics.criteria.getting_up import GettingUpCriteria
from rotctl.metrics.criteria.kinds import ChainCriteria, Criteria
from rotctl.metrics.criteria.one_foot import OneFootCriteria
from rotctl.metrics.criteria.rolling import RollingCriteria
from rotctl.metrics.criteria.rolling_rules import failure_reason
from rotctl.metrics.criteria.standing import StandingCriteria
from rotctl.metrics.halts import Halts
from rotctl.metrics.quantile import percentile


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
    links: Sequence[Link] = (),
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
        links: what was asked of the parts of a chain.
    """
    steps = len(floats(log, "trajectory/time"))
    whole = steps * period >= wanted - 1e-6
    failures = solver_failures(log)
    asked = dict(commanded)
    upright = math.nan if mj is None else finish.upright(mj)
    if isinstance(criteria, ChainCriteria):
        found, reason = _chained(log, criteria, period, mj, links)
    elif isinstance(criteria, RollingCriteria | FinishCriteria):
        direction = commanded.get("angular_velocity_commanded", 1.0)  # a pace is forward
        if isinstance(criteria, FinishCriteria):
            found, reason = finish.judge(log, criteria, commanded, period, upright, whole, halts)
            rolling_log = finish.rolled(log, commanded).log
            settle, stall = criteria.roll.settle, criteria.roll.stall_progress
        else:
            rolled = rolling.measure(log, criteria, direction, period, whole, halts)
            found, reason = dict(vars(rolled)), failure_reason(rolled, criteria, wanted)
            del found["stalled_at"], found["went_on"]  # of people's interest in a reason alone
            rolling_log, settle, stall = log, criteria.settle, criteria.stall_progress
        found |= told_to.measure(rolling_log, halts, stall, period)
        found |= vars(appearance.measure(rolling_log, mj, direction, period))
        means = found["angular_velocity_mean"], found["speed_mean"]
        found |= pace.measure(rolling_log, means, commanded, settle)
    elif isinstance(criteria, StandingCriteria):
        stood, asked = standing.measure(log, criteria, period), {}
        touched = standing.others(log, criteria.feet)
        reason = standing.failure(stood, criteria, steps * period, touched)
        found = dict(vars(stood))
    elif isinstance(criteria, DiveCriteria):
        found, reason = dive.judge(log, criteria, commanded["target_excursion"], period)
    elif isinstance(criteria, AcrobaticCriteria):
        found, reason = acrobatic.judge(log, criteria, commanded["target_excursion"], period)
    elif isinstance(criteria, FlipCriteria):
        found, reason = flip.judge(log, criteria, commanded["target_excursion"], period)
    elif isinstance(criteria, OneFootCriteria):
        found, reason = one_foot.judge(log, criteria, commanded["target_excursion"], period)
    elif isinstance(criteria, GettingUpCriteria):
        up, reason = getting_up.judge(log, criteria, period, upright)
        found, asked = dict(up), {}
    else:
        turned = orientation.measure(log, criteria, commanded["target_excursion"], period)
        found, reason = dict(vars(turned)), orientation.failure(turned, criteria, steps * period)
    if reason and steps and not isinstance(criteria, ChainCriteria):
        reason = early_end.too_short(log, criteria, commanded, found, period) or reason
    if not whole:
        reason = f"ended after {steps * period:.2f} of {wanted:g} s"
    elif failures:
        reason = f"every solver failed on {failures} control steps"
    else:
        reason = no_room(log, period) or reason
    torque = found["torque_p99_fraction"] if "torque_p99_fraction" in found else _torque(log)
    common = {"duration": steps * period, "torque_p99_fraction": torque}
    return Judgement(reason, {**common, **found, **asked, "solver_failures": failures})


def _chained(
    log: Arrays,
    criteria: ChainCriteria,
    period: float,
    mj: mujoco.MjModel | None,
    links: Sequence[Link],
) -> tuple[dict[str, Any], str]:
    """Columns of a chain, and why it is no success; empty if each of its parts is one."""
    parts = chain.spans(log, [link.stages for link in links])
    rows, reasons = len(floats(log, "trajectory/time")), []
    for part, own, link in zip(parts, criteria.parts, links, strict=False):
        first, end = part.rows.start, part.rows.stop
        wanted = (end - first) * period
        made = judge(part, own, link.commanded, period, wanted, mj, link.halts)
        reasons.append(early_end.of_a_part(made.reason, first * period, end * period, end < rows))
    found = {
        "parts_succeeded": sum(not reason for reason in reasons),
        "parts_begun": len(parts),
        "parts": chain.told(log, links, parts, reasons),
    }
    for number, (link, reason) in enumerate(zip(links, reasons, strict=False), 1):
        if reason:
            last = number == len(parts) < len(links) and reason.startswith(early_end.ENDS)
            left = ", ".join(link.name for link in links[number:]) if last else ""
            more = f", and then {left}" if left else ""
            return found, f"part {number} of {len(links)}, {link.name}: {reason}{more}"
    if len(parts) < len(links):
        number = len(parts) + 1
        return found, f"part {number} of {len(links)}, {links[len(parts)].name}, has not begun"
    return found, ""


def _torque(log: Arrays) -> float:
    """99th percentile of |torque| / limit over joints and time; NaN without rows."""
    torque = np.abs(floats(log, "trajectory/ctrl"))
    return percentile(torque / floats(log, "model/torque_limit"), 99) if len(torque) else math.nan
