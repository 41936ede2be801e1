"""A roll that keeps a commanded pace, and ends on its feet."""

import math
from dataclasses import replace
from math import tau

import numpy as np
import pytest

from rotctl.behaviours.rolling.pace_settings import SLIP, PaceSettings
from rotctl.behaviours.rolling.pacing import Clock, Pace
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.metrics.criteria.judge import judge
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

PERIOD = 1.0 / 60.0
SETTINGS = PaceSettings(
    keep="rate",
    travel=2.0,
    own=0.8,
    calm=0.25,
    swing=0.4,
    swing_from=0.1,
    surge=0.3,
    surge_from=0.2,
    wait=0.05,
    width=0.3,
    over=("foot",),
    ahead=0.1,
    settling=(4.0, 3.0),
    brake=5.0,
    gain=4.0,
    most=1.5,
)


def wanted(turn, late=0.0, rate=0.8, ahead=0.0, **changes):
    """What is asked for at a phase [rev]."""
    pace = Pace(replace(SETTINGS, **changes), rate, 0.0)
    return pace.at(tau * turn, ahead, late, 0.0)


# ---------------------------------------------------------------- what is asked for


def test_in_time_it_flows_as_the_motion_does():
    turns = np.arange(360) / 360.0
    asked = [wanted(turn) for turn in turns]
    rates, speeds = np.array([(one.rate, one.speed) for one in asked]).T
    assert rates.mean() == pytest.approx(0.8)
    assert speeds.mean() == pytest.approx(2.0 * 0.8)
    assert (rates.min(), rates.max()) == pytest.approx((0.8 * 0.6, 0.8 * 1.4), rel=1e-3)
    assert turns[rates.argmin()] == pytest.approx(0.1, abs=0.01)
    assert turns[speeds.argmin()] == pytest.approx(0.2, abs=0.01)
    assert {one.brake for one in asked} == {1.0}


def test_what_is_commanded_quicker_than_its_own_pace_flows_quicker():
    quick = np.mean([wanted(turn, rate=1.2).rate for turn in np.arange(360) / 360.0])
    slow = np.mean([wanted(turn, rate=0.3).rate for turn in np.arange(360) / 360.0])
    assert (quick, slow) == pytest.approx((1.2, 0.8))


def test_early_it_waits_over_its_feet():
    here = wanted(0.05, late=-0.4, ahead=0.1)
    assert here == pytest.approx((0.0, 0.0, 5.0, 0.0, 1.0), abs=1e-12)
    behind = wanted(0.05 - 0.02, late=-0.4, ahead=-0.1)
    assert behind.rate == pytest.approx(4.0 * 0.02, rel=0.1)
    assert behind.speed == pytest.approx(3.0 * 0.2, rel=0.1)
    beyond = wanted(0.05 + 0.02, late=-0.4, ahead=0.3)
    assert max(beyond.rate, beyond.speed) < 0.0, "and comes back to them"


def test_early_it_is_calmer_and_does_not_wait_on_its_back():
    assert wanted(0.55, late=-0.4).rate == pytest.approx(0.75 * wanted(0.55).rate)
    assert wanted(0.55, late=-0.4).brake == 1.0


def test_it_is_braked_on_the_way_up_from_the_seat_only_so_far_before_as_is_asked():
    late, up, over = -0.4, 0.05 - 0.2, 0.05 + 0.2
    assert wanted(up, late).brake > 1.9
    assert wanted(up, late, approach=0.2).brake == 1.0
    assert wanted(0.05 - 0.1, late, approach=0.2).brake == pytest.approx(3.0)  # half-way to 5
    assert wanted(over, late, approach=0.2) == wanted(over, late)
    assert wanted(up, 0.1, approach=0.01) == wanted(up, 0.1), "it hurries there as before"


def test_its_poses_go_back_as_far_as_it_waits():
    assert wanted(0.05, late=-0.4, back=0.12).back == pytest.approx(0.12)
    assert wanted(0.05, late=-0.125, back=0.12).back == pytest.approx(0.06)
    assert wanted(0.05, late=0.1, back=0.12).back == wanted(0.55, late=-0.4, back=0.12).back == 0.0


def test_late_it_hurries_where_it_else_waits():
    assert wanted(0.05, late=0.1).rate == pytest.approx(1.4 * wanted(0.05).rate)
    assert wanted(0.05, late=0.4).rate == pytest.approx(1.5 * wanted(0.05).rate)  # at most
    assert wanted(0.55, late=0.4).rate == wanted(0.55).rate


# ---------------------------------------------------------------- the clock


def test_the_clock_runs_at_the_commanded_pace():
    pace, clock = Pace(SETTINGS, 0.5, 9.0), Clock(0.0)
    for row in range(1, 61):
        clock = pace.tick(clock, 0.3 * row * PERIOD, row * PERIOD, PERIOD)
    assert clock == pytest.approx((0.5, 0.2))


@pytest.mark.parametrize(("pace", "late"), [(0.0, SLIP), (5.0, -SLIP)])
def test_it_does_not_run_away_from_a_roll_that_stalls_or_flies(pace, late):
    run, clock = Pace(SETTINGS, 0.5, 9.0), Clock(0.0)
    for row in range(1, 601):
        clock = run.tick(clock, pace * row * PERIOD, row * PERIOD, PERIOD)
    assert clock.late == late


def test_what_it_is_ahead_beyond_its_patience_is_not_waited_for():
    pace, clock = Pace(replace(SETTINGS, patience=0.2), 0.5, 9.0), Clock(0.0)
    assert pace.tick(clock, 0.7, PERIOD, PERIOD) == pytest.approx((0.5, -0.2))
    assert pace.tick(clock, -9.0, PERIOD, PERIOD).late == SLIP


def test_the_master_is_the_rate_or_the_speed():
    assert Pace(SETTINGS, 0.5, 9.0).commanded(0.0) == 0.5
    assert Pace(replace(SETTINGS, keep="speed"), 0.5, 1.2).commanded(0.0) == 0.6


def test_a_schedule_takes_over_at_its_times():
    pace = Pace(replace(SETTINGS, schedule=((2.0, 0.9), (5.0, 0.4))), 0.6, 0.0)
    assert [pace.commanded(t) for t in (0.0, 1.9, 2.0, 4.9, 5.0, 50.0)] == [
        *(0.6, 0.6, 0.9, 0.9, 0.4, 0.4)
    ]
    with pytest.raises(ValueError, match="its times must grow"):
        replace(SETTINGS, schedule=((2.0, 0.9), (2.0, 0.4)))


# ---------------------------------------------------------------- halts


def test_at_a_command_of_nothing_it_waits_at_once_and_goes_on_at_once():
    pace = Pace(replace(SETTINGS, schedule=((2.0, 0.0), (5.0, 0.6))), 0.6, 0.0)
    assert pace.at(tau * 0.05, 0.1, 0.0, 3.0) == pytest.approx((0.0, 0.0, 5.0, 0.0, 1.0), abs=1e-12)
    clock = Clock(7.0, 0.3)
    for row in range(120, 301):  # nothing is made good after a halt
        clock = pace.tick(clock, 6.8, row * PERIOD, PERIOD)
    assert clock == pytest.approx((6.8 + 0.6 * PERIOD, 0.6 * PERIOD))
    assert pace.at(tau * 0.05, 0.1, clock.late, 5.0).brake == 1.0


def test_who_has_stopped_is_held_less_stiffly():
    pace = Pace(replace(SETTINGS, schedule=((2.0, 0.0),), easing=0.5), 0.6, 0.0)
    speeds = (2.0, 0.5, 0.25, -0.25, 0.0)
    brakes = [pace.at(tau * 0.05, 0.1, 0.0, 3.0, speed).brake for speed in speeds]
    assert brakes == pytest.approx([5.0, 5.0, 3.0, 3.0, 1.0])
    assert pace.at(tau * 0.05, 0.1, -0.5, 1.0, 0.0).brake == 5.0, "who only waits is"


@pytest.mark.parametrize(
    ("schedule", "first", "halts"),
    [
        ((), 0.7, ()),
        (((7.0, 0.0), (10.0, 0.6)), 0.7, ((7.0, 10.0),)),
        (((3.0, 0.6), (9.0, 0.0)), 0.0, ((0.0, 3.0), (9.0, math.inf))),
    ],
)
def test_when_it_is_told_to_halt(schedule, first, halts):
    settings = replace(SETTINGS, schedule=schedule)
    assert settings.halts(first) == halts


def test_it_halts_in_the_squat_and_goes_on():
    """By where the feet and the trunk are, from starts of which most do."""
    still, on = 0, 0
    for seed in (2001, 2003, 2005):
        log, judged = rolled(
            *("behaviour.pace.schedule=[[3,0],[7,0.7]]", "duration=11", f"seed={seed}")
        )
        rows = slice(6 * 60, 7 * 60)
        feet = [list(log["model/body"]).index(name) for name in (b"foot_l", b"foot_r")]
        stood = np.isin(log["contacts/body"][rows], feet).any(axis=1).all()
        upright = log["trajectory/trunk_axes"][rows, 2, 2].min() > 0.0
        still += bool(stood and upright and np.ptp(log["trajectory/com"][rows, 0]) < 0.1)
        on += log["trajectory/com"][-1, 0] - log["trajectory/com"][7 * 60, 0] > 2.5
        assert judged.columns["longest_stall"] < 1.5
    assert still >= 2
    assert on >= 2


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        (["behaviour.angular_velocity=5"], "behaviour.angular_velocity: 5 rev/s cannot be rolled"),
        (["behaviour.pace.schedule=[[3,1.9]]"], "schedule: 1.9 rev/s .* give at most 1.57"),
        (["behaviour.pace.keep=speed", "behaviour.speed=3"], "speed: 3 m/s .* at most 2.83"),
        (["physics.gravity=[0,0,-2]"], "angular_velocity: 0.75 rev/s .* at most 0.71"),
    ],
)
def test_what_no_body_can_roll_is_refused(overrides, said):
    with pytest.raises(InputError, match=said):
        build(load(["behaviour=forward_roll", "behaviour.angular_velocity=0.75", *overrides]))


# ---------------------------------------------------------------- a roll


def rolled(*overrides):
    config = load(["behaviour=forward_roll", *overrides])
    scenario = build(config)
    log = in_memory(scenario)[0].arrays()
    period, asked = 1.0 / config.controller.rate, config.behaviour.commanded
    mj, halts = scenario.model.mj, config.behaviour.halts
    return log, judge(log, config.criteria, asked, period, config.duration, mj, halts)


@pytest.mark.parametrize("rate", [0.55, 0.9])
def test_a_commanded_rate_is_met(rate):
    off = [
        rolled(f"seed={seed}", f"behaviour.angular_velocity={rate}", "duration=8")[1]
        for seed in (2000, 2001)
    ]
    assert min(one.columns["rate_error"] for one in off) < 0.1


def test_a_contradicting_pair_is_met_in_its_master():
    pair = ["behaviour.angular_velocity=0.5", "behaviour.speed=1.6", "duration=8", "seed=2000"]
    by_rate = rolled(*pair)[1].columns
    by_speed = rolled(*pair, "behaviour.pace.keep=speed")[1].columns
    rates, speeds = (
        [abs(found[name] - wanted) for found in (by_rate, by_speed)]
        for name, wanted in (("angular_velocity_mean", 0.5), ("speed_mean", 1.6))
    )
    assert rates[0] < rates[1]
    assert speeds[1] < speeds[0]


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        (["behaviour.angular_velocity=-0.5"], "a pace is kept forward: give angular_velocity and"),
        (["behaviour.angular_momentum=5"], "a pace commands velocities: give no angular_momentum"),
        (["+finish=stand", "behaviour.pace=null"], "a roll without a pace does not wait, so that"),
        (["+behaviour.pace.over=[toe]"], "behaviour.pace.over"),
        (
            ["+finish=stand", "criteria=rolling"],
            "does not judge behaviour=forward_roll, a behaviour",
        ),
        (["criteria=finish"], "choose criteria of kind rolling, such as criteria=path"),
        (["behaviour.pace.wait=315"], "behaviour.pace.wait=315: must be less than or equal to 1"),
        (
            ["behaviour.pace.schedule=[[0,0],[0.05,0]]"],
            "behaviour: is told to halt from 0 s to the end, which is no roll",
        ),
        (["behaviour.angular_velocity=0"], "is told to halt from 0 s to the end"),
        (
            ["+finish=stand", "behaviour.finish.after=20"],
            "behaviour.finish.after=20: it is never told to end, the run is over at 20 s; give "
            "less than that, or a longer duration",
        ),
        (["+finish=stand", "duration=5"], "behaviour.finish.after=8: it is never told to end, the"),
    ],
)
def test_one_line_for_what_does_not_fit(overrides, said):
    with pytest.raises(InputError, match=said):
        build(load(["behaviour=forward_roll", *overrides]))


# ---------------------------------------------------------------- the end


def test_it_comes_up_to_standing_and_stays():
    log, judged = rolled("+finish=stand", "behaviour.finish.after=3", "duration=10", "seed=2000")
    assert not judged.reason
    assert judged.columns["revolutions"] > 1.0
    assert 3.0 <= judged.columns["stands_from"] < 8.0
    assert log["trajectory/com"][-1, 2] > 0.9
    stage = log["command/stage"]
    assert (np.diff(stage) >= 0).all()
    assert set(stage.tolist()) == {0, 1}


def test_the_stages_tasks_are_in_the_log_beside_the_roll_s():
    log, _ = rolled("+finish=stand", "behaviour.finish.after=3", "duration=10", "seed=2003")
    names = [name.decode() for name in log["model/task"].tolist()]
    first = int(np.argmax(log["command/stage"] > 0))
    balance, linear = names.index("balance"), names.index("linear")
    wanted = log["command/wanted"]
    assert wanted[:first, linear].any()
    assert not wanted[:first, balance].any()
    assert wanted[first:, balance].any()
    assert not wanted[first:, linear].any()
    assert len(set(names)) == len(names)


def test_turning_half_a_revolution_on_is_furthest_from_waiting():
    pace = Pace(SETTINGS, 0.5, 1.0)
    assert pace.before(tau * 0.05) == pytest.approx(0.0)
    assert pace.before(tau * 1.0) == pytest.approx(0.05)
    assert abs(pace.before(tau * 0.55)) == pytest.approx(0.5)
