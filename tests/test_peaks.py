"""How hard a jump works its joints, from a log whose peaks are known."""

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.metrics import peaks
from rotctl.metrics.criteria import dive, flip
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

NAMES = ("hip_y_l", "hip_x_r", "knee_l", "knee_r", "ankle_y_l", "neck_y")
LIMITS = [100.0, 50.0, 80.0, 80.0, 40.0, 10.0]


def a_log(rows=10):
    return {
        "model/joint": np.array([name.encode() for name in NAMES]),
        "model/torque_limit": np.array(LIMITS),
        "trajectory/qvel": np.zeros((rows, 6 + len(NAMES))),
        "trajectory/ctrl": np.zeros((rows, len(NAMES))),
    }


def test_a_peak_is_the_largest_of_a_groups_joints_of_either_sign():
    log = a_log()
    log["trajectory/qvel"][3, 6 + 1] = -7.0  # hip_x_r
    log["trajectory/qvel"][4, 6] = 5.0  # hip_y_l
    log["trajectory/qvel"][5, 2] = 99.0  # the root's
    log["trajectory/qvel"][5, 6 + 5] = 99.0  # the neck's
    log["trajectory/ctrl"][2, 3] = -60.0  # knee_r
    found = peaks.measure(log, 10)
    assert (found["hip_speed"], found["knee_speed"]) == (7.0, 0.0)
    assert found["knee_torque"] == pytest.approx(0.75)
    assert set(found) == {column.name for column in peaks.COLUMNS}


def test_what_comes_after_the_landing_does_not_count():
    log = a_log()
    log["trajectory/qvel"][:, 6] = np.arange(10.0)
    assert peaks.measure(log, 6)["hip_speed"] == 5.0


def test_joints_that_are_not_there_and_runs_without_a_landing_have_none():
    log = a_log()
    assert np.isnan(peaks.measure(log, 10)["shoulder_speed"])
    assert np.isnan(peaks.measure(log, 0)["hip_speed"])


def test_a_joint_without_a_motor_has_no_share():
    log = a_log()
    log["model/torque_limit"][0] = 0.0
    log["trajectory/ctrl"][1, 1] = 25.0
    assert peaks.measure(log, 10)["hip_torque"] == pytest.approx(0.5)


def test_flips_and_dives_tell_them():
    config = load(["behaviour=back_flip", "seed=2000", "duration=1.0"])  # it crouches: no flight
    log = in_memory(build(config))[0].arrays()
    told = flip.judge(log, config.criteria, -360.0, 1 / 240)[0]
    assert np.isnan(told["hip_speed"])
    config = load(["behaviour=dive_backward", "seed=2000", "duration=0.1"])
    log = in_memory(build(config))[0].arrays()
    assert "knee_torque" in dive.judge(log, config.criteria, -540.0, 1 / 240)[0]
