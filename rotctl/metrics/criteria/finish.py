"""A roll that ends standing, in numbers: it rolls until it is told to end, and then stays up."""

import math
from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import Any, Literal, NamedTuple

import mujoco
import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.caching import kept
from rotctl.metrics.columns import Arrays, Column, floats
from rotctl.metrics.criteria import rolling, standing
from rotctl.metrics.criteria.rolling import RollingCriteria
from rotctl.metrics.criteria.rolling_rules import failure_reason
from rotctl.metrics.criteria.standing import StandingCriteria
from rotctl.metrics.excerpt import Excerpt
from rotctl.metrics.halts import Halts
from rotctl.settings.fields import STRICT, Positive

ROOT = 1  # the character's first body
HALF = 0.5  # [rev] off the number that is wanted is another number

COLUMNS = (
    Column("finish_commanded", "Told to end on its feet", "s"),
    Column("revolutions_commanded", "Rolls that it is to make", "rev"),
    Column("revolutions_told", "Told to end on its feet after", "rev"),
    Column("told_at", "Was told so at", "s"),
    Column("stands_from", "Begins to stand up", "s"),
    Column("stands_at", "Height of the centre of mass in the end", "m"),
    Column("lean_end", "Largest lean of the trunk in the end", "deg"),
    Column("speed_end", "Fastest of the centre of mass over the time it is to rest", "m/s"),
)


@validated(frozen=True, config=STRICT)
class FinishCriteria:
    """Limits of a roll that ends standing; see `conf/criteria/finish.yaml`.

    Attributes:
        roll: of what is rolled, see `Rolled`.
        stand: of its rest on the feet in the end.
        height: least of the centre of mass above the ground then, a share of where it is in the
            body that stands upright, all its angles zero [-].
    """

    name: str
    kind: Literal["finish"]
    roll: RollingCriteria
    stand: StandingCriteria
    height: Positive
    description: str = ""


class Rolled(NamedTuple):
    """What of a run is the roll.

    Attributes:
        log: its rows: until it is told to end, or, of a roll that is counted, stands up.
        told: when it is told to end [s]; infinite for one that is counted and was not.
    """

    log: Arrays
    told: float


def rolled(log: Arrays, commanded: Mapping[str, float]) -> Rolled:
    """What of a run is the roll, by what was asked for; see `RollingSettings.commanded`."""
    time, told = floats(log, "trajectory/time"), commanded["finish_commanded"]
    if "revolutions_told" not in commanded:
        return Rolled(Excerpt(log, slice(0, int(np.searchsorted(time, told)))), told)
    turned = floats(log, "trajectory/phase") >= math.tau * commanded["revolutions_told"]
    rows = np.flatnonzero((time >= told) & turned)
    roll = Excerpt(log, slice(0, begins(log)))
    return Rolled(roll, float(time[rows[0]]) if len(rows) else math.inf)


def begins(log: Arrays) -> int:
    """The row in which it begins to stand up; the number of rows, if it never does."""
    ends = np.asarray(log["command/stage"]) > 0
    return int(np.argmax(ends)) if ends.any() else len(ends)


@kept(most=8)
def upright(mj: mujoco.MjModel) -> float:
    """Height of the centre of mass where a character stands with all its angles zero [m]."""
    data = mujoco.MjData(mj)
    mujoco.mj_kinematics(mj, data)
    mujoco.mj_comPos(mj, data)
    return float(data.subtree_com[ROOT, 2])


def miscounted(revolutions: float, wanted: float) -> str:
    """That it has not rolled as often as it was to; any number is right where none is wanted."""
    if not wanted or abs(revolutions - wanted) < HALF:
        return ""
    return f"rolled {revolutions:.1f} of {wanted:g} revolutions"


def judge(
    log: Arrays,
    criteria: FinishCriteria,
    commanded: Mapping[str, float],
    period: float,
    upright: float,
    whole: bool,
    halts: Halts = (),
) -> tuple[dict[str, Any], str]:
    """Columns of a run, and why it is no success; empty if it is one.

    Args:
        commanded: what was asked for; see `RollingSettings.commanded`.
        period: of the control [s].
        upright: see the function of that name [m]; NaN where nobody knows, and any height will do.
        whole: whether the run went on for as long as it was to.
        halts: when it is told to halt, and until when [s].
    """
    row, steps = begins(log), len(np.asarray(log["command/stage"]))
    counted = commanded.get("revolutions_commanded", 0.0)
    part, told = rolled(log, commanded)
    direction = commanded.get("angular_velocity_commanded", 1.0)  # a pace is forward
    roll = rolling.measure(part, criteria.roll, direction, period, whole, halts)
    rest = max(row, steps - round(criteria.stand.rest / period))
    end = Excerpt(log, slice(rest, None))
    settings = replace(criteria.stand, height=1e-3)  # of what it was at first: a squat
    stood = standing.measure(end, settings, period)
    com, ground = floats(end, "trajectory/com"), floats(end, "trajectory/ground_height")
    height = float((com[:, 2] - ground).min()) if len(com) else math.nan
    reason = (
        failure_reason(roll, criteria.roll, roll.duration)
        or ("never stood up" if row == steps else "")
        or miscounted(roll.revolutions, counted)
        or standing.failure(stood, settings, (steps - rest) * period)
        or (f"stands {height:.2f} m high" if height <= criteria.height * upright else "")
    )
    columns = asdict(roll) | {"duration": steps * period}
    del columns["stalled_at"], columns["went_on"]  # of people's interest in a reason alone
    ended = {
        "stands_from": row * period if row < steps else math.nan,
        "stands_at": height,
        "lean_end": stood.lean_end,
        "speed_end": stood.speed_end,
    }
    return columns | ended | ({"told_at": told} if counted else {}), reason
