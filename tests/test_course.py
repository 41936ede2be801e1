"""Ways that turn: their geometry against integration and brute force, and what rolls along them."""

from math import cos, radians, sin, tau

import numpy as np
import pytest

from rotctl.behaviours.rolling.course import Course, Going, PathSettings, RatesSettings
from rotctl.config.loading import load
from rotctl.errors import InputError, LogError
from rotctl.maths.rotations import about_up, rotate
from rotctl.mechanics import excursion
from rotctl.metrics.columns import along_way, in_frame, turns
from rotctl.metrics.criteria.judge import judge
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

SLALOM = ((4.0, 45.0), (8.0, -90.0), (4.0, 45.0))
PERIOD = 1.0 / 60.0


def path(*legs, repeat=False, ahead=0.0, pull=0.0, most=30.0):
    return PathSettings("path", legs, ahead, pull, most, repeat).make()


# ---------------------------------------------------------------- a path


@pytest.mark.parametrize("repeat", [False, True])
def test_a_path_is_where_its_directions_lead(repeat):
    """The place against the integral of the direction; the direction against that of the bend."""
    way, step, total = path(*SLALOM, repeat=repeat), 1e-3, 40.0
    points = np.array([way.at(s) for s in np.arange(-1.0, total, step)])
    ahead = np.column_stack((np.cos(points[:, 2]), np.sin(points[:, 2])))
    assert np.diff(points[:, :2], axis=0) / step == pytest.approx(ahead[:-1], abs=2e-4)
    assert points[:, 2] == pytest.approx(np.cumsum(points[:, 3]) * step, abs=1e-3)
    assert (points[-1, 3] == 0.0) == (not repeat)


def test_a_whole_circle_ends_where_it_began():
    way = path((37.699, 360.0), repeat=True)
    for laps in (1, 3):
        point = way.at(laps * 37.699)
        assert point[:2] == pytest.approx((0.0, 0.0), abs=1e-9)
        assert point.turned == pytest.approx(laps * tau)
    assert way.at(37.699 / 2)[:2] == pytest.approx((0.0, 12.0), abs=1e-3)


def test_the_nearest_point_is_that_of_a_search():
    """Followed as a roll would be, 1 m to either side of a slalom."""
    way = path(*SLALOM, repeat=True)
    dense = np.array([way.at(s)[:2] for s in np.arange(0.0, 30.0, 0.005)])
    along = 0.0
    for s in np.arange(0.0, 25.0, 0.03):
        point, beside = way.at(s), sin(s)
        x, y = point.x - beside * sin(point.turned), point.y + beside * cos(point.turned)
        along = way.nearest(along, x, y)
        found = np.hypot(*(np.array(way.at(along)[:2]) - (x, y)))
        assert found == pytest.approx(np.hypot(*(dense - (x, y)).T).min(), abs=1e-3)


def test_who_is_beside_a_path_turns_back_to_it():
    way = path((50.0, 0.0), pull=20.0, most=30.0)
    left, right, far = (
        way.follow(Course(along=2.9), Going(3.0, y, 1.3), 0.0, PERIOD) for y in (0.5, -0.5, 4.0)
    )
    assert [round(each.turned / radians(1.0), 6) for each in (left, right, far)] == [-10, 10, -30]
    assert left.place == pytest.approx((3.0, 0.0))
    assert left.rate == 0.0


def test_a_path_is_turned_with_ahead_of_time():
    way = path((5.0, 0.0), (6.0, 90.0), ahead=0.5)
    course = way.follow(Course(along=4.9), Going(4.9, 0.0, 1.2), 0.0, PERIOD)
    assert course.turned == pytest.approx(0.5 * radians(15.0))  # 0.5 m into the arc, 15 deg a metre
    assert course.rate == pytest.approx(1.2 * radians(15.0))


def test_rates_hold_from_their_times_on():
    rates, course = RatesSettings("rates", ((1.0, 30.0), (2.0, -10.0))).make(), Course()
    for i in range(240):
        course = rates.follow(course, Going(0.0, 0.0, 1.5), (i + 0.5) * PERIOD, PERIOD)
    assert course.turned == pytest.approx(radians(30.0 - 2 * 10.0))
    assert course.rate == pytest.approx(radians(-10.0))
    assert course.along == pytest.approx(6.0)
    assert course.place is None


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        (["behaviour.course.legs=[[1,90]]"], "an arc with a radius of 0.64 m; nothing rolls along"),
        (["behaviour.course.legs=[]"], "behaviour.course.*legs"),
        (["behaviour.course.legs=[[0,10]]"], "greater than or equal to 0.1"),
        (["behaviour.course.kind=circle"], "'path'"),
        (
            ["behaviour.pace=null", "excursion=root"],
            "behaviour.course: excursion=root controls the root's",
        ),
        (
            ["behaviour.pace=null", "behaviour.angular_momentum=20"],
            "a course commands velocities: give no angular_momentum",
        ),
    ],
)
def test_one_line_for_what_does_not_fit(overrides, said):
    with pytest.raises(InputError, match=said):
        build(load(["behaviour=forward_roll", "+course=circle", *overrides]))


def test_times_of_rates_must_grow():
    with pytest.raises(InputError, match=r"^behaviour\.course\.schedule: its times must grow$"):
        load(["behaviour=forward_roll", "+course=turn", "behaviour.course.schedule=[[2,1],[2,2]]"])


@pytest.mark.parametrize(
    ("overrides", "told"),
    [
        (["behaviour.pace.schedule=[[3,0.7],[20,0.5]]"], "pace.schedule: what it tells from 20 s"),
        (["+course=turn", "duration=2"], "course.schedule: what it tells from 2 s"),
    ],
)
def test_what_a_schedule_tells_comes_in_the_run(overrides, told):
    with pytest.raises(InputError) as raised:
        build(load(["behaviour=forward_roll", *overrides]))
    over = "2 s" if "duration=2" in overrides else "20 s"
    assert str(raised.value) == f"behaviour.{told} on never comes, the run is over at {over}"


# ---------------------------------------------------------------- an excursion that turns along


def test_what_is_off_the_axis_is_as_far_off_for_who_has_turned():
    rng = np.random.default_rng(0)
    left, other = np.array([0.0, 1.0, 0.0]), about_up(0.7)
    now = excursion.start(0.4, left)
    for velocity in rng.normal(size=(30, 3)):
        now = excursion.integrate(now, velocity, left, left, PERIOD, 3.0)
    target = 2.0 * left
    missing = excursion.error(now, target, left, "oriented")
    there = excursion.turned(now, other)
    seen = excursion.error(there, rotate(other, target), rotate(other, left), "oriented")
    assert seen == pytest.approx(rotate(other, missing), abs=1e-12)
    assert there.phase == now.phase


# ---------------------------------------------------------------- a roll


def rolled(*overrides):
    config = load(["behaviour=forward_roll", *overrides])
    scenario = build(config)
    log = in_memory(scenario)[0].arrays()
    asked, period = config.behaviour.commanded, 1.0 / config.controller.rate
    return log, judge(log, config.criteria, asked, period, config.duration, scenario.model.mj)


def test_a_circle_is_rolled():
    """By places and the trunk alone: whatever control and metrics think of the way."""
    log, judged = rolled("+course=circle", "duration=10", "seed=2003")
    assert not judged.reason
    com = log["trajectory/com"]
    radius = np.hypot(com[:, 0] - com[0, 0], com[:, 1] - com[0, 1] - 6.0)
    off = np.abs(radius - 6.0)
    assert off.max() < 0.8
    columns = judged.columns
    assert columns["lateral_drift"] == pytest.approx(off.max(), abs=2e-3)
    assert columns["lateral_rms"] == pytest.approx(np.sqrt((off**2).mean()), abs=2e-3)
    axis = log["trajectory/trunk_axis"]
    heading = np.degrees(np.unwrap(np.arctan2(-axis[:, 0], axis[:, 1])))
    travelled = columns["travel_mean"] * columns["angular_velocity_mean"] * 10.0
    assert heading[-30:].mean() == pytest.approx(np.degrees(travelled / 6.0), abs=25.0)
    assert columns["revolutions"] > 5.0


def test_a_commanded_rate_of_turning_is_met():
    log, judged = rolled("+course=turn", "behaviour.course.schedule=[[1,-12]]", "duration=6")
    assert judged.columns["revolutions"] > 3.0
    axis = log["trajectory/trunk_axis"]
    heading = np.degrees(np.unwrap(np.arctan2(-axis[:, 0], axis[:, 1])))
    assert heading[-30:].mean() == pytest.approx(-12.0 * (6.0 - 0.25 - 1.0), abs=12.0)
    assert np.isnan([judged.columns["lateral_rms"], judged.columns["lateral_drift"]]).all()
    assert not judged.reason  # and no rule asks how far it is from where there is no path


def test_who_stands_up_faces_where_the_way_led():
    """Who squats askew stands so, one in a few: of four starts the middle ones face along it."""
    aside = []
    for seed in range(2000, 2004):
        log, judged = rolled(
            *("+course=circle", "+finish=stand", "behaviour.finish.after=3", "duration=9"),
            *("behaviour.angular_velocity=0.7", f"seed={seed}"),
        )
        assert 3.0 <= judged.columns["stands_from"] < 8.5
        stands = log["command/stage"] > 0
        front = log["trajectory/trunk_axes"][-1][:, 0]
        way = log["command/axes"][~stands][-1, 0]
        assert np.degrees(np.arctan2(way[1], way[0])) > 25.0, "it has come a way round"
        aside.append(np.degrees(np.arccos(front @ way)))
        assert (log["command/axes"][stands] == log["command/axes"][-1]).all()
        assert log["command/axes"][-1, 0] == pytest.approx(way, abs=1e-3)
    assert np.median(aside) < 25.0


def test_a_way_that_does_not_turn_is_as_before():
    log, _ = rolled("behaviour.heading=30", "duration=0.5")
    assert not turns(log)
    assert (along_way(log) == in_frame(log, "trajectory/com")).all()


def test_a_log_that_turns_and_has_no_way_is_told():
    row = np.eye(3)
    log = {
        "command/axes": np.array([row, row[[1, 0, 2]]]),
        "trajectory/com": np.zeros((2, 3)),
        "command/target": np.zeros((2, 1, 4)),
        "model/task": np.array([b"spin"]),
    }
    with pytest.raises(LogError, match="no task linear, which tells the way"):
        along_way(log)
