"""A roll that ends standing, judged on logs made by hand."""

import numpy as np
import pytest
from test_rolling_metrics import CRITERIA, PERIOD, make_log

from rotctl.config.loading import load
from rotctl.metrics.criteria.early_end import too_short
from rotctl.metrics.criteria.finish import FinishCriteria, judge, rolled, upright
from rotctl.metrics.criteria.standing import StandingCriteria
from rotctl.runs.scenario import build

ASKED = {
    "angular_velocity_commanded": 0.5,
    "speed_commanded": 0.9,
    "finish_commanded": 8.0,
}
STAND = StandingCriteria("test", "landing", ("foot_l",), rest=2.0, height=0.8, lean=20.0, speed=0.3)
FINISH = FinishCriteria(name="test", kind="finish", roll=CRITERIA, stand=STAND, height=0.86)
STEPS, TOLD, STANDS = 960, 480, 600  # rows: told to end at 8 s, begins to stand up at 10 s

LEANING = np.where(PERIOD * np.arange(STEPS) < 15.0, 30.0, 5.0)  # [deg]


def log_of(height=0.95, stands=STANDS, turns=None, lean=0.0, speed=0.0, touched="foot_l"):
    """Rolls at 0.5 rev/s until it is told, waits, and from 12 s on is up at a height [m]."""
    time = PERIOD * np.arange(STEPS)
    steady = 0.5 * np.minimum(time, PERIOD * TOLD)
    log = make_log(steps=STEPS, turns=steady if turns is None else turns)
    up = np.full(STEPS, 0.4)
    up[720:] = height
    log["trajectory/com"][:, 2] = 7.0 + up
    axes = np.tile(np.eye(3), (STEPS, 1, 1))
    axes[:, 2, 2] = np.cos(np.radians(lean))
    none = np.zeros((STEPS, 3))
    body = np.full((STEPS, 3), -1, dtype=np.int32)
    body[840:, 0] = ["world", "foot_l", "head"].index(touched)
    stage = np.zeros(STEPS, dtype=np.int32)
    stage[stands:] = 1
    return log | {
        "trajectory/time": time,
        "trajectory/trunk_axes": axes,
        "trajectory/com_velocity": none + [speed, 0.0, 0.0],
        "contacts/body": body,
        "command/stage": stage,
        "model/body": np.array([b"world", b"foot_l", b"head"]),
    }


def test_a_roll_that_stands_up():
    columns, reason = judge(log_of(), FINISH, ASKED, PERIOD, 0.99, whole=True)
    assert reason == ""
    assert columns["revolutions"] == pytest.approx(4.0, abs=0.02), "until it is told"
    assert columns["duration"] == pytest.approx(16.0)
    assert columns["stands_from"] == pytest.approx(10.0)
    assert columns["stands_at"] == pytest.approx(0.95)
    assert columns["longest_stall"] < 0.3, "to wait is no stall"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"stands": STEPS}, "never stood up"),
        ({"height": 0.7}, "stands 0.70 m high"),
        ({"lean": 30.0}, "leans by 30 deg at the end"),
        ({"speed": 0.5}, "still moves at 0.50 m/s at the end"),
        ({"touched": "head"}, "touched the ground with more than the feet for 2.00 s"),
        ({"stands": 900}, "ends after 1.00 s, is to rest for 2"),
        (
            {"turns": 0.5 * PERIOD * np.minimum(np.arange(STEPS), 240)},
            "stalled for 4.05 s from t = 3.93 s",
        ),
    ],
)
def test_what_it_does_instead(changes, said):
    assert judge(log_of(**changes), FINISH, ASKED, PERIOD, 0.99, whole=True)[1] == said


@pytest.mark.parametrize(
    ("lean", "touched", "turns", "early"),
    [
        (LEANING, "foot_l", 4.0, True),
        (30.0, "foot_l", 4.0, False),
        (LEANING, "head", 4.0, False),
        (LEANING, "foot_l", 3.0, False),
    ],
)
def test_who_came_upright_too_late_had_no_time_to_rest(lean, touched, turns, early):
    """The last two seconds begin at 14 s; the trunk comes up a second later, and no time mends
    who never does, lies on more than its feet or has rolled once too often."""
    log = log_of(stands=540, lean=lean, touched=touched)
    log["trajectory/phase"] = 2 * np.pi * 0.5 * np.minimum(log["trajectory/time"], PERIOD * TOLD)
    counted = {"finish_commanded": 0.0, "revolutions_commanded": turns, "revolutions_told": 3.0}
    columns, reason = judge(log, FINISH, ASKED | counted, PERIOD, 0.99, whole=True)
    assert reason
    told = too_short(log, FINISH, ASKED | counted, columns, PERIOD)
    assert told == early * (
        "the run ends at 16.00 s, 1.00 s after it came upright: "
        "it is to rest for 2 s, 1.00 s more at least"
    )


def test_a_roll_that_stalls_and_stands_up_late_has_stalled():
    stalls = 0.5 * PERIOD * np.minimum(np.arange(STEPS), 240)
    log = log_of(turns=stalls, stands=900)
    columns, reason = judge(log, FINISH, ASKED, PERIOD, 0.99, whole=True)
    assert reason.startswith("stalled for ")
    assert too_short(log, FINISH, ASKED, columns, PERIOD) == ""


def test_a_roll_that_is_counted():
    """It is the roll until it stands up, and is told where it has turned so far."""
    counted = ASKED | {"finish_commanded": 0.0, "revolutions_commanded": 4.0}
    log = log_of(stands=540)
    log["trajectory/phase"] = 2 * np.pi * 0.5 * np.minimum(log["trajectory/time"], PERIOD * TOLD)
    asked = counted | {"revolutions_told": 3.125}
    roll, told = rolled(log, asked)
    assert len(roll["trajectory/time"]) == 540
    assert told == pytest.approx(6.25)
    columns, reason = judge(log, FINISH, asked, PERIOD, 0.99, whole=True)
    assert reason == ""
    assert columns["told_at"] == told
    assert rolled(log, counted | {"revolutions_told": 4.5}).told == np.inf
    roll, told = rolled(log, ASKED)
    assert (len(roll["trajectory/time"]), told) == (TOLD, 8.0)


def test_what_never_began_has_no_numbers():
    empty = {
        name: rows if name.startswith("model/") else rows[:0] for name, rows in log_of().items()
    }
    columns, reason = judge(empty, FINISH, ASKED, PERIOD, 0.99, whole=True)
    assert reason
    assert np.isnan(columns["stands_from"])
    assert np.isnan(columns["stands_at"])


@pytest.mark.parametrize(
    ("height", "upright", "stands"),
    [(0.65, 0.68, True), (0.57, 0.68, False), (0.86, 1.13, False), (0.57, np.nan, True)],
)
def test_how_high_it_stands_is_judged_by_its_size(height, upright, stands):
    reason = judge(log_of(height=height), FINISH, ASKED, PERIOD, upright, whole=True)[1]
    assert reason == ("" if stands else f"stands {height:.2f} m high")


def test_a_body_stands_as_high_as_it_is_tall():
    child, adult = (
        upright(build(load(overrides)).model.mj)
        for overrides in (["character.height=1.2", "character.mass=23"], [])
    )
    assert adult == pytest.approx(0.986, abs=1e-3)
    assert child == pytest.approx(adult * 1.2 / 1.75, rel=1e-6)
