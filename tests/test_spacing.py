"""Which rows become frames: on logs made by hand, of which the turn is known."""

import numpy as np
import pytest

from rotctl.report.skill import Part
from rotctl.report.spacing import CLOSEST, even, spread

STILL = {"trajectory/angular_velocity": np.zeros((1000, 3))}


def turning(first, last, rows=1000):
    """A log that turns from one row to another, and is still before and after."""
    spin = np.zeros((rows, 3))
    spin[first:last, 1] = 10.0
    return {"trajectory/angular_velocity": spin}


def test_frames_of_what_is_still_are_spread_by_their_shares():
    chosen = [Part(0, 30, 1.0), Part(30, 60, 2.0), Part(60, 90, 1.0)]
    assert spread(STILL, chosen, 8) == [0, 15, 30, 38, 45, 52, 60, 90]
    assert spread(STILL, chosen, 1) == [0]
    assert spread(STILL, [Part(5, 7, 1.0)], 50) == [5, 6, 7]
    assert spread(STILL, [Part(3, 9, 1.0)], 1) == [3]
    assert spread(STILL, [Part(4, 4, 1.0)], 3) == [4]


@pytest.mark.parametrize("first", [0, 100, 600, 845])
def test_what_is_over_in_a_sixth_of_the_time_has_half_of_the_frames(first):
    rows = spread(turning(first, first + 155), [Part(0, 999, 1.0)], 12)
    assert len(rows) == 12
    assert (rows[0], rows[-1]) == (0, 999)
    assert 4 <= sum(first <= row < first + 155 for row in rows) <= 7
    assert np.diff(rows).min() >= 999 * CLOSEST - 1
    assert np.diff(rows).max() < 333


@pytest.mark.parametrize("frames", [2, 3, 4, 6, 12, 24, 60])
@pytest.mark.parametrize("lasts", [1, 5, 20, 1000])
def test_however_fast_it_is_frames_are_not_crowded(lasts, frames):
    rows = spread(turning(0, lasts), [Part(0, 999, 1.0)], frames)
    assert len(rows) == frames
    assert np.diff(rows).min() >= min(999 * CLOSEST, 0.4 * 999 / (frames - 1)) - 1


def test_a_short_push_a_stage_and_the_time_upside_down_are_seen():
    stage = np.zeros(1000, dtype=int)
    stage[700:] = 1
    stage[740:] = 2
    wrench = np.zeros((1000, 6))
    wrench[300:306, 1] = 200.0
    trunk = np.tile(np.eye(3), (1000, 1, 1))
    trunk[520:530, 2, 2] = -1.0
    log = STILL | {
        "command/stage": stage,
        "disturbance/wrench": wrench,
        "trajectory/trunk_axes": trunk,
    }
    rows = spread(log, [Part(0, 999, 1.0)], 9)
    assert len(rows) == 9
    for first, last in ((300, 306), (520, 530), (0, 700), (700, 740), (740, 1000)):
        assert any(first <= row < last for row in rows)
    assert np.diff(rows).min() >= 33


def test_of_stages_that_change_all_the_time_none_is_looked_for():
    log = STILL | {"command/stage": np.arange(1000) % 2}
    assert spread(log, [Part(0, 999, 1.0)], 4) == even(0, 999, 4)


def test_numbers_that_make_no_sense_are_no_motion():
    log = {"trajectory/angular_velocity": np.full((1000, 3), np.nan)}
    assert spread(log, [Part(0, 999, 1.0)], 4) == even(0, 999, 4)
