"""A run that stands, or lands and stands, in numbers: on what, how upright, how still."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.metrics.columns import Arrays, Column, floats, in_frame
from rotctl.settings.fields import STRICT, Positive, SomeNames

COLUMNS = (
    Column("lean_most", "Largest lean of the trunk", "deg"),
    Column("lean_end", "Largest lean of the trunk in the end", "deg"),
    Column("sway", "Furthest of the centre of mass from where it began", "m"),
    Column("speed_end", "Fastest of the centre of mass over the time it is to rest", "m/s"),
    Column("other_contact", "Time with anything but the feet on the ground", "s"),
    Column("stature_least", "Lowest of the centre of mass, as a share of its height at first", ""),
    Column("stature_end", "Lowest of it in the end, as a share of that", ""),
)


@validated(frozen=True, config=STRICT)
class StandingCriteria:
    """Limits of standing and landing; see `conf/criteria/standing.yaml` and `landing.yaml`.

    Attributes:
        kind: who stands may never be lower than `height`, who lands may crouch before the end.
        feet: bodies that may touch the ground.
        rest: how long it is upright and still in the end [s].
        height: least height of the centre of mass, as a share of that at the start [-].
        lean: of the trunk in the end [deg].
        speed: of the centre of mass in the end [m/s].
    """

    name: str
    kind: Literal["standing", "landing"]
    feet: SomeNames
    rest: Positive
    height: Positive
    lean: Positive
    speed: Positive
    description: str = ""


@dataclass(frozen=True)
class StandingMetrics:
    """What a log says of standing; see `COLUMNS`. NaN where it has no rows."""

    lean_most: float
    lean_end: float
    sway: float
    speed_end: float
    other_contact: float
    stature_least: float
    stature_end: float


def measure(log: Arrays, criteria: StandingCriteria, period: float) -> StandingMetrics:
    """Measure a run; `period` is the control's [s]."""
    com = in_frame(log, "trajectory/com")
    if not len(com):
        return StandingMetrics(*[math.nan] * len(COLUMNS))
    up = floats(log, "trajectory/trunk_axes")[:, 2, 2]
    lean = np.degrees([math.acos(one) for one in np.clip(up, -1.0, 1.0).tolist()])
    velocity = floats(log, "trajectory/com_velocity")
    speed = np.sqrt((velocity**2).sum(axis=1))
    height = com[:, 2] - floats(log, "trajectory/ground_height")
    sway = np.sqrt(((com[:, :2] - com[0, :2]) ** 2).sum(axis=1))
    last = slice(-round(criteria.rest / period), None)
    return StandingMetrics(
        lean_most=float(lean.max()),
        lean_end=float(lean[last].max()),
        sway=float(sway.max()),
        speed_end=float(speed[last].max()),
        other_contact=float(on_others(log, criteria.feet).sum() * period),
        stature_least=float(height.min() / height[0]),
        stature_end=float(height[last].min() / height[0]),
    )


def upright_from(log: Arrays, criteria: StandingCriteria) -> int:
    """The row from which on it is upright, still and on its feet alone; past the last if none."""
    up = np.clip(floats(log, "trajectory/trunk_axes")[:, 2, 2], -1.0, 1.0)
    lean = np.degrees([math.acos(one) for one in up.tolist()])
    speed = np.sqrt((floats(log, "trajectory/com_velocity") ** 2).sum(axis=1))
    moves = (lean >= criteria.lean) | (speed >= criteria.speed)
    off = np.flatnonzero(moves | on_others(log, criteria.feet))
    return int(off[-1]) + 1 if len(off) else 0


def on_others(log: Arrays, feet: tuple[str, ...]) -> np.ndarray:
    """(steps,) whether anything but these bodies touches the ground."""
    others = ~np.isin(np.asarray(log["contacts/body"]), _allowed(_names(log), feet))
    return np.asarray(others.any(axis=1))


def others(log: Arrays, feet: tuple[str, ...]) -> list[str]:
    """Names of all but these bodies that touch the ground at some time, as the model has them."""
    names, bodies = _names(log), np.unique(np.asarray(log["contacts/body"])).tolist()
    allowed = _allowed(names, feet)
    return [names[body] for body in bodies if body not in allowed]


def _names(log: Arrays) -> list[str]:
    return [name.decode("utf-8", "replace") for name in np.asarray(log["model/body"]).tolist()]


def _allowed(names: Sequence[str], feet: tuple[str, ...]) -> list[int]:
    return [-1, *(i for i, name in enumerate(names) if name in feet)]


def failure(
    metrics: StandingMetrics,
    criteria: StandingCriteria,
    duration: float,
    touched: Sequence[str] = (),
) -> str:
    """Why it did not stay up; empty if it did.

    Args:
        duration: of the run [s].
        touched: what came down and may not, see `others`; is named where more than feet may.
    """
    m, c = metrics, criteria
    feet = all(name.startswith("foot") for name in c.feet)
    what = "more than the feet" if feet else f"{', '.join(touched)}, which may not,"
    low = m.stature_least if c.kind == "standing" else m.stature_end
    rules = (
        (m.other_contact == 0.0, f"touched the ground with {what} for {m.other_contact:.2f} s"),
        (low > c.height, f"sank to {low:.2f} of its height"),
        (m.lean_end < c.lean, f"leans by {m.lean_end:.0f} deg at the end"),
        (m.speed_end < c.speed, f"still moves at {m.speed_end:.2f} m/s at the end"),
        (duration > c.rest - 1e-6, f"ends after {duration:.2f} s, is to rest for {c.rest:g}"),
    )
    return next((reason for kept, reason in rules if not kept), "")
