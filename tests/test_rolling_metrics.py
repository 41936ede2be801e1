"""A roll in numbers, on logs made by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.metrics.criteria.rolling import (
    RollingCriteria,
    RollingMetrics,
    measure,
)
from rotctl.metrics.criteria.rolling_rules import failure_reason
from rotctl.metrics.quantile import median, percentile
from rotctl.metrics.revolutions import OF_REVOLUTIONS
from rotctl.metrics.turning import longest_stall, revolutions, setback, turned_about
from rotctl.results.group_table import OF_ROLLS_IN_FILES_ONLY

PERIOD = 1.0 / 60.0
CRITERIA = RollingCriteria(
    name="test",
    kind="rolling",
    stall_time=1.5,
    stall_progress=0.1,
    revolution_time=6.0,
    setback=0.25,
    height=(0.05, 0.8),
    penetration=0.12,
    flight_turn=0.5,
    trunk_turn=0.7,
    axis=30.0,
    travel=(0.5, 3.5),
    heading=30.0,
    lateral_drift=3.0,
    settle=2.0,
    recovery_time=2.0,
    recovery_heading=15.0,
    recovery_progress=0.5,
)
GOOD = RollingMetrics(
    duration=20.0,
    revolutions=9.0,
    angular_velocity_mean=0.45,
    speed_mean=0.4,
    heading_error_end=3.0,
    lateral_drift=0.5,
    lateral_rms=0.2,
    longest_stall=0.4,
    stalled_at=2.0,
    went_on=math.nan,
    slowest_revolution=1.5,
    setback=0.0,
    height_least=0.25,
    height_most=0.5,
    penetration=0.03,
    flight_turn=0.1,
    trunk_turn=0.9,
    axis_error=8.0,
    travel_least=1.7,
    travel_most=2.2,
    ground_force_p99=2000.0,
    ground_force_peak=4000.0,
    airborne=0.0,
    jerk=500.0,
    chatter=5.0,
    sticking=0.1,
    recovery=0.5,
    recovered=1.0,
    torque_p99_fraction=0.6,
    solver_failures=0,
)


def make_log(steps=600, rate=0.5, speed=0.9, heading=0.0, lateral=0.0, turns=None, spin=None):
    """A steady roll of `rate` [rev/s] at `speed` [m/s], at a heading [deg], drifting [m/s].

    `turns` (n,) [rev] is the in-plane excursion instead; `spin` (n,) [rev] how far the root has
    turned about the trunk's axis, if it is not the same.
    """
    time = PERIOD * np.arange(steps)
    turns = rate * time if turns is None else turns
    turn = np.radians(np.broadcast_to(heading, steps))
    axis = np.stack((-np.sin(turn), np.cos(turn), 0 * turn), axis=1)
    about = 2 * np.pi * (turns if spin is None else spin)[:, None] * axis
    none = np.zeros(steps)
    travelled = np.cumsum(np.broadcast_to(speed, steps)) * PERIOD
    return {
        "trajectory/com": np.stack((travelled, lateral * time, none), axis=1) + [2.0, -1.0, 7.4],
        "trajectory/ground_height": none + 7.0,
        "trajectory/qpos": np.hstack(
            (np.zeros((steps, 3)), Rotation.from_rotvec(about).as_quat(scalar_first=True))
        ),
        "trajectory/angular_excursion": 2 * np.pi * np.stack((none, turns, none), axis=1)
        + [9.0, -4.0, 9.0],
        "trajectory/trunk_axis": axis,
        "contacts/count": np.ones(steps, dtype=np.int32),
        "contacts/ground_force": np.tile([0.0, 30.0, 40.0], (steps, 1)),
        "contacts/ground_force_peak": none + 60.0,
        "contacts/penetration": none + 0.01,
        "contacts/force_realised": np.zeros((steps, 3, 3)),
        "contacts/body": np.full((steps, 3), -1, dtype=np.int32),
        "contacts/used": np.zeros((steps, 3), dtype=bool),
        "trajectory/qvel": np.zeros((steps, 8)),
        "trajectory/ctrl": np.zeros((steps, 2)),
        "model/torque_limit": np.array([10.0, 20.0]),
        "solver/status": np.zeros(steps, dtype=np.uint8),
    }


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


def test_from_between_two_marks_a_stall_is_less_than_twice_as_long():
    generator = np.random.default_rng(0)
    for _ in range(50):
        progress = np.cumsum(np.abs(generator.normal(0.0, 0.03, 200)))
        told = longest_stall(progress, 0.1, 1.0)[0]
        ahead = np.searchsorted(progress, progress + 0.1)  # rises all the while
        longest = int((np.minimum(ahead, 199) - np.arange(200)).max())
        assert told <= longest < 2 * told


@pytest.mark.parametrize(
    ("progress", "expected"),
    [([0.0], 0.0), ([0, 1, 2], 0.0), ([0, 1, 0.5, 2, 1.25, 3], 0.75), ([0, -2, 5], 2.0)],
)
def test_setback(progress, expected):
    assert setback(np.array(progress, dtype=float)) == expected


# ---------------------------------------------------------------- revolutions


@pytest.mark.parametrize(
    ("progress", "expected"),
    [
        ([0.0], []),
        ([0, 0.5, 0.9], []),
        ([0, 0.5, 1.0, 1.5], [(0, 2), (1, 3)]),
        ([0, 0, 0, 1.0], [(2, 3)]),  # the time before it began is no part of it
        ([5, 5.5, 5.25, 5.75, 6.5], [(2, 4)]),  # of the rows at 5.5, the last
        ([0, 2.5], [(0, 1)]),
        ([0, -3, 1.0], [(1, 2)]),
    ],
)
def test_revolutions(progress, expected):
    first, last = revolutions(np.array(progress, dtype=float))
    assert list(zip(first.tolist(), last.tolist(), strict=True)) == expected


@pytest.mark.parametrize("flip", [False, True])
def test_turned_about(flip):
    """Turns about an axis that itself moves, built up by scipy; the sign of q says nothing."""
    rng = np.random.default_rng(0)
    axis = rng.normal(size=(200, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    across = np.cross(axis, rng.normal(size=(200, 3)))
    across *= 0.05 / np.linalg.norm(across, axis=1, keepdims=True)
    turns, orientation = rng.uniform(-0.1, 0.2, 199), [Rotation.random(rng=1)]
    for step in turns[:, None] * axis[:-1] + across[:-1]:
        orientation.append(Rotation.from_rotvec(step) * orientation[-1])
    quaternion = Rotation.concatenate(orientation).as_quat(scalar_first=True)
    if flip:
        quaternion *= rng.choice([-1.0, 1.0], size=(200, 1))
    found = turned_about(axis, quaternion)
    expected = np.concatenate(([0.0], np.cumsum(turns))) / (2 * np.pi)
    assert len(found) == 200
    assert expected[-1] > 1.0
    assert found == pytest.approx(expected, abs=0.003 * expected[-1])


# ---------------------------------------------------------------- measures


def test_a_steady_roll():
    found = measure(make_log(), CRITERIA, 0.5, PERIOD, whole=True)
    assert found.duration == pytest.approx(10.0)
    assert found.revolutions == pytest.approx(0.5 * 599 / 60)
    assert found.angular_velocity_mean == pytest.approx(0.5)
    assert found.speed_mean == pytest.approx(0.9)
    assert found.heading_error_end == pytest.approx(0.0, abs=1e-9)
    assert found.lateral_drift == 0.0
    assert found.longest_stall < 0.25  # 0.1 rev take 0.2 s
    assert found.solver_failures == 0
    assert found.slowest_revolution == pytest.approx(2.0, abs=1.01 * PERIOD)
    assert found.setback == 0.0
    assert found.height_least == found.height_most == pytest.approx(0.4)
    assert found.penetration == 0.01
    assert found.flight_turn == 0.0
    assert found.trunk_turn == pytest.approx(1.0, abs=1e-3)
    assert found.axis_error == pytest.approx(0.0, abs=1e-5)
    assert found.travel_least == pytest.approx(1.8, abs=0.02)  # a row more or less
    assert found.travel_most == pytest.approx(1.8, abs=0.02)
    assert found.ground_force_p99 == 50.0
    assert found.ground_force_peak == 60.0
    assert failure_reason(found, CRITERIA, 10.0) == ""


def test_backward_rolling_counts_forward_when_commanded():
    log = make_log(rate=-0.5, speed=-0.9)
    found = measure(log, CRITERIA, -0.5, PERIOD, whole=True)
    assert found.revolutions == pytest.approx(0.5 * 599 / 60)
    assert found.angular_velocity_mean == pytest.approx(-0.5)
    assert found.speed_mean == pytest.approx(-0.9)
    assert found.longest_stall < 0.25
    assert found.trunk_turn == pytest.approx(1.0, abs=1e-3)
    assert found.travel_least == pytest.approx(1.8, abs=0.02)
    assert failure_reason(found, CRITERIA, 10.0) == ""
    wrong_way = measure(log, CRITERIA, 0.5, PERIOD, whole=True)
    assert wrong_way.revolutions == pytest.approx(-0.5 * 599 / 60)
    assert wrong_way.longest_stall == pytest.approx(599 / 60)


@pytest.mark.parametrize("heading", [-50.0, -3.0, 20.0, 170.0])
def test_heading_is_positive_to_the_left(heading):
    """Turned about +z: from +x, rolling ahead, towards +y."""
    found = measure(make_log(heading=heading), CRITERIA, 0.5, PERIOD, whole=True)
    assert found.heading_error_end == pytest.approx(heading)


def test_heading_is_the_median_of_the_last_second():
    heading = np.full(600, 80.0)
    heading[-60:] = 10.0
    heading[-60:-35] = -90.0  # less than half of it
    found = measure(make_log(heading=heading), CRITERIA, 0.5, PERIOD, whole=True)
    assert found.heading_error_end == pytest.approx(10.0)


def test_a_heading_about_face_is_not_averaged_away():
    """Half the samples at +179 and half at -179 degrees are no heading of 0."""
    heading = np.where(np.arange(600) % 2, 179.0, -179.0)
    found = measure(make_log(heading=heading), CRITERIA, 0.5, PERIOD, whole=True)
    assert abs(found.heading_error_end) > 170.0


@pytest.mark.parametrize("lateral", [-0.2, 0.2])
def test_lateral_drift_is_from_the_start(lateral):
    found = measure(make_log(lateral=lateral), CRITERIA, 0.5, PERIOD, whole=True)
    assert found.lateral_drift == pytest.approx(0.2 * 599 / 60)
    assert found.lateral_rms == pytest.approx(found.lateral_drift / 3**0.5, rel=2e-3)
    log = make_log()
    log["trajectory/com"][300, 1] -= 1.25  # the largest, not the last
    assert measure(log, CRITERIA, 0.5, PERIOD, whole=True).lateral_drift == pytest.approx(1.25)


def test_means_leave_the_settling_out():
    log = make_log()
    settled = round(CRITERIA.settle / PERIOD)
    log["trajectory/com"][:settled, 0] -= 100.0
    log["trajectory/angular_excursion"][:settled, 1] += 100.0
    found = measure(log, CRITERIA, 0.5, PERIOD, whole=True)
    assert found.speed_mean == pytest.approx(0.9)
    assert found.angular_velocity_mean == pytest.approx(0.5)


def test_torque_fraction_is_of_each_joint_s_limit():
    log = make_log()
    log["trajectory/ctrl"][:] = [-5.0, 5.0]
    assert measure(log, CRITERIA, 0.5, PERIOD, whole=True).torque_p99_fraction == pytest.approx(0.5)
    log["trajectory/ctrl"][:, 1] = -18.0
    assert measure(log, CRITERIA, 0.5, PERIOD, whole=True).torque_p99_fraction == pytest.approx(0.9)


def test_airborne_is_the_share_without_contact():
    log = make_log()
    log["contacts/count"][100:250] = 0
    log["contacts/count"][300:] = 7
    assert measure(log, CRITERIA, 0.5, PERIOD, whole=True).airborne == pytest.approx(0.25)


def test_jerk_is_that_of_a_known_motion():
    """Joint velocity sin(w t) has jerk -w^2 sin(w t): rms w^2 / sqrt(2), for one joint of two."""
    log, w = make_log(steps=1200), 2.0
    log["trajectory/qvel"][:, 6] = np.sin(w * PERIOD * np.arange(1200))
    log["trajectory/qvel"][:, :6] = np.random.default_rng(0).normal(size=(1200, 6))  # no joints
    expected = w**2 / np.sqrt(2) / np.sqrt(2)
    assert measure(log, CRITERIA, 0.5, PERIOD, whole=True).jerk == pytest.approx(expected, rel=0.01)


def test_chatter_counts_bodies_not_slots():
    """Body 4 changes its slot and is let go once; body 7 comes, in two contacts, and stays."""
    log = make_log(steps=601)
    body, used = log["contacts/body"], log["contacts/used"]
    body[:100, 0] = body[100:300, 1] = 4
    used[:100, 0] = used[100:300, 1] = True
    body[300:, 1:] = 7
    used[300:, 1:] = True
    body[400:, 0] = 4  # there, but not used
    assert measure(log, CRITERIA, 0.5, PERIOD, whole=True).chatter == pytest.approx(2 / 10)


def test_what_control_keeps_still_sticks_where_the_ground_hardly_carries_it():
    """Of two bodies kept for 600 steps, the first by two contacts, one carries nothing for 150."""
    log = make_log(steps=600)
    body, used, force = (log[f"contacts/{name}"] for name in ("body", "used", "force_realised"))
    body[:, :2], body[:, 2] = 4, 7
    used[:, :3] = True
    force[:, 0, 2] = 500.0
    force[150:, 2, 1] = -20.0
    assert measure(log, CRITERIA, 0.5, PERIOD, whole=True).sticking == pytest.approx(150 / 1200)


def test_only_steps_without_any_solver_are_failures():
    log = make_log()
    log["solver/status"][[3, 4, 5]] = 1
    log["solver/status"][[7, 9]] = 2
    assert measure(log, CRITERIA, 0.5, PERIOD, whole=True).solver_failures == 2


@pytest.mark.parametrize("steps", [1, 2, 30])
def test_short_logs(steps):
    found = measure(make_log(steps=steps), CRITERIA, 0.5, PERIOD, whole=True)
    assert found.duration == pytest.approx(steps * PERIOD)
    later = (
        "angular_velocity_mean",
        "speed_mean",
        "recovery",
        "recovered",
        "sticking",  # control uses no contact here
        "went_on",  # nothing was to halt
        *(("jerk",) if steps < 3 else ()),
        *(("chatter",) if steps < 2 else ()),
        *OF_REVOLUTIONS,
    )
    for name, value in vars(found).items():
        assert np.isfinite(value) != (name in later), name


def test_empty_log():
    found = measure(make_log(steps=0), CRITERIA, 0.5, PERIOD, whole=True)
    assert (found.duration, found.revolutions, found.solver_failures) == (0.0, 0.0, 0)
    assert np.isnan([found.heading_error_end, found.penetration, found.setback]).all()
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
        ({"height_least": 0.05}, "fell: centre of mass 0.05 m above the ground"),
        ({"height_least": -375.0, "longest_stall": 9.0}, "fell: centre of mass -375.00 m above t"),
        ({"height_least": np.nan}, "fell: centre of mass nan m above the ground"),
        ({"height_most": 0.8}, "leapt: centre of mass 0.80 m above the ground"),
        ({"revolutions": 0.99}, "no whole revolution: turned 0.99 rev"),
        ({"revolutions": np.nan}, "no whole revolution: turned nan rev"),
        ({"slowest_revolution": 6.0}, "too slow: a revolution took 6.00 s"),
        ({"went_on": 7.0}, "told to halt at 7 s, and not still for 1 s"),
        ({"setback": 0.25}, "rocked back by 0.25 rev"),
        ({"flight_turn": 0.5}, "turned in the air: 0.50 of a revolution"),
        ({"penetration": 0.12}, "sank into the ground by 0.120 m"),
        ({"trunk_turn": 0.7}, "the trunk did not turn along: 0.70 rev in a revolution"),
        ({"axis_error": 30.0}, "off its axis by 30 deg over a revolution"),
        ({"travel_least": 0.5}, "turned on the spot: 0.50 m in a revolution"),
        ({"travel_most": 3.5}, "slid: 3.50 m in a revolution"),
    ],
)
def test_failure_reason(changes, reason):
    found = failure_reason(replace(GOOD, **changes), CRITERIA, 20.0)
    assert found.startswith(reason) if reason else found == ""


# ---------------------------------------------------------------- what is no roll

TIME = PERIOD * np.arange(600)
STEADY = 0.5 * TIME  # [rev] of `make_log`
MIDDLE = slice(180, 330)  # longer than a revolution
HUGE = 1e9
OFF = {  # a rule that nothing breaks
    "revolution_time": HUGE,
    "setback": HUGE,
    "height": (-HUGE, HUGE),
    "penetration": HUGE,
    "flight_turn": HUGE,
    "trunk_turn": -HUGE,
    "axis": HUGE,
    "travel": (-HUGE, HUGE),
}


def changed(name, rows, value, **roll):
    log = make_log(**roll)
    log[name][rows] = value
    return log


def in_steps(step, time):
    """[rev] in steps of that many, each with a rest of some seconds."""
    return step * np.floor(TIME / time + 0.5)


def across(log):
    """Lying across the way and rolling about its length: the trunk's axis turns with it."""
    angle = 2 * np.pi * STEADY
    log["trajectory/trunk_axis"] = np.stack((np.sin(angle), 0 * angle, np.cos(angle)), axis=1)
    log["trajectory/trunk_axis"][-60:] = [0.0, 1.0, 0.0]  # right for the last second
    return log


def fallen(log):
    """Beyond the end of the ground from 7 s on."""
    fall = np.maximum(TIME - 7.0, 0.0)
    log["trajectory/com"][:, 2] -= 0.5 * 9.81 * fall**2
    log["contacts/ground_force"][fall > 0] = 0.0
    return log


LIES = {
    "spinning in the air": (
        changed("contacts/ground_force", slice(None), 0.0),
        ("flight_turn",),
        "turned in the air: 1.0",
    ),
    "one somersault": (
        changed("contacts/ground_force", slice(200, 275), 0.0),
        ("flight_turn",),
        "turned in the air: 0.6",
    ),
    "bouncing": (  # a tenth of a second on the ground, three in the air
        changed("contacts/ground_force", np.flatnonzero(np.arange(600) % 24 > 5), 0.0),
        ("flight_turn",),
        "turned in the air: 0.7",
    ),
    "off the world": (
        fallen(make_log()),
        ("height", "flight_turn"),
        "fell: centre of mass -43",
    ),
    "through the ground": (
        changed("trajectory/com", (slice(400, 410), 2), 7.02),
        ("height",),
        "fell: centre of mass 0.02 m above the ground",
    ),
    "a leap": (
        changed("trajectory/com", (slice(400, 410), 2), 8.1),
        ("height",),
        "leapt: centre of mass 1.10 m above the ground",
    ),
    "buried": (
        changed("contacts/penetration", 300, 0.3),
        ("penetration",),
        "sank into the ground by 0.300 m",
    ),
    "rocking on, much of it back again": (
        make_log(turns=STEADY + 0.25 * np.sin(2 * np.pi * TIME)),
        ("setback",),
        "rocked back by 0.28 rev",
    ),
    "creeping": (
        make_log(turns=in_steps(0.105, 0.9), speed=0.12),
        ("revolution_time",),
        "too slow: a revolution took 9.",
    ),
    "limbs go round, the trunk does not": (
        make_log(spin=np.zeros(600)),
        ("trunk_turn",),
        "the trunk did not turn along: 0.00 rev in a revolution",
    ),
    "the trunk only rocks along": (
        make_log(spin=0.2 * np.sin(2 * np.pi * STEADY)),
        ("trunk_turn",),
        "the trunk did not turn along: -0.0",
    ),
    "the trunk stays behind in one revolution": (
        make_log(spin=STEADY - np.clip(STEADY - 2.0, 0.0, 0.5)),
        ("trunk_turn",),
        "the trunk did not turn along: 0.50 rev in a revolution",
    ),
    "about the length of the body": (
        across(make_log()),
        ("trunk_turn", "axis"),
        "the trunk did not turn along: 0.0",
    ),
    "aslant on the way, straight at the end": (
        make_log(heading=np.where((TIME > 3.0) & (TIME < 6.0), 50.0, 0.0)),
        ("axis",),
        "off its axis by 50 deg over a revolution",
    ),
    "on the spot": (
        make_log(speed=0.0),
        ("travel",),
        "turned on the spot: 0.00 m in a revolution",
    ),
    "a spinning wheel that is pulled back": (
        make_log(speed=-0.9),
        ("travel",),
        "turned on the spot: -1.8",
    ),
    "sliding or dragged along": (
        make_log(speed=2.0),
        ("travel",),
        "slid: 4.0",
    ),
    "sliding for a second": (
        make_log(speed=np.where((TIME > 5.0) & (TIME < 6.0), 3.0, 0.9)),
        ("travel",),
        "slid: 3.8",
    ),
}


@pytest.mark.parametrize("lie", LIES)
def test_what_looks_like_a_roll_by_some_measures_is_none(lie):
    """It is refused by the rule that is meant for it, and would pass without that rule."""
    log, rules, reason = LIES[lie]
    found = measure(log, CRITERIA, 0.5, PERIOD, whole=True)
    assert failure_reason(found, CRITERIA, 10.0).startswith(reason)
    without = replace(CRITERIA, **{rule: OFF[rule] for rule in rules})
    assert failure_reason(found, without, 10.0) == ""
    for rule in rules:  # each of them would do
        others = {other: OFF[other] for other in rules if other != rule}
        assert failure_reason(found, replace(CRITERIA, **others), 10.0) != ""


def test_every_rule_has_a_lie_that_it_finds():
    assert {rule for _, rules, _ in LIES.values() for rule in rules} == set(OFF)


def test_a_run_of_less_than_a_revolution_says_nothing():
    """Too short to stall: a body at rest would pass."""
    for rate in (0.0, 0.5):
        found = measure(make_log(steps=80, rate=rate), CRITERIA, 0.5, PERIOD, whole=True)
        reason = f"no whole revolution: turned {rate * 79 / 60:.2f} rev"
        assert failure_reason(found, CRITERIA, 80 * PERIOD) == reason


def test_what_only_files_show_is_measured():
    assert set(OF_ROLLS_IN_FILES_ONLY) < set(vars(GOOD))


@pytest.mark.parametrize("q", [0, 50, 95, 99, 100])
@pytest.mark.parametrize("shape", [(1,), (2,), (7,), (60,), (101,), (60, 29)])
def test_percentiles_are_those_of_numpy(shape, q):
    values = np.random.default_rng(5).normal(size=shape)
    assert percentile(values, q) == np.percentile(values, q)
    values.flat[-1] = np.nan
    assert np.isnan(percentile(values, q))


@pytest.mark.parametrize("shape", [(1,), (2,), (7,), (60,), (101,), (60, 29)])
def test_medians_are_those_of_numpy(shape):
    values = np.random.default_rng(5).normal(size=shape)
    assert median(values) == np.median(values)
    values.flat[-1] = np.nan
    assert np.isnan(median(values))
