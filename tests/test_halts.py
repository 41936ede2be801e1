"""Halts that a schedule asks for, judged on progress made by hand."""

import math

import numpy as np
import pytest
from test_rolling_metrics import CRITERIA, PERIOD, make_log

from rotctl.metrics.criteria.rolling import measure
from rotctl.metrics.criteria.rolling_rules import failure_reason
from rotctl.metrics.halts import going, unkept
from rotctl.metrics.halts import measure as told_to

HALTS = ((7.0, 11.0),)
TIME = PERIOD * np.arange(1201)


def progress(*points):
    """Times and revolutions by then."""
    times, turned = zip(*points, strict=True)
    return np.interp(TIME, times, turned)


KEPT = progress((0, 0), (8, 4), (11, 4), (20, 8.5))  # on to the next squat first
THROUGH = progress((0, 0), (20, 10))


def judged(turns, halts):
    log = make_log(steps=len(turns), turns=turns)
    log["trajectory/com"][:, 0] = 1.8 * turns
    found = measure(log, CRITERIA, 0.5, PERIOD, True, halts)
    return found, failure_reason(found, CRITERIA, 20.0)


def test_to_stand_where_it_is_told_to_is_no_stall():
    found, reason = judged(KEPT, HALTS)
    assert reason == ""
    assert found.longest_stall < 0.3
    assert found.slowest_revolution == pytest.approx(2.0, abs=0.3), "the time that it was to roll"
    assert judged(KEPT, ())[1] == "stalled for 3.20 s from t = 7.92 s"


def test_how_long_it_stood_is_measured():
    log = make_log(steps=len(KEPT), turns=KEPT)
    assert told_to(log, HALTS, 0.1, PERIOD) == {
        "halt_commanded": 7.0,
        "halted": pytest.approx(3.0 + 0.1 / 0.5, abs=0.1),  # from less than `least` before on
    }
    assert told_to(log, (), 0.1, PERIOD) == told_to(log, ((30.0, math.inf),), 0.1, PERIOD) == {}


def test_who_rolls_through_a_halt_is_told():
    assert judged(THROUGH, HALTS)[1] == "told to halt at 7 s, and not still for 1 s"
    assert judged(THROUGH, ())[1] == ""


def test_who_does_not_go_on_has_stalled():
    stays = progress((0, 0), (8, 4), (20, 4))
    assert judged(stays, HALTS)[1] == "stalled for 9.00 s from t = 11.00 s"
    assert judged(stays, ((7.0, math.inf),))[1] == ""


def test_a_halt_too_short_for_a_squat_is_not_looked_at():
    assert unkept(TIME, THROUGH, ((7.0, 9.9),), 0.1, PERIOD) is None
    assert unkept(TIME, THROUGH, ((7.0, 10.1),), 0.1, PERIOD) == 7.0
    assert unkept(TIME, THROUGH, ((18.5, math.inf),), 0.1, PERIOD) is None
    assert unkept(TIME, KEPT, (*HALTS, (14.0, 18.0)), 0.1, PERIOD) == 14.0


@pytest.mark.parametrize(("rows", "kept"), [(61, True), (60, False)])
def test_a_second_without_progress_keeps_a_halt(rows, kept):
    """From row to row 0.2 rev, more than the least, but for so many rows alike from 8 s on."""
    turned = 0.2 * np.concatenate((np.arange(480), np.full(rows, 480), np.arange(481, 1202 - rows)))
    assert (unkept(TIME, turned, HALTS, 0.1, PERIOD) is None) == kept


def test_rows_in_which_it_is_to_roll():
    assert going(np.array([0.0, 6.9, 7.0, 10.9, 11.0]), HALTS).tolist() == [1, 1, 0, 0, 1]
    found, _ = judged(THROUGH, ((0.0, math.inf),))
    assert (found.longest_stall, found.stalled_at) == (0.0, 0.0)
