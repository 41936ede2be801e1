"""A dive in numbers: how the body enters the water, and how far it kept from the platform.

The log holds where the watched points are, as seen from the centre of mass: `hand_l` and the like
are tasks of kind point with the aim `watch`, whose error is the way from there to it.
"""

import math
from dataclasses import asdict, dataclass
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.metrics import peaks
from rotctl.metrics.columns import Arrays, Column, floats, frame
from rotctl.metrics.criteria.acrobatic import HeldCriteria, longest_held
from rotctl.metrics.criteria.flip import HOP, longest_flight, turn
from rotctl.metrics.criteria.platform import PLATFORM, clearance, edge, middle, stood, touched
from rotctl.settings.fields import STRICT, Finite, Positive

WATCHED = ("hand", "foot", "head", "pelvis")  # tasks whose points are told, on both sides
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
        edge: from the platform's edge, on the way down [m]; of older runs nothing was asked.
        held: upside down on the platform before it, if asked for: a dive from the hands, which are
            at the edge as it takes off; its way down begins where the centre of mass is below that.
    """

    name: str
    kind: Literal["dive"]
    angle: Positive
    straight: Annotated[dict[str, Finite], Field(min_length=1)]
    bent: Positive
    clearance: Positive
    edge: Positive | None = None
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
    row, held = entry(log), c.held is not None
    turned = float(revolved[row]) if row is not None else math.nan
    rules = (
        (row is not None, "did not enter the water"),
        (row is None or not touched(log, row, held), "touched the platform on its way down"),
        (abs(turned - target) < NEAREST, f"turned {turned:.0f} deg of {target:g}"),
        (m.entry_angle < c.angle, f"enters {m.entry_angle:.1f} deg off the vertical"),
        (m.bent_most < c.bent, f"enters with a joint bent by {m.bent_most:.0f} deg"),
        (not m.clearance <= c.clearance, f"came within {m.clearance:.2f} m of where it last stood"),
        (
            c.edge is None or not m.edge_clearance <= c.edge,
            f"came within {m.edge_clearance:.2f} m of the platform's edge",
        ),
    )
    reason = next((reason for kept, reason in rules if not kept), "")
    found = {"revolved": turned, **asdict(m), **peaks.measure(log, row or 0)}
    if c.held:
        found["held"] = seconds = longest_held(log, c.held, period, PLATFORM)
        if seconds < c.held.seconds - 1e-6:
            reason = f"was held upside down for {seconds:.2f} s, is to be for {c.held.seconds:g}"
    return found, reason


def measure(log: Arrays, criteria: DiveCriteria, target: float, period: float) -> DiveMetrics:
    """Measure a run."""
    row = entry(log)
    if row is None:
        return DiveMetrics(*[math.nan] * len(COLUMNS))
    sense, held = math.copysign(1.0, target), criteria.held is not None
    line = middle(log, ("hand_l", "hand_r"))[row] - middle(log, ("foot_l", "foot_r"))[row]
    ahead, left, up = frame(log)
    x, y, z = (float((line * axis).sum()) for axis in (ahead, left, up))
    return DiveMetrics(
        entry_angle=math.degrees(math.atan2(math.hypot(x, y), -z)),
        entry_sag=math.degrees(math.atan2(x, -z)),
        bent_most=_bent(log, criteria)[row],
        clearance=clearance(log, row, sense, stood, held),
        edge_clearance=clearance(log, row, sense, edge, held),
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
