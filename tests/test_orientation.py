"""Turning over in numbers: made-up logs with a turn that is known."""

from dataclasses import replace

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.metrics.criteria.orientation import failure, measure

PERIOD = 1.0 / 60.0
CRITERIA = load(["behaviour=turn_over"]).criteria
STAYS = load(["behaviour=turn_over", "criteria=rolled_over"]).criteria


def log_of(turn, level=0.0, speed=0.0):
    """Arrays of a trunk that has turned so far about +y (n,) [deg], its axis tilted by `level`."""
    angle, tilt = np.radians(turn), np.radians(level) * np.ones(len(turn))
    zero = np.zeros_like(angle)
    front = np.stack([np.sin(angle), zero, np.cos(angle)], axis=1)
    axes = np.zeros((len(turn), 3, 3))
    axes[:, :, 0] = front
    return {
        "trajectory/trunk_axes": axes,
        "trajectory/trunk_axis": np.stack([zero, np.cos(tilt), np.sin(tilt)], axis=1),
        "trajectory/phase": zero,
        "trajectory/com_velocity": np.stack([zero, zero, speed * np.ones(len(turn))], axis=1),
    }


def reason(turn, criteria=CRITERIA, target=180.0, **known):
    found = measure(log_of(turn, **known), criteria, target, PERIOD)
    return failure(found, criteria, len(turn) * PERIOD)


def ramp(to, seconds, total=8.0):
    """A turn at an even pace, then rest."""
    time = np.arange(round(total / PERIOD)) * PERIOD
    return np.minimum(time / seconds, 1.0) * to


def test_a_turn_is_measured_beyond_half_a_revolution():
    found = measure(log_of(ramp(350.0, 3.0)), CRITERIA, 360.0, PERIOD)
    assert found.turned == pytest.approx(350.0)
    assert found.turned_most == pytest.approx(350.0)
    assert found.error_end == pytest.approx(10.0)


@pytest.mark.parametrize(("target", "most"), [(180.0, 60.0), (-180.0, -20.0)])
def test_furthest_is_towards_the_target(target, most):
    turn = np.interp(np.arange(480), [0, 100, 200, 300], [0.0, 60.0, -20.0, 0.0])
    assert measure(log_of(turn), CRITERIA, target, PERIOD).turned_most == pytest.approx(most)


@pytest.mark.parametrize(
    ("turn", "known", "expected"),
    [
        (ramp(175.0, 2.0), {}, ""),
        (ramp(30.0, 2.0), {}, "turned 30 deg of 180"),
        (ramp(180.0, 7.5), {}, "turned 180 deg of 180, but 0.92 s before the end only"),
        (ramp(180.0, 2.0), {"level": np.repeat([50.0, 0.0], 240)}, "sat up by 50 deg on the way"),
        (ramp(180.0, 2.0), {"level": -44.0}, "lies 44 deg off level at the end"),
        (ramp(180.0, 2.0), {"speed": 0.4}, "still moves at 0.40 m/s at the end"),
    ],
)
def test_what_is_no_turn(turn, known, expected):
    assert reason(turn, **known) == expected


def test_who_stays_must_come_in_time_and_stay_longer():
    """Within 10 degrees 6.14 s after the start, and for 1.86 s."""
    turn = ramp(180.0, 6.5)
    assert reason(turn) == ""
    assert reason(turn, STAYS) == "turned 180 deg of 180, but 1.85 s before the end only"
    late = replace(STAYS, rest=1.0)
    assert reason(turn, late) == "turned in 6.2 s, is to in 6"
