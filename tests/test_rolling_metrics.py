"""A roll in numbers, on logs made by hand."""

from dataclasses import replace

import numpy as np
import pytest

from rotctl.metrics.rolling import (
    RollingCriteria,
    RollingMetrics,
    failure_reason,
    longest_stall,
    measure,
)

PERIOD = 1.0 / 60.0
CRITERIA = RollingCriteria(
    name="test",
    stall_time=1.5,
    stall_progress=0.1,
    heading=30.0,
    lateral_drift=3.0,
    settle=2.0,
)
GOOD = RollingMetrics(
    duration=20.0,
    revolutions=9.0,
    angular_velocity_mean=0.45,
    speed_mean=0.4,
    heading_error_end=3.0,
    lateral_drift=0.5,
    longest_stall=0.4,
    stalled_at=2.0,
    airborne=0.0,
    torque_p99_fraction=0.6,
    solver_failures=0,
)


def make_log(steps=600, rate=0.5, speed=0.6, heading=0.0, lateral=0.0):
    """A steady roll of `rate` [rev/s] at `speed` [m/s], at a heading [deg], drifting [m/s]."""
    time = PERIOD * np.arange(steps)
    turn = np.radians(np.broadcast_to(heading, steps))
    log = {
        "trajectory/com": np.outer(time, [speed, lateral, 0.0]) + [2.0, -1.0, 0.5],
        "trajectory/angular_excursion": 2 * np.pi * np.outer(time, [0, rate, 0]) + [9.0, -4.0, 9.0],
        "trajectory/trunk_axis": np.stack((-np.sin(turn), np.cos(turn), 0 * turn), axis=1),
        "contacts/count": np.ones(steps, dtype=np.int32),
        "trajectory/ctrl": np.zeros((steps, 2)),
        "model/torque_limit": np.array([10.0, 20.0]),
        "solver/status": np.zeros(steps, dtype=np.uint8),
    }
    return log


# ---------------------------------------------------------------- stalls


@pytest.mark.parametrize(
    ("progress", "expected"),
    [
        ([0.0], (0, 0)),
        ([0, 0, 0, 0], (3, 0)),
        ([0, 1, 2, 3, 4], (0, 0)),
        ([0, 1, 2, 2, 2, 2, 3, 4], (3, 2)),
        ([0, 1, 1, 2, 3, 3, 3, 3], (3, 4)),  # the last one lasts to the end
        ([0, 1, 0.5, 0.2, 1.9, 2.0], (3, 1)),  # rolling back is no progress
        ([0, -1, -2, -3], (3, 0)),
        ([0, 0.5, 1.0, 1.5, 2.0], (1, 0)),  # half a mark a step
        ([0, 0.75, 1.5, 2.25, 3.0], (1, 0)),  # marks at 1.5 and 3.0
        ([0, 5, 5, 5, 10, 10, 10], (2, 1)),  # the first of equals
    ],
)
def test_longest_stall(progress, expected):
    found = longest_stall(np.array(progress, dtype=float), 1.0, 0.5)
    assert found == pytest.approx((0.5 * expected[0], 0.5 * expected[1]))


# ---------------------------------------------------------------- measures


def test_a_steady_roll():
    found = measure(make_log(), CRITERIA, 0.5, PERIOD)
    assert found.duration == pytest.approx(10.0)
    assert found.revolutions == pytest.approx(0.5 * 599 / 60)
    assert found.angular_velocity_mean == pytest.approx(0.5)
    assert found.speed_mean == pytest.approx(0.6)
    assert found.heading_error_end == pytest.approx(0.0, abs=1e-9)
    assert found.lateral_drift == 0.0
    assert found.longest_stall < 0.25  # 0.1 rev take 0.2 s
    assert found.solver_failures == 0
    assert failure_reason(found, CRITERIA, 10.0) == ""


def test_backward_rolling_counts_forward_when_commanded():
    log = make_log(rate=-0.5, speed=-0.6)
    found = measure(log, CRITERIA, -0.5, PERIOD)
    assert found.revolutions == pytest.approx(0.5 * 599 / 60)
    assert found.angular_velocity_mean == pytest.approx(-0.5)
    assert found.speed_mean == pytest.approx(-0.6)
    assert found.longest_stall < 0.25
    wrong_way = measure(log, CRITERIA, 0.5, PERIOD)
    assert wrong_way.revolutions == pytest.approx(-0.5 * 599 / 60)
    assert wrong_way.longest_stall == pytest.approx(599 / 60)


@pytest.mark.parametrize("heading", [-50.0, -3.0, 20.0, 170.0])
def test_heading_is_positive_to_the_left(heading):
    """Turned about +z: from +x, rolling ahead, towards +y."""
    found = measure(make_log(heading=heading), CRITERIA, 0.5, PERIOD)
    assert found.heading_error_end == pytest.approx(heading)


def test_heading_is_the_median_of_the_last_second():
    heading = np.full(600, 80.0)
    heading[-60:] = 10.0
    heading[-60:-35] = -90.0  # less than half of it
    found = measure(make_log(heading=heading), CRITERIA, 0.5, PERIOD)
    assert found.heading_error_end == pytest.approx(10.0)


def test_a_heading_about_face_is_not_averaged_away():
    """Half the samples at +179 and half at -179 degrees are no heading of 0."""
    heading = np.where(np.arange(600) % 2, 179.0, -179.0)
    found = measure(make_log(heading=heading), CRITERIA, 0.5, PERIOD)
    assert abs(found.heading_error_end) > 170.0


@pytest.mark.parametrize("lateral", [-0.2, 0.2])
def test_lateral_drift_is_from_the_start(lateral):
    found = measure(make_log(lateral=lateral), CRITERIA, 0.5, PERIOD)
    assert found.lateral_drift == pytest.approx(0.2 * 599 / 60)
    log = make_log()
    log["trajectory/com"][300, 1] -= 1.25  # the largest, not the last
    assert measure(log, CRITERIA, 0.5, PERIOD).lateral_drift == pytest.approx(1.25)


def test_means_leave_the_settling_out():
    log = make_log()
    settled = round(CRITERIA.settle / PERIOD)
    log["trajectory/com"][:settled, 0] -= 100.0
    log["trajectory/angular_excursion"][:settled, 1] += 100.0
    found = measure(log, CRITERIA, 0.5, PERIOD)
    assert found.speed_mean == pytest.approx(0.6)
    assert found.angular_velocity_mean == pytest.approx(0.5)


def test_torque_fraction_is_of_each_joint_s_limit():
    log = make_log()
    log["trajectory/ctrl"][:] = [-5.0, 5.0]
    assert measure(log, CRITERIA, 0.5, PERIOD).torque_p99_fraction == pytest.approx(0.5)
    log["trajectory/ctrl"][:, 1] = -18.0
    assert measure(log, CRITERIA, 0.5, PERIOD).torque_p99_fraction == pytest.approx(0.9)


def test_airborne_is_the_share_without_contact():
    log = make_log()
    log["contacts/count"][100:250] = 0
    log["contacts/count"][300:] = 7
    assert measure(log, CRITERIA, 0.5, PERIOD).airborne == pytest.approx(0.25)


def test_only_steps_without_any_solver_are_failures():
    log = make_log()
    log["solver/status"][[3, 4, 5]] = 1
    log["solver/status"][[7, 9]] = 2
    assert measure(log, CRITERIA, 0.5, PERIOD).solver_failures == 2


@pytest.mark.parametrize("steps", [1, 2, 30])
def test_short_logs(steps):
    found = measure(make_log(steps=steps), CRITERIA, 0.5, PERIOD)
    assert found.duration == pytest.approx(steps * PERIOD)
    means = ("angular_velocity_mean", "speed_mean")
    for name, value in vars(found).items():
        settled = steps * PERIOD > CRITERIA.settle
        assert np.isfinite(value) or (name in means and not settled)


def test_empty_log():
    found = measure(make_log(steps=0), CRITERIA, 0.5, PERIOD)
    assert (found.duration, found.revolutions, found.solver_failures) == (0.0, 0.0, 0)
    assert np.isnan(found.heading_error_end)
    assert failure_reason(found, CRITERIA, 20.0) == "ended after 0.00 of 20 s"


# ---------------------------------------------------------------- verdicts


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({}, ""),
        ({"duration": 19.98}, "ended after 19.98 of 20 s"),
        ({"solver_failures": 3}, "every solver failed on 3 control steps"),
        (
            {"longest_stall": 1.5, "stalled_at": 4.25},
            "stalled for 1.50 s from t = 4.25 s",
        ),
        ({"longest_stall": 1.499}, ""),
        ({"heading_error_end": 30.0}, "heading off by 30 deg at the end"),
        ({"heading_error_end": -41.6}, "heading off by -42 deg at the end"),
        ({"heading_error_end": -29.9}, ""),
        ({"lateral_drift": 3.0}, "drifted 3.00 m sideways"),
        ({"lateral_drift": 2.99}, ""),
        ({"duration": 5.0, "solver_failures": 3}, "ended after 5.00 of 20 s"),  # the first
        ({"lateral_drift": 9.0, "longest_stall": 9.0}, "stalled for 9.00 s from t = 2.00 s"),
    ],
)
def test_failure_reason(changes, reason):
    assert failure_reason(replace(GOOD, **changes), CRITERIA, 20.0) == reason
