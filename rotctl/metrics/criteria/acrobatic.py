"""A move over hands and feet in numbers: what came down in which order, and whether it stands."""

import math
from dataclasses import asdict, replace
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.metrics.columns import Arrays, Column, floats
from rotctl.metrics.criteria import flip, standing
from rotctl.metrics.criteria.standing import StandingCriteria
from rotctl.metrics.touching import TouchDown, touch_downs
from rotctl.settings.fields import STRICT, Positive, SomeNames

COLUMNS = (
    Column("touched", "What came down, and when [s]", ""),
    Column("bears_most", "Largest upward force of the ground, mean of a control step", "N"),
    Column("held", "Longest time held upside down", "s"),
)

Group = Annotated[SomeNames, Field(max_length=20)]


@validated(frozen=True, config=STRICT)
class HeldCriteria:
    """When a body counts as held upside down.

    Attributes:
        bodies: that alone touch the ground.
        seconds: so long at least, without a break [s].
        lean: of the trunk, off upside down [deg].
        height: least height of the centre of mass, as a share of that at the start: legs are up.
    """

    bodies: Group
    seconds: Positive
    lean: Positive
    height: Positive


@validated(frozen=True, config=STRICT)
class AcrobaticCriteria:
    """Limits of a move over hands and feet; see `conf/criteria/handspring.yaml`.

    Attributes:
        order: groups of bodies that come down one after the other, after the start; the bodies of
            one group in any order. About forward it is that of a turn to the left, and the
            mirror image counts for one to the right.
        turn: how far the trunk's turn may be off the target in the end [deg].
        about: what it turns about.
        landing: what counts as standing in the end; feet alone may touch once the last group is
            down.
    """

    name: str
    kind: Literal["acrobatic"]
    order: Annotated[tuple[Group, ...], Field(min_length=1, max_length=20)]
    turn: Positive
    landing: StandingCriteria
    about: Literal["left", "up", "forward"] = "left"
    held: HeldCriteria | None = None
    description: str = ""


def judge(
    log: Arrays, criteria: AcrobaticCriteria, target: float, period: float
) -> tuple[dict[str, Any], str]:
    """Columns of a run, and why it is no success; empty if it is one.

    Args:
        target: to turn [deg].
        period: of the control [s].
    """
    events, turned = touch_downs(log, period), flip.turn(log, criteria.about)
    revolved = float(turned[-1]) if len(turned) else math.nan
    stood = standing.measure(log, criteria.landing, period)
    duration = len(floats(log, "trajectory/time")) * period
    # Hands were on the ground by order, and what came down otherwise is told by that.
    reason = standing.failure(replace(stood, other_contact=0.0), criteria.landing, duration)
    wrong, missing = out_of_order(events, to(target, criteria))
    if wrong or missing:
        reason = wrong or f"{' and '.join(sorted(missing))} had not come down at the end"
    elif not abs(revolved - target) < criteria.turn:
        reason = f"turned {revolved:.0f} deg of {target:g}"
    up = floats(log, "contacts/force_realised")[:, :, 2].sum(axis=1)
    bears = float(up.max()) if len(up) else math.nan
    found = {"revolved": revolved, "bears_most": bears, "touched": told(events)}
    if criteria.held:
        found["held"] = held = longest_held(log, criteria.held, period)
        if not reason and held < criteria.held.seconds - 1e-6:
            wanted = criteria.held.seconds
            reason = f"was held upside down for {held:.2f} s, is to be for {wanted:g}"
    return {**asdict(stood), **found}, reason


def longest_held(
    log: Arrays, criteria: HeldCriteria, period: float, floor: float | None = None
) -> float:
    """Longest time upside down on the hands alone [s].

    Args:
        period: of the control [s].
        floor: height of what it stands on [m]; without, of the ground below it.
    """
    down = -floats(log, "trajectory/trunk_axes")[:, 2, 2]
    ground = floats(log, "trajectory/ground_height") if floor is None else floor
    height = floats(log, "trajectory/com")[:, 2] - ground
    straight = down > math.cos(math.radians(criteria.lean))
    kept = on_hands(log, criteria) & straight & (height > criteria.height * height[:1])
    edges = np.flatnonzero(np.diff(np.concatenate(([False], kept, [False])).astype(int)))
    return float((edges[1::2] - edges[::2]).max(initial=0)) * period


def on_hands(log: Arrays, criteria: HeldCriteria) -> NDArray[np.bool_]:
    """Whether it touches the ground with them alone, in each row (n,)."""
    borne = np.asarray(log["contacts/count"]) > 0
    return borne & ~standing.on_others(log, criteria.bodies)


def to(target: float, criteria: AcrobaticCriteria) -> AcrobaticCriteria:
    """The same for a turn [deg], which goes to one side or the other."""
    if criteria.about != "forward" or target <= 0.0:
        return criteria
    return replace(criteria, order=tuple(map(_other_sides, criteria.order)))


def out_of_order(events: list[TouchDown], criteria: AcrobaticCriteria) -> tuple[str, set[str]]:
    """How touch-downs differ from the order that is asked for, and what is to come down next.

    Both are empty if all came down in that order, and nothing but feet after it.
    """
    feet = set(criteria.landing.feet)
    groups = [set(group) for group in criteria.order]
    begun, missing = -1, set[str]()  # the group that is coming down, and what of it is not yet
    for time, body in events:
        if body in missing:
            missing.discard(body)
        elif not missing and begun + 1 < len(groups) and body in groups[begun + 1]:
            begun += 1
            missing = groups[begun] - {body}
        elif begun < 0 and body in feet:
            continue  # a step before it begins
        elif begun >= 0 and body in groups[begun]:
            continue  # once more
        elif missing or begun + 1 < len(groups):
            return f"{body} came down out of order, at {time:.2f} s", set()
        elif body not in feet:  # the order is complete: the move was done, and then it fell
            return f"fell: {body} came down at {time:.2f} s", set()
    if begun + 1 < len(groups):
        missing = missing or groups[begun + 1]
    return "", missing


def _other_sides(group: Group) -> Group:
    """The mirror images of some parts, by name."""
    sides = {"_l": "_r", "_r": "_l"}
    return tuple(name[:-2] + sides.get(name[-2:], name[-2:]) for name in group)


def told(events: list[TouchDown]) -> str:
    """Touch-downs for a summary row."""
    return ", ".join(f"{body} {time:.2f}" for time, body in events)
