"""A back handspring: what comes down in which order, and what it is judged by."""

from dataclasses import replace
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

from rotctl.behaviours.aerial.landing import Landing
from rotctl.behaviours.staged.following import TurnSettings
from rotctl.behaviours.staged.stages import Stage, mirrored
from rotctl.config.loading import load
from rotctl.metrics.criteria.acrobatic import AcrobaticCriteria, judge, out_of_order, told
from rotctl.metrics.criteria.standing import StandingCriteria
from rotctl.metrics.touching import TouchDown, touch_downs
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

PERIOD = 1 / 240
HANDS, FEET = ("forearm_l", "forearm_r"), ("foot_l", "foot_r")
LANDING = StandingCriteria("landing", "landing", FEET, 2.0, 0.8, 20.0, 0.25)
OVER = AcrobaticCriteria("handspring", "acrobatic", (HANDS, FEET), 45.0, LANDING)


@pytest.fixture(scope="module")
def runs():
    """Four starts, until the feet are down: the scenario, and the rows of each."""
    made = []
    for seed in (2001, 2002, 2003, 2005):
        config = load(["behaviour=back_handspring", f"seed={seed}", "plant=varied", "duration=3.1"])
        scenario = build(config)
        buffer, ending = in_memory(scenario)
        assert not ending
        made.append(buffer.arrays())
    return scenario, made


def test_hands_come_down_and_then_the_feet(runs):
    """From every start; whether it stands then is another question."""
    _, logs = runs
    for log in logs:
        # It crouches before.
        order = [body for time, body in touch_downs(log, PERIOD) if time > 2.0]
        assert set(order[:2]) == set(HANDS)
        assert set(order[2:4]) == set(FEET)


def test_hands_come_down_under_the_body(runs):
    """By the places of the contacts: none falls back, none falls over."""
    _, logs = runs
    for log in logs:
        row = np.flatnonzero(log["command/stage"] == 5)[0]
        used = log["contacts/body"][row] > 0
        hands = log["contacts/position"][row][used].mean(axis=0)
        assert abs(float(log["trajectory/com"][row, 0] - hands[0])) < 0.35
        assert log["trajectory/trunk_axes"][row, 2, 2] < -0.9  # head down


def test_it_flies_before_the_hands_and_after_them(runs):
    """Off the ground for at least a tenth of a second, twice: a flip over hands, no walk-over."""
    _, logs = runs
    for log in logs:
        flying = np.concatenate(([0], (np.asarray(log["contacts/count"]) == 0).astype(int), [0]))
        edges = np.flatnonzero(np.diff(flying))
        assert ((edges[1::2] - edges[::2]) * PERIOD > 0.1).sum() >= 2


def test_of_some_starts_two_stand_for_two_seconds():
    """Nine of ten do, each by itself: that less than two of four do is no chance."""
    stood = 0
    for seed in (2400, 2401, 2402, 2405):
        config = load(["behaviour=back_handspring", f"seed={seed}", "plant=varied", "duration=8"])
        buffer, _ = in_memory(build(config))
        columns, reason = judge(buffer.arrays(), config.criteria, -360.0, PERIOD)
        assert columns["bears_most"] > 700.0  # [N] its weight
        stood += not reason
    assert stood >= 2


def test_legs_take_up_what_the_pelvis_has_not_turned(runs):
    """Thighs lie as they would under a pelvis that has; as far as hips bend."""
    scenario, _ = runs
    mj = scenario.model.mj
    settings = scenario.config.behaviour.stages[-2].flight.feet
    law = Landing(settings, scenario.model, "feet")
    thigh, data = mj.body("thigh_l").id, mujoco.MjData(mj)

    def lies(pose, pitch):
        """Direction of the thigh at a pitch of the pelvis."""
        data.qpos[3:7] = [np.cos(pitch / 2), 0.0, np.sin(pitch / 2), 0.0]
        data.qpos[scenario.model.angles] = pose
        mujoco.mj_kinematics(mj, data)
        return data.xmat[thigh].reshape(3, 3)[:, 2].copy()

    wanted = law.contact(1.2)
    placed = law.placed(wanted.pose, -0.25)  # it turns backward, and is 0.25 rad short of it
    before, after = lies(wanted.pose, 1.2), lies(placed, 1.2 + 0.25)
    assert after @ before == pytest.approx(1.0, abs=1e-3)  # hips have other axes than left, too
    hips = scenario.model.motors("hip_y", "hips")
    assert law.placed(wanted.pose, -9.0)[hips] == pytest.approx([2.5, 2.5])
    assert law.legs_reach
    assert not Landing(replace(settings, hip=""), scenario.model, "feet").legs_reach


def test_poses_follow_the_turn(runs):
    """Half way between the angles half way between the poses, as fast as the body turns."""
    scenario, _ = runs
    law = TurnSettings({"knee": 0.2}, {"knee": 1.0}, (-170.0, -200.0)).make(scenario.model, "turn")

    momentum = SimpleNamespace(angular_velocity=np.array([0.0, -3.0, 0.0]))
    scene = SimpleNamespace(
        turned=np.radians(-185.0),
        turning=np.array([0.0, 1.0, 0.0]),
        state=SimpleNamespace(momentum=momentum),
    )
    poses, speeds = law.poses(scene, None)
    knees = scenario.model.motors("knee", "turn")
    assert poses[0, knees] == pytest.approx([0.6, 0.6])
    assert speeds[0, knees] == pytest.approx([0.8 * 3.0 / np.radians(30.0)] * 2)
    scene.turned = np.radians(-250.0)
    poses, speeds = law.poses(scene, None)
    assert poses[0, knees] == pytest.approx([1.0, 1.0])
    assert not speeds.any()


def test_a_turn_the_other_way_has_mirrored_poses(runs):
    scenario, _ = runs
    stage = Stage("a", turn=TurnSettings({"shoulder_x_l": 0.5}, {"waist_z": 0.3}, (10.0, 40.0)))
    other = mirrored(stage, scenario.model).turn
    assert other.angles == (-10.0, -40.0)
    assert other.start["shoulder_x_r"] == pytest.approx(0.5)
    assert other.end["waist_z"] == pytest.approx(-0.3)


def test_a_turn_between_one_and_the_same_angle_is_refused():
    with pytest.raises(ValueError, match="angles 90 and 90 are the same"):
        TurnSettings({}, {}, (90.0, 90.0))


# ---------------------------------------------------------------- what judges it


def test_touch_downs_are_no_bounces_and_no_starts():
    """Parts by rows: one stands from the start, one bounces, one comes down twice."""
    on = np.zeros((120, 4), int) - 1
    on[:40, 0] = 1  # stands at first, and comes down again much later
    on[80:, 0] = 1
    on[20:30, 1] = 2
    on[36:50, 1] = 2  # off for 6 rows of 1/240 s
    on[60:, 2] = 3
    log = {
        "model/body": np.array([b"world", b"foot_l", b"forearm_l", b"head"]),
        "contacts/body": on,
        "trajectory/time": PERIOD * np.arange(120),
    }
    found = touch_downs(log, PERIOD)
    assert [body for _, body in found] == ["forearm_l", "head", "foot_l"]
    assert [time for time, _ in found] == pytest.approx([20 * PERIOD, 60 * PERIOD, 80 * PERIOD])


@pytest.mark.parametrize(
    ("order", "wrong", "missing"),
    [
        ("forearm_r forearm_l foot_l foot_r", "", ""),
        ("foot_l forearm_r forearm_l foot_l foot_r foot_l", "", ""),
        ("forearm_r forearm_l forearm_r foot_l foot_r", "", ""),
        ("forearm_r forearm_l head foot_l foot_r", "head came down out of order, at 0.30 s", ""),
        ("forearm_r forearm_l foot_l forearm_l", "forearm_l came down out of order, at 0.40 s", ""),
        ("forearm_r forearm_l foot_l foot_r head", "fell: head came down at 0.50 s", ""),
        ("forearm_r forearm_l foot_l foot_r forearm_l", "fell: forearm_l came down at 0.50 s", ""),
        ("forearm_r foot_l", "foot_l came down out of order, at 0.20 s", ""),
        ("forearm_r forearm_l foot_l", "", "foot_r"),
        ("forearm_r forearm_l", "", "foot_l foot_r"),
        ("", "", "forearm_l forearm_r"),
    ],
)
def test_the_order_counts(order, wrong, missing):
    events = [TouchDown(0.1 * (i + 1), body) for i, body in enumerate(order.split())]
    assert out_of_order(events, OVER) == (wrong, set(missing.split()))


def test_touch_downs_are_told():
    events = [TouchDown(2.342, "forearm_l"), TouchDown(2.7, "foot_r")]
    assert told(events) == "forearm_l 2.34, foot_r 2.70"
