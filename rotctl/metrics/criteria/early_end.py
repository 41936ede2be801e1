"""A run that ends before it could do what it is asked: that is the reason, not what is missing."""

import math
import re
from collections.abc import Mapping

import numpy as np

from rotctl.metrics.columns import Arrays, floats, in_frame
from rotctl.metrics.criteria import finish, standing
from rotctl.metrics.criteria.acrobatic import AcrobaticCriteria, on_hands, out_of_order, to
from rotctl.metrics.criteria.dive import DiveCriteria, entry
from rotctl.metrics.criteria.finish import FinishCriteria
from rotctl.metrics.criteria.flip import HOP, FlipCriteria, longest_flight, turn
from rotctl.metrics.criteria.getting_up import GettingUpCriteria
from rotctl.metrics.criteria.kinds import Criteria
from rotctl.metrics.criteria.one_foot import OneFootCriteria
from rotctl.metrics.criteria.orientation import OrientationCriteria
from rotctl.metrics.criteria.rolling import RollingCriteria
from rotctl.metrics.criteria.standing import StandingCriteria, on_others
from rotctl.metrics.touching import touch_downs

ENDS = "the run ends at"
_WHEN = re.compile(r"(?<=\bt = )[\d.]+(?= s\b)|(?<=\bat )[\d.]+(?= s\b)")  # in a reason
NOW, SLOW = 0.5, 0.1  # [s] before the end, [m/s] who is slower has come to rest
TURNS = 0.1  # [rad/s] towards the target: it is still on its way


def too_short(
    log: Arrays,
    criteria: Criteria,
    commanded: Mapping[str, float],
    columns: Mapping[str, float],
    period: float,
) -> str:
    """What a run had still to do when it ended; empty where it had the time for all of it.

    Args:
        log: arrays by schema path, with a row at least, of a run that is no success.
        commanded: columns that tell what was asked for.
        columns: what was measured of it.
        period: of the control [s].
    """
    lasted = len(floats(log, "trajectory/time")) * period
    missing = _missing(log, criteria, commanded, columns, lasted, period)
    return f"{ENDS} {lasted:.2f} s, {missing}" if missing else ""


def of_a_part(reason: str, begin: float, end: float, goes_on: bool) -> str:
    """The reason of a chain's part in the run's time, which may go on after it.

    Args:
        begin, end: of the part in the run [s].
    """
    if not reason.startswith(ENDS):
        return _WHEN.sub(lambda when: f"{begin + float(when[0]):.2f}", reason)
    missing = reason.partition(" s, ")[2]
    return f"{'it ends at' if goes_on else ENDS} {end:.2f} s, {missing}"


def _missing(
    log: Arrays,
    criteria: Criteria,
    commanded: Mapping[str, float],
    columns: Mapping[str, float],
    lasted: float,
    period: float,
) -> str:
    if isinstance(criteria, RollingCriteria):
        turned = columns["revolutions"]
        short = 0.0 <= turned < 1.0 and lasted < criteria.stall_time
        return f"before a whole revolution: it turned {turned:.2f} rev" if short else ""
    if isinstance(criteria, OrientationCriteria):
        return _before_the_turn(log, criteria, columns, lasted)
    if isinstance(criteria, FinishCriteria):
        if _rolled_wrongly(criteria.roll, columns):
            return ""
        soonest, begins = commanded["finish_commanded"], finish.begins(log) * period
        if lasted <= soonest:
            return f"before it is told to end, at {soonest:g} s"
        told = finish.rolled(log, commanded).told
        if told == math.inf:
            return _before_it_is_told(criteria, commanded, columns, lasted)
        if begins < lasted:
            wanted = commanded.get("revolutions_commanded", 0.0)
            if finish.miscounted(columns["revolutions"], wanted):
                return ""
            rest, upright = criteria.stand.rest, standing.upright_from(log, criteria.stand) * period
            began = _resting("it began to stand up", begins, lasted, rest)
            return began or (
                _resting("it came upright", upright, lasted, rest) if upright < lasted else ""
            )
        waits = lasted - told  # for a squat, of which there is one in a revolution
        short = waits < criteria.roll.revolution_time
        return f"{waits:.2f} s after it was told to end: it still rolls" if short else ""
    if isinstance(criteria, StandingCriteria):
        return "" if on_others(log, criteria.feet).any() else _standing(log, criteria.rest, period)
    if isinstance(criteria, DiveCriteria):
        return "" if entry(log) is not None else _before_the_end_of_a_flight(log, period)
    if isinstance(criteria, AcrobaticCriteria):
        return _over_the_hands(log, criteria, commanded["target_excursion"], lasted, period)
    if isinstance(criteria, OneFootCriteria):
        return _on_one_foot(log, criteria, commanded["target_excursion"], lasted, period)
    if isinstance(criteria, GettingUpCriteria):
        up = not math.isnan(columns["up_from"])
        return "" if up or lasted >= criteria.within else _not_up(criteria)
    if not isinstance(criteria, FlipCriteria) or on_others(log, criteria.landing.feet).any():
        return ""
    _, landed = longest_flight(log)
    resting = _resting("it landed", landed * period, lasted, criteria.landing.rest)
    return _before_the_end_of_a_flight(log, period) or resting


def _rolled_wrongly(roll: RollingCriteria, columns: Mapping[str, float]) -> bool:
    """Whether it stalled, took too long over a revolution or rocked back: no time mends that."""
    limits = {
        "longest_stall": roll.stall_time,
        "slowest_revolution": roll.revolution_time,
        "setback": roll.setback,
    }
    return any(columns[name] >= limit for name, limit in limits.items())


def _before_it_is_told(
    criteria: FinishCriteria,
    commanded: Mapping[str, float],
    columns: Mapping[str, float],
    lasted: float,
) -> str:
    """Of a roll that is counted: it rolls, and had no time for so many."""
    turns, turned = commanded["revolutions_told"], columns["revolutions"]
    if lasted >= turns * criteria.roll.revolution_time:
        return ""
    return f"before it is told to end, after {turns:.3g} rev: it turned {turned:.2f} rev"


def _before_the_turn(
    log: Arrays, criteria: OrientationCriteria, columns: Mapping[str, float], lasted: float
) -> str:
    here = abs(columns["turned"] - columns["target_excursion"]) < criteria.error
    if here:
        return _resting("it was there", columns["arrival"], lasted, criteria.rest)
    target = columns["target_excursion"]
    turns = float(in_frame(log, "trajectory/angular_velocity")[-1, 1])
    if lasted >= criteria.within or not turns * target > TURNS * abs(target):
        return ""
    return f"turned by {columns['turned']:.0f} of {target:.0f} deg: it has {criteria.within:g} s"


def _on_one_foot(
    log: Arrays, criteria: OneFootCriteria, target: float, lasted: float, period: float
) -> str:
    """Who winds up turns the other way at first; who turned too far or fell is not early."""
    if on_others(log, criteria.landing.feet).any():
        return ""
    way = math.copysign(1.0, target)
    turned = way * turn(log, "up")
    off = np.abs(turned - abs(target)) >= criteria.turn
    if not off[-1]:
        there = int(np.flatnonzero(off)[-1]) + 1 if off.any() else 0
        return _resting("it was there", there * period, lasted, criteria.landing.rest)
    if turned.max() < criteria.turn:
        return "before it turns"
    turns = way * float(in_frame(log, "trajectory/angular_velocity")[-1, 2])
    short = turned[-1] < abs(target) and turns > TURNS
    return f"turned by {way * turned[-1]:.0f} of {target:.0f} deg" if short else ""


def _over_the_hands(
    log: Arrays, criteria: AcrobaticCriteria, target: float, lasted: float, period: float
) -> str:
    """Who has come to rest elsewhere, or is on what is not to come down, is not early."""
    events, rest = touch_downs(log, period), criteria.landing.rest
    wrong, missing = out_of_order(events, to(target, criteria))
    if wrong:
        return ""
    if criteria.held and on_hands(log, criteria.held)[-1]:
        return "on its hands"
    if not missing:
        return _resting(f"{events[-1].body} came down", events[-1].time, lasted, rest)
    com = floats(log, "trajectory/com")[-1 - round(NOW / period) :]
    moved = np.sqrt((np.diff(com, axis=0) ** 2).sum(axis=1)) / period
    moves = lasted < rest or bool((moved > SLOW).any())
    names = " and ".join(sorted(missing))
    return f"before {names} {'come' if len(missing) > 1 else 'comes'} down" if moves else ""


def _not_up(criteria: GettingUpCriteria) -> str:
    return f"before it is up: it has {criteria.within:g} s, and is to rest for {criteria.rest:g} s"


def _standing(log: Arrays, rest: float, period: float) -> str:
    first = int(np.argmax(np.asarray(log["contacts/count"]) > 0))
    pushed = np.flatnonzero(floats(log, "disturbance/wrench").any(axis=1))
    lasted = len(np.asarray(log["contacts/count"])) * period
    what = "it landed" if first else "it began"
    if len(pushed) and first <= pushed[-1] < len(log["contacts/count"]) - 1:
        what, first = "it was pushed", int(pushed[-1]) + 1
    return _in_the_air(log) or _resting(what, first * period, lasted, rest)


def _before_the_end_of_a_flight(log: Arrays, period: float) -> str:
    first, landed = longest_flight(log)
    flown = (landed - first) * period > HOP
    return _in_the_air(log) or ("" if flown else "before it takes off")


def _in_the_air(log: Arrays) -> str:
    return "" if np.asarray(log["contacts/count"])[-1] else "in the air"


def _resting(what: str, since: float, lasted: float, rest: float) -> str:
    rested = lasted - since
    if rested >= rest:
        return ""
    more = math.ceil(100.0 * (rest - rested) - 1e-6) / 100.0
    return f"{rested:.2f} s after {what}: it is to rest for {rest:g} s, {more:.2f} s more at least"
