"""Somersaults that end standing, and what they are judged by."""

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.maths.rotations import rotate
from rotctl.metrics.criteria.flip import FlipCriteria, longest_flight, measure, turn
from rotctl.metrics.criteria.flip import judge as judge_flip
from rotctl.metrics.criteria.standing import StandingCriteria
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

PERIOD = 1 / 240
LANDING = StandingCriteria("landing", "landing", ("foot_l", "foot_r"), 0.5, 0.8, 20.0, 0.25)
FLIP = FlipCriteria("flip", "flip", 45.0, 0.3, LANDING)
LEFT = np.array([0.0, 1.0, 0.0])


@pytest.fixture(scope="module")
def flip():
    """A back flip, and its rows."""
    scenario = build(load(["behaviour=back_flip", "seed=2000", "plant=varied", "duration=6"]))
    buffer, ending = in_memory(scenario)
    assert not ending
    return scenario, buffer.arrays()


def rows_in_the_air(log):
    first, last = longest_flight(log)
    return slice(first, last)


def test_it_turns_once_and_stands(flip):
    scenario, log = flip
    columns, reason = judge_flip(log, scenario.config.criteria, -360.0, PERIOD)
    assert reason == ""
    assert columns["revolved"] == pytest.approx(-360.0, abs=10.0)
    assert columns["other_contact"] == 0.0


def test_most_starts_stand(flip):
    """Of other starts and bodies: they all did, one may fall."""
    stood = 0
    for seed in (2001, 2002, 2003):
        config = load(["behaviour=back_flip", f"seed={seed}", "plant=varied", "duration=6"])
        scenario = build(config)
        buffer, ending = in_memory(scenario)
        _, reason = judge_flip(buffer.arrays(), config.criteria, -360.0, PERIOD)
        stood += not ending and not reason
    assert stood >= 2


def test_a_front_flip_stands_from_most_starts():
    """As above."""
    stood = 0
    for seed in (2001, 2002, 2003):
        config = load(["behaviour=front_flip", f"seed={seed}", "plant=varied", "duration=6"])
        buffer, ending = in_memory(build(config))
        stood += not ending and not judge_flip(buffer.arrays(), config.criteria, 360.0, PERIOD)[1]
    assert stood >= 2


def test_the_flight_is_as_long_as_its_speed_makes_it(flip):
    """t = (v + sqrt(v^2 + 2 g (z0 - z1))) / g, of what was simulated."""
    _, log = flip
    rows = rows_in_the_air(log)
    v, z = log["trajectory/com_velocity"][rows, 2], log["trajectory/com"][rows, 2]
    time = (v[0] + np.sqrt(v[0] ** 2 + 2 * 9.81 * (z[0] - z[-1]))) / 9.81
    assert (rows.stop - rows.start) * PERIOD == pytest.approx(time, abs=0.015)


def test_it_keeps_its_momentum_and_its_plane_in_the_air(flip):
    """H is the launch's; arms alone keep the pelvis in the plane, which H does not do by itself."""
    _, log = flip
    rows = rows_in_the_air(log)
    momentum = log["trajectory/angular_momentum"][rows]
    assert np.abs(momentum - momentum[0]).max() < 0.06 * abs(momentum[0, 1])
    side = np.array([rotate(q, LEFT) for q in log["trajectory/qpos"][rows, 3:7]])
    tilt = np.degrees(np.arccos(np.clip(side[:, 1], -1.0, 1.0)))
    assert tilt[-1] < 5.0


def test_it_is_launched_with_the_momentum_that_it_needs(flip):
    """Neither too little nor too much: the regulator is never at its end for long."""
    scenario, log = flip
    rows = rows_in_the_air(log)
    inertia = np.abs(
        log["trajectory/angular_momentum"][rows, 1] / log["trajectory/angular_velocity"][rows, 1]
    )
    law = scenario.behaviour._laws["flight"]
    assert inertia.min() > 0.95 / law.tucking.slowness.max()


# ---------------------------------------------------------------- what judges it


def a_log(pitch, contacts, speed=0.0):
    """Rows of a body that pitches about left, touching the ground with so many points."""
    n = len(pitch)
    front = np.stack([np.cos(pitch), 0 * pitch, -np.sin(pitch)], axis=1)
    up = np.stack([np.sin(pitch), 0 * pitch, np.cos(pitch)], axis=1)
    left = np.tile(LEFT, (n, 1))
    return {
        "trajectory/time": PERIOD * np.arange(n),
        "trajectory/com": np.tile([0.0, 0.0, 1.0], (n, 1)),
        "trajectory/com_velocity": np.tile([speed, 0.0, 2.0], (n, 1)),
        "trajectory/angular_momentum": np.tile([0.0, -40.0, 0.0], (n, 1)),
        "trajectory/trunk_axes": np.stack([front, left, up], axis=2),
        "trajectory/ground_height": np.zeros(n),
        "command/axes": np.tile(np.eye(3), (n, 1, 1)),
        "model/body": np.array([b"world", b"foot_l", b"head"]),
        "model/joint": np.array([b"knee_l"]),
        "model/torque_limit": np.array([200.0]),
        "trajectory/qvel": np.zeros((n, 7)),
        "trajectory/ctrl": np.zeros((n, 1)),
        "contacts/body": np.where(np.asarray(contacts)[:, None] > 0, 1, -1),
        "contacts/count": np.asarray(contacts),
    }


@pytest.mark.parametrize("degrees", [-720.0, -360.0, 360.0, 30.0])
def test_turns_are_counted_as_they_are_made(degrees):
    log = a_log(np.radians(np.linspace(0.0, degrees, 500)), np.ones(500, int))
    assert turn(log)[-1] == pytest.approx(degrees, abs=1e-6)


def test_the_longest_flight_is_found():
    contacts = np.array([1] * 5 + [0] * 3 + [2] * 4 + [0] * 7 + [1] * 6)
    log = a_log(np.zeros(25), contacts)
    assert longest_flight(log) == (12, 19)
    assert measure(log, FLIP, PERIOD).flight_time == pytest.approx(7 * PERIOD)


def test_reasons():
    still = a_log(np.zeros(200), np.ones(200, int))
    still["trajectory/com_velocity"] *= 0.0
    assert judge_flip(still, FLIP, -360.0, PERIOD)[1] == "turned 0 deg of -360"
    once = np.radians(np.linspace(0.0, -360.0, 200))
    rolled = a_log(np.concatenate((once, once[-1:].repeat(200))), np.ones(400, int))
    assert judge_flip(rolled, FLIP, -360.0, PERIOD)[1] == "was in the air for 0.00 s"
    flown = a_log(np.concatenate((once, once[-1:].repeat(200))), [0] * 200 + [1] * 200, speed=1.0)
    assert judge_flip(flown, FLIP, -360.0, PERIOD)[1] == "still moves at 2.24 m/s at the end"


def test_no_rows_are_no_numbers():
    empty = a_log(np.zeros(0), np.zeros(0, int))
    assert np.isnan(measure(empty, FLIP, PERIOD).revolved)
