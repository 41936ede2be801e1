"""Verdicts of turning and of standing, on logs made by hand: each limit is one that bites."""

from dataclasses import replace

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.metrics.criteria import orientation, standing
from rotctl.metrics.criteria.judge import _torque

PERIOD = 1.0 / 60.0
TURNING = load(["behaviour=turn_over"]).criteria
STANDING = load(["behaviour=stand"]).criteria
LANDING = load(["behaviour=stand_step"]).criteria


def rows(*columns):
    return np.stack(np.broadcast_arrays(*map(np.asarray, columns)), axis=-1).astype(float)


def turn(seconds=4.0, target=180.0, over=2.0, tilt=0.0, speed=0.0):
    """A body that turns about its level axis, which is x and left, to a target [deg].

    Args:
        over: it takes so long [s], and then lies there; tilt: of the axis meanwhile [deg].
        speed: of the centre of mass in the end [m/s].
    """
    time = PERIOD * np.arange(round(seconds / PERIOD))
    angle = np.radians(target) * np.clip(time / over, 0.0, 1.0)
    rise = np.broadcast_to(np.radians(tilt), time.shape)
    none = np.zeros_like(time)
    front = rows(none, -np.sin(angle), np.cos(angle))  # up at first: on the back
    axis = rows(np.cos(rise), none, np.sin(rise))
    return {
        "command/axes": np.array([[[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]]),
        "trajectory/trunk_axes": np.stack((front, none[:, None] + [0, 1, 0], axis), axis=2),
        "trajectory/trunk_axis": axis,
        "trajectory/com_velocity": rows(none + speed, none, none),
        "trajectory/phase": angle,
    }


def judged_turn(log, target=180.0, criteria=TURNING):
    found = orientation.measure(log, criteria, target, PERIOD)
    duration = PERIOD * len(log["trajectory/phase"])
    return found, orientation.failure(found, criteria, duration)


@pytest.mark.parametrize("target", [180.0, -180.0, 90.0, -45.0])
def test_a_turn_to_the_target_that_rests_is_one(target):
    found, reason = judged_turn(turn(target=target), target)
    assert reason == ""
    assert found.turned == pytest.approx(target)
    assert found.error_end == pytest.approx(0.0, abs=1e-9)
    assert found.arrival == pytest.approx(2.0 * (1.0 - 10.0 / abs(target)), abs=1.5 * PERIOD)


@pytest.mark.parametrize(
    ("log", "reason"),
    [
        (turn(target=169.0), "turned 169 deg of 180"),
        (turn(target=-180.0), "turned -180 deg of 180"),  # the same place, the other way round
        (turn(over=3.3), "turned 180 deg of 180, but 0.88 s before the end only"),
        (turn(tilt=np.r_[np.zeros(60), np.full(30, 50.0), np.zeros(150)]),
         "sat up by 50 deg on the way"),
        (turn(tilt=np.r_[np.zeros(200), np.full(40, 31.0)]), "lies 31 deg off level at the end"),
        (turn(speed=0.31), "still moves at 0.31 m/s at the end"),
    ],
)  # fmt: skip
def test_what_is_no_turn(log, reason):
    assert judged_turn(log)[1] == reason


def test_who_is_there_from_the_first_has_to_rest_as_long():
    found = [judged_turn(turn(seconds=s, target=0.0), 0.0)[1] for s in (0.5, 1.0)]
    assert found == ["ends after 0.50 s, is to rest for 1", ""]


@pytest.mark.parametrize(
    ("name", "value"), [("error", 200.0), ("sat_up", 60.0), ("level", 40.0), ("speed", 0.4)]
)
def test_without_its_limit_each_would_be_one(name, value):
    logs = {
        "error": turn(target=0.0),
        "sat_up": turn(tilt=np.r_[np.full(30, 50.0), np.zeros(210)]),
        "level": turn(tilt=np.r_[np.zeros(200), np.full(40, 31.0)]),
        "speed": turn(speed=0.31),
    }
    assert judged_turn(logs[name])[1] != ""
    assert judged_turn(logs[name], criteria=replace(TURNING, **{name: value}))[1] == ""


# ---------------------------------------------------------------- standing


def stand(lean=0.0, height=1.0, speed=0.0, on=2, seconds=3.0):
    """Somebody who stands on ground at 7 m; `on` (n,) is the body that touches it too."""
    time = PERIOD * np.arange(round(seconds / PERIOD))
    none, angle = np.zeros_like(time), np.radians(np.broadcast_to(lean, time.shape))
    trunk = np.zeros((len(time), 3, 3))
    trunk[:, 2] = rows(np.sin(angle), none, np.cos(angle))
    touching = rows(none + 1, none + 2, none + on).astype(int)
    return {
        "command/axes": np.eye(3)[None],
        "trajectory/com": rows(none, none, 7.0 + 0.95 * np.broadcast_to(height, time.shape)),
        "trajectory/ground_height": none + 7.0,
        "trajectory/com_velocity": rows(none + speed, none, none),
        "trajectory/trunk_axes": trunk,
        "model/body": np.array([b"world", b"foot_l", b"foot_r", b"shin_l"]),
        "contacts/body": touching,
    }


def judged_stand(log, criteria=STANDING):
    duration = PERIOD * len(log["trajectory/com"])
    touched = standing.others(log, criteria.feet)
    return standing.failure(standing.measure(log, criteria, PERIOD), criteria, duration, touched)


def test_who_stays_up_has_stood():
    swaying = stand(lean=np.r_[np.full(60, 40.0), np.zeros(120)])  # a bow, and back
    assert judged_stand(stand()) == judged_stand(swaying) == ""


@pytest.mark.parametrize(
    ("log", "reason"),
    [
        (stand(on=np.r_[np.full(177, 2), np.full(3, 3)]),
         "touched the ground with more than the feet for 0.05 s"),
        (stand(height=np.r_[1.0, np.full(100, 0.84), np.ones(79)]), "sank to 0.84 of its height"),
        (stand(lean=21.0), "leans by 21 deg at the end"),
        (stand(speed=0.26), "still moves at 0.26 m/s at the end"),
    ],
)  # fmt: skip
def test_who_has_not(log, reason):
    assert judged_stand(log) == reason


def test_what_touched_is_named_where_more_than_feet_may():
    tipped = replace(LANDING, feet=("foot_l", "foot_r", "forearm_l"))
    assert judged_stand(stand(on=np.r_[np.full(177, 2), np.full(3, 3)]), tipped) == (
        "touched the ground with shin_l, which may not, for 0.05 s"
    )


def test_who_lands_may_crouch_and_then_stands_for_two_seconds():
    crouched = np.r_[1.0, np.full(59, 0.6), np.ones(120)]
    assert judged_stand(stand(height=crouched)) == "sank to 0.60 of its height"
    assert judged_stand(stand(height=crouched), LANDING) == ""


@pytest.mark.parametrize(
    ("log", "reason"),
    [
        (stand(height=np.r_[1.0, np.full(60, 0.79), np.ones(119)]), "sank to 0.79 of its height"),
        (stand(lean=np.r_[np.full(61, 21.0), np.zeros(119)]), "leans by 21 deg at the end"),
        (stand(speed=np.r_[np.full(61, 0.3), np.zeros(119)]),
         "still moves at 0.30 m/s at the end"),
        (stand(on=np.r_[3, np.full(179, 2)]),
         "touched the ground with more than the feet for 0.02 s"),
        (stand(seconds=1.9), "ends after 1.90 s, is to rest for 2"),
    ],
)  # fmt: skip
def test_who_lands_otherwise_does_not_stand(log, reason):
    assert judged_stand(log, LANDING) == reason


def test_the_torque_that_one_in_a_hundred_exceeds_is_told_as_a_share_of_the_limit():
    one_way = np.linspace(0.0, -40.0, 101)[:, None]  # of one joint, in steps of a hundredth
    log = {"trajectory/ctrl": one_way, "model/torque_limit": np.array([80.0])}
    assert _torque(log) == pytest.approx(0.5 * 0.99)
    assert np.isnan(_torque(log | {"trajectory/ctrl": one_way[:0]}))
