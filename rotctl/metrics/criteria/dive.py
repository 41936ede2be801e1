"""A dive in numbers: how the body enters the water, and how far it kept from the platform.

The log holds where the watched points are, as seen from the centre of mass: `hand_l` and the like
are tasks of kind point with the aim `watch`, whose error is the way from there to it.
"""

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.metrics import peaks
from rotctl.metrics.columns import Arrays, Column, floats, frame
from rotctl.metrics.criteria.acrobatic import HeldCriteria, longest_held
from rotctl.metrics.criteria.flip import HOP, longest_flight, turn
from rotctl.settings.fields import STRICT, Finite, Positive

PLATFORM = 0.0  # [m] height of its top
WATCHED = ("hand", "foot", "head", "pelvis")  # tasks whose points are told, on both sides
Corner = Callable[[Arrays, int, np.ndarray], tuple[float, float]]
NEAREST = 90.0  # [deg] off the target: beyond, another number of half revolutions is nearer
COLUMNS = (
    Column("entry_angle", "Line from the feet to the hands off the vertical at entry", "deg"),
    Column("entry_sag", "The part of it in the plane of the dive", "deg"),
    Column("bent_most", "Joint furthest off the straight pose at entry", "deg"),
    Column("clearance", "Nearest to where it last stood, on the way down", "m"),
    Column("edge_clearance", "Nearest to the platform's edge, on the way down", "m"),
    Column("entry_time", "Time of the entry", "s"),
)


@validated(frozen=True, config=STRICT)
class DiveCriteria:
    """Limits of a dive; see `conf/criteria/dive.yaml`.

    Attributes:
        angle: of the line from the feet to the hands, off the vertical at entry [deg].
        straight: pose at entry by joint name, with a side or for both [rad]; joints not named are
            not looked at.
        bent: off that pose at most [deg].
        clearance: from where it last stood, on the way down [m].
        held: upside down on the platform before it, if asked for: a dive from the hands, which are
            at the edge as it takes off; its way down begins where the centre of mass is below that.
    """

    name: str
    kind: Literal["dive"]
    angle: Positive
    straight: Annotated[dict[str, Finite], Field(min_length=1)]
    bent: Positive
    clearance: Positive
    held: HeldCriteria | None = None
    description: str = ""


@dataclass(frozen=True)
class DiveMetrics:
    """What a log says of a dive; see `COLUMNS`. NaN where it does not enter."""

    entry_angle: float
    entry_sag: float
    bent_most: float
    clearance: float
    edge_clearance: float
    entry_time: float


def judge(
    log: Arrays, criteria: DiveCriteria, target: float, period: float
) -> tuple[dict[str, Any], str]:
    """Columns of a run, and why it is no success; empty if it is one.

    Args:
        target: to turn about left [deg].
        period: of the control [s].
    """
    m, c = measure(log, criteria, target, period), criteria
    revolved = turn(log)
    row = entry(log)
    turned = float(revolved[row]) if row is not None else math.nan
    rules = (
        (row is not None, "did not enter the water"),
        (abs(turned - target) < NEAREST, f"turned {turned:.0f} deg of {target:g}"),
        (m.entry_angle < c.angle, f"enters {m.entry_angle:.1f} deg off the vertical"),
        (m.bent_most < c.bent, f"enters with a joint bent by {m.bent_most:.0f} deg"),
        (not m.clearance <= c.clearance, f"came within {m.clearance:.2f} m of where it last stood"),
    )
    reason = next((reason for kept, reason in rules if not kept), "")
    found = {"revolved": turned, **asdict(m), **peaks.measure(log, row or 0)}
    if c.held:
        found["held"] = held = longest_held(log, c.held, period, PLATFORM)
        if held < c.held.seconds - 1e-6:
            reason = f"was held upside down for {held:.2f} s, is to be for {c.held.seconds:g}"
    return found, reason


def measure(log: Arrays, criteria: DiveCriteria, target: float, period: float) -> DiveMetrics:
    """Measure a run."""
    row = entry(log)
    if row is None:
        return DiveMetrics(*[math.nan] * len(COLUMNS))
    sense, held = math.copysign(1.0, target), criteria.held is not None
    line = _mean(log, ("hand_l", "hand_r"))[row] - _mean(log, ("foot_l", "foot_r"))[row]
    ahead, left, up = frame(log)
    x, y, z = (float((line * axis).sum()) for axis in (ahead, left, up))
    return DiveMetrics(
        entry_angle=math.degrees(math.atan2(math.hypot(x, y), -z)),
        entry_sag=math.degrees(math.atan2(x, -z)),
        bent_most=_bent(log, criteria)[row],
        clearance=_clearance(log, row, sense, _stood, held),
        edge_clearance=_clearance(log, row, sense, _edge, held),
        entry_time=row * period,
    )


def entry(log: Arrays) -> int | None:
    """The row in which the last stage begins, which it does as the hands enter; None if never."""
    stage = np.asarray(log["command/stage"])
    flown, landed = longest_flight(log)
    later = np.flatnonzero(np.diff(stage) > 0) + 1
    if not len(later) or not landed:
        return None
    time = floats(log, "trajectory/time")
    return int(later[-1]) if time[later[-1]] - time[flown] > HOP else None  # not the flight itself


def _mean(log: Arrays, names: tuple[str, ...]) -> np.ndarray:
    """Mean place of watched points (steps, 3), world [m]."""
    tasks = [name.decode("utf-8", "replace") for name in np.asarray(log["model/task"]).tolist()]
    missing = np.asarray(log["command/error"])[:, [tasks.index(name) for name in names]]
    along = frame(log)
    away = sum(missing[..., i : i + 1] * along[i] for i in range(3))
    return np.asarray(floats(log, "trajectory/com") - np.mean(away, axis=1))


def _bent(log: Arrays, criteria: DiveCriteria) -> list[float]:
    """Of the joint that is furthest off the straight pose (steps,) [deg]."""
    names = [name.decode("utf-8", "replace") for name in np.asarray(log["model/joint"]).tolist()]
    angles = floats(log, "trajectory/qpos")[:, 7 : 7 + len(names)]
    straight = dict(criteria.straight)
    for axis in "yxz":  # as in poses, the waist bends by what a missing chest would
        if f"chest_{axis}" in straight.keys() - set(names):
            waist = f"waist_{axis}"
            straight[waist] = straight.get(waist, 0.0) + straight.pop(f"chest_{axis}")
    wanted = [straight.get(name, straight.get(_whole(name), math.nan)) for name in names]
    off = np.degrees(np.abs(angles - np.array(wanted)))
    return [float(value) for value in np.nanmax(off, axis=1)]


def _whole(joint: str) -> str:
    return joint.removesuffix("_l").removesuffix("_r")


def _clearance(log: Arrays, row: int, sense: float, corner: Corner, hands: bool = False) -> float:
    """How near the watched points come to a corner of the platform, or behind it [m].

    Who turns backward (`sense` -1) goes backward.
    Counted from the highest point of the flight on: before it the feet are still at the edge. Or,
    from the `hands`, from where the centre of mass is below the platform: they leave it last. Who
    was spawned in the air stood nowhere: NaN, and nothing is asked of it.
    """
    first, _ = longest_flight(log)
    if not first:
        return math.nan
    heights = floats(log, "trajectory/com")[first:row, 2]
    top = first + int(np.argmax(heights < PLATFORM if hands else heights))
    ahead, up = sense * frame(log)[0], frame(log)[2]
    end, floor = corner(log, first, ahead)
    if math.isnan(end):
        return math.nan
    near = math.inf
    for names in (("hand_l", "hand_r"), ("foot_l", "foot_r"), ("head",), ("pelvis",)):
        place = _mean(log, names)[top:row]
        beyond = np.maximum((place * ahead).sum(axis=1) - end, 0.0)
        over = np.maximum((place * up).sum(axis=1) - floor, 0.0)
        near = min(near, float(np.sqrt(beyond**2 + over**2).min()))
    return near


def _stood(log: Arrays, first: int, ahead: np.ndarray) -> tuple[float, float]:
    """The foremost place that it last stood on: how far ahead, and its height in the world [m].

    Args:
        first: row of the flight.
        ahead: (3,) the way that it goes.
    """
    stood = np.asarray(log["contacts/position"])[first - 1]
    used = np.asarray(log["contacts/body"])[first - 1] >= 0
    return max(float((p * ahead).sum()) for p in stood[used]), float(stood[used][0, 2])


def _edge(log: Arrays, first: int, ahead: np.ndarray) -> tuple[float, float]:
    """Where the ground below the centre of mass falls away, as `_stood`; NaN if it never does.

    Half-way between the two steps around it, which is within half a step's way of it.
    """
    falls = np.flatnonzero(np.diff(floats(log, "trajectory/ground_height")) < 0.0)
    if not len(falls):
        return math.nan, PLATFORM
    com = floats(log, "trajectory/com")[falls[0] : falls[0] + 2]
    return float((com * ahead).sum(axis=1).mean()), PLATFORM
