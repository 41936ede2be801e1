"""The pose that a roll takes while it waits for its clock."""

from dataclasses import replace

import numpy as np
import pytest

from rotctl.behaviours.rolling.pacing import Pace
from rotctl.behaviours.rolling.waiting import Waiting
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build


@pytest.fixture(scope="module")
def model():
    return build(load(["behaviour=decline"])).known


def settled(model, angles, waits):
    """Where joints come to that were at 0.2 rad, of those that move [rad]."""
    before = np.full(len(model.joint_names), 0.2)
    after = Waiting(angles, model).settled(before, waits)
    both = zip(model.joint_names, after.tolist(), strict=True)
    return {name: angle for name, angle in both if angle != 0.2}


def test_it_comes_as_far_as_it_waits_and_other_joints_stay(model):
    angles = {"knee": 2.2, "elbow_r": 0.0}
    assert settled(model, angles, 0.0) == {}
    half = {"knee_l": 1.2, "knee_r": 1.2, "elbow_r": 0.1}
    assert settled(model, angles, 0.5) == pytest.approx(half)
    whole = {"knee_l": 2.2, "knee_r": 2.2, "elbow_r": 0.0}
    assert settled(model, angles, 1.0) == pytest.approx(whole)


def test_an_angle_beyond_a_joints_stops_is_refused():
    """Such as one in degrees."""
    with pytest.raises(InputError) as error:
        build(load(["behaviour=decline", "behaviour.pace.pose.knee=150"]))
    assert str(error.value) == "behaviour.pace.pose.knee=150: this joint goes from -0.02 to 2.7 rad"


def test_an_unknown_joint_is_named():
    with pytest.raises(InputError, match=r"behaviour\.pace\.pose names the unknown joint 'toe'"):
        build(load(["behaviour=decline", "+behaviour.pace.pose.toe=1"]))


def test_limbs_are_ready_before_it_is_braked_and_leave_when_it_does():
    given = load(["behaviour=decline"]).behaviour.pace
    settings = replace(given, width=0.45, approach=0.15, leave=0.2)
    pace, wait = Pace(settings, 0.4, 1.0), settings.wait

    def at(turn, late=-0.25):
        return pace.at(2 * np.pi * (wait + turn), 0.0, late, 0.0)

    assert at(0.0).waits == 1.0
    assert at(-0.16).brake == 1.0, "beyond its approach of 0.15 rev"
    assert at(-0.16).waits > 0.7
    assert (at(0.21).waits, at(0.21).brake) == (0.0, 1.0)
    assert at(0.0, 0.1).waits == 0.0, "who is late does not wait"


def test_who_is_stopped_short_of_its_wait_takes_the_pose_late_or_not():
    """By how much slower it turns than the motion by itself, and no further off than `approach`."""
    settings = replace(load(["behaviour=decline"]).behaviour.pace, approach=0.16)
    pace, own = Pace(settings, 0.4, 1.0), settings.own

    def waits(turn, turns):
        return pace.at(2 * np.pi * (settings.wait + turn), 0.0, 0.1, 0.0, 0.0, turns * own).waits

    assert (waits(0.0, 0.0), waits(0.0, 0.25), waits(0.0, 1.0)) == pytest.approx((1.0, 0.75, 0.0))
    assert waits(0.0, -0.5) == 1.0, "who falls back has no more than all of it"
    assert waits(-0.05, 0.0) == pytest.approx(waits(0.05, 0.0)) != 0.0
    assert waits(-0.17, 0.0) == waits(0.17, 0.0) == 0.0


@pytest.mark.parametrize("seed", [2000, 2001])
def test_down_a_slope_it_waits_on_its_feet_with_its_head_up(seed):
    """Of the time that it is slow on the way, by where head, seat and feet are."""
    scenario = build(load(["behaviour=decline", "duration=8", f"seed={seed}"]))
    log = in_memory(scenario)[0].arrays()
    names = [name.decode() for name in log["model/body"].tolist()]
    feet = [names.index("foot_l"), names.index("foot_r")]
    slow = (log["trajectory/com_velocity"][:, 0] < 0.25) & (log["trajectory/time"] > 1.5)
    assert slow.sum() > 10
    on_feet = np.isin(log["contacts/body"][slow], feet).any(axis=1)
    upright = log["trajectory/trunk_axes"][slow, 2, 2]  # of the trunk's way to the head
    assert on_feet.mean() > 0.6
    assert np.median(upright) > -0.6, "its trunk hangs by 37 degrees at most"


@pytest.mark.parametrize(
    ("row", "seed"),
    [
        *(("decline", seed) for seed in (2202, 2241, 2257)),
        *(("forward_roll_2", seed) for seed in (3001, 3004, 3011)),
    ],
)
def test_on_hard_ground_it_comes_up_from_its_first_seat(row, seed):
    """These sat down there while their phase took three times as long to come to the trunk."""
    overrides = [f"behaviour={row}", "physics=lockstep", "duration=2.6", f"seed={seed}"]
    log = in_memory(build(load(overrides)))[0].arrays()
    rising = (log["trajectory/phase"] > 0.8 * 2 * np.pi) & (log["trajectory/phase"] < 2 * np.pi)
    assert rising.any()
    assert log["trajectory/angular_velocity"][rising, 1].min() > 0.2 * 2 * np.pi
    assert log["trajectory/phase"][-1] > 2 * np.pi
