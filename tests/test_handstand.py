"""A handstand: the balance on two hands, poses over time, and what it is judged by."""

from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

from rotctl.behaviours.staged.conditions import Over
from rotctl.behaviours.staged.gliding import GlideSettings
from rotctl.behaviours.staged.stages import Stage, mirrored
from rotctl.behaviours.standing.poising import Shift, _hands, _over
from rotctl.config.loading import load
from rotctl.control.task import TASK
from rotctl.mechanics.bodies import ROOT_BODY
from rotctl.mechanics.state import read
from rotctl.metrics.criteria.acrobatic import HeldCriteria, judge, longest_held
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

PERIOD = 1 / 240
HANDS = ("forearm",)
HELD = HeldCriteria(("forearm_l", "forearm_r"), 3.0, 20.0, 0.95)


@pytest.fixture(scope="module")
def run():
    """One start to its end: the scenario and the rows."""
    config = load(["behaviour=handstand", "seed=2001", "plant=varied", "duration=20"])
    scenario = build(config)
    buffer, ending = in_memory(scenario)
    assert not ending
    return scenario, config, buffer.arrays()


@pytest.fixture(scope="module")
def scene(run):
    """In the middle of the press, by the body's own model: what a law sees."""
    scenario, _, log = run
    row = int(np.flatnonzero(np.asarray(log["command/stage"]) == 4)[400])
    model, data = scenario.model, mujoco.MjData(scenario.model.mj)
    data.qpos[:] = log["trajectory/qpos"][row]
    data.qvel[:] = log["trajectory/qvel"][row]
    mujoco.mj_forward(model.mj, data)
    begin = SimpleNamespace(time=0.0)  # of the stage
    return SimpleNamespace(model=model, state=read(model, data), axes=np.eye(3), begin=begin)


def test_it_goes_onto_the_hands_holds_and_comes_back_onto_the_feet(run):
    _, config, log = run
    columns, reason = judge(log, config.criteria, 0.0, PERIOD)
    assert reason == ""
    assert columns["held"] >= 3.0
    assert columns["bears_most"] < 4500.0  # [N] a handspring has 10,000: nothing falls


def test_pressure_stays_on_the_hands_while_it_is_held(run):
    """By the contacts: two hands a shoulder's width apart bear its weight, half each."""
    _, _, log = run
    row = int(np.flatnonzero(np.asarray(log["command/stage"]) == 5)[-1])
    forces = np.asarray(log["contacts/force_realised"])[row, :, 2]
    names = [name.decode() for name in np.asarray(log["model/body"])]
    bodies = [names[b] for b in np.asarray(log["contacts/body"])[row] if b > 0]
    assert sorted(bodies) == ["forearm_l", "forearm_r"]
    assert forces.sum() == pytest.approx(70.0 * 9.81, rel=0.05)
    assert np.ptp(forces[forces > 0.0]) < 100.0


def test_what_is_left_to_turn_is_the_momentum_about_fixed_hands(scene):
    """By MuJoCo's own angular momentum of a body whose hands rest and which stays balanced."""
    mj, data = scene.model.mj, scene.state.data
    hands = _hands(scene, HANDS)
    speeds = np.random.default_rng(3).normal(size=len(scene.model.joint_names))
    spin = _over(scene, hands, speeds, 0.0)

    def moving(turn, way):
        """With root speeds: turning about the hands' line, and moving along."""
        data.qvel[:] = 0.0
        data.qvel[scene.model.joints] = speeds
        data.qvel[:3] = way
        data.qvel[3:6] = data.xmat[ROOT_BODY].reshape(3, 3).T @ (turn * hands.left)
        mujoco.mj_fwdVelocity(mj, data)
        mujoco.mj_subtreeVel(mj, data)
        hand = np.zeros(3)
        for body, place in hands.ends:
            jacobian = np.zeros((3, mj.nv))
            mujoco.mj_jac(mj, data, jacobian, None, place, body)
            hand += 0.5 * jacobian @ data.qvel
        return data.subtree_linvel[ROOT_BODY] - hand, data.subtree_angmom[ROOT_BODY] @ hands.left

    before = data.qvel.copy()
    still, _ = moving(0.0, np.zeros(3))
    turned, _ = moving(1.0, np.zeros(3))
    turn = -(still @ hands.ahead) / ((turned - still) @ hands.ahead)
    off, momentum = moving(turn, np.array([0.3, -0.2, 0.1]))
    data.qvel[:] = before
    mujoco.mj_fwdVelocity(mj, data)
    assert off @ hands.ahead == pytest.approx(0.0, abs=1e-9)
    assert spin == pytest.approx(momentum, rel=1e-9)


def test_the_line_of_the_hands_turns_with_them(scene):
    hands = _hands(scene, HANDS)
    (_, left), (_, right) = hands.ends
    assert (left - right) @ hands.ahead == pytest.approx(0.0, abs=1e-12)
    assert (left - right) @ hands.left > 0.2
    assert hands.ahead[0] > 0.8
    assert hands.half == pytest.approx(0.5 * np.hypot(*(left - right)[:2]))


def test_a_shift_brakes_before_it_is_there(scene):
    """Far away it is pulled by as much as it may; near and fast it is held back."""
    shift = Shift("shift", HANDS, 4.0, 0.05)
    hands, momentum = _hands(scene, HANDS), scene.state.momentum
    task = np.zeros(1, TASK)[0]

    def asked(off, speed):
        com = np.array([hands.middle[0] + off, hands.middle[1], 1.0])
        moved = momentum._replace(com=com, com_velocity=np.array([speed, 0.0, 0.0]))
        state = scene.state._replace(momentum=moved)
        shift.fill(task, "linear", SimpleNamespace(**{**vars(scene), "state": state}))
        return float(task["acceleration"][0])

    assert asked(-0.5, 0.0) == pytest.approx(16.0 * 0.05)
    assert asked(-0.01, 0.1) == pytest.approx(-8.0 * 0.1 + 16.0 * 0.01)
    assert asked(0.0, 0.0) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("off", "speed", "met"), [(0.0, 0.0, 1), (0.05, 0.0, 0), (0.0, 0.2, 0)])
def test_over_is_near_and_slow(scene, off, speed, met):
    hands, momentum = _hands(scene, HANDS), scene.state.momentum
    com = np.array([hands.middle[0] + off, hands.middle[1], 1.0])
    moved = momentum._replace(com=com, com_velocity=np.array([speed, 0.0, 0.0]))
    there = SimpleNamespace(**{**vars(scene), "state": scene.state._replace(momentum=moved)})
    assert Over("over", HANDS, 0.03, 0.15).met(there) == bool(met)
    assert not Over("over", ("foot",), 9.0, 9.0).met(there)  # that is in the air


def test_poses_glide_from_rest_to_rest(scene):
    law = GlideSettings({"knee": 0.2}, {"knee": 1.0}, 2.0).make(scene.model, "glide")
    knee = scene.model.motors("knee", "glide")[0]

    def at(time):
        begin = SimpleNamespace(time=1.0)
        state = SimpleNamespace(time=1.0 + time)
        poses, speeds = law.poses(SimpleNamespace(begin=begin, state=state), None)
        return float(poses[0, knee]), float(speeds[0, knee])

    assert at(0.0) == (0.2, 0.0)
    assert at(1.0)[0] == pytest.approx(0.6)
    assert at(2.0) == pytest.approx((1.0, 0.0))
    assert at(5.0) == pytest.approx((1.0, 0.0))
    for time in (0.3, 1.0, 1.6):
        slope = (at(time + 1e-6)[0] - at(time - 1e-6)[0]) / 2e-6
        assert at(time)[1] == pytest.approx(slope, rel=1e-6)


def test_a_glide_the_other_way_has_mirrored_poses(scene):
    stage = Stage("a", glide=GlideSettings({"shoulder_x_l": 0.5}, {"waist_z": 0.3}, 1.0))
    other = mirrored(stage, scene.model).glide
    assert other.start["shoulder_x_r"] == pytest.approx(0.5)
    assert other.end["waist_z"] == pytest.approx(-0.3)
    assert other.seconds == 1.0


def test_only_hands_and_straight_up_count_as_held():
    """By rows: feet on the ground, legs not up yet, tipped over, and nothing at all."""
    steps = 600
    bodies = np.full((steps, 2), -1)
    bodies[:] = [1, 2]
    up = np.full(steps, -1.0)
    height = np.full(steps, 1.0)
    bodies[:100, 1] = 3  # a foot
    height[100:200] = 0.7
    up[400:450] = -0.9
    bodies[450:] = -1
    height[0] = 1.0
    log = {
        "model/body": np.array([b"world", b"forearm_l", b"forearm_r", b"foot_l"]),
        "contacts/body": bodies,
        "contacts/count": (bodies > 0).sum(axis=1),
        "trajectory/com": np.stack((0.0 * height, 0.0 * height, height), axis=1),
        "trajectory/ground_height": np.zeros(steps),
        "trajectory/trunk_axes": up[:, None, None] * np.ones((1, 3, 3)),
    }
    assert longest_held(log, HELD, PERIOD) == pytest.approx(200 * PERIOD)


def test_who_kicks_up_takes_off_one_leg_after_the_other_and_joins_them_over_the_hands():
    """From one start: hands, the free leg up, a push that turns the body, and balance on top."""
    config = load(["behaviour=kick_up", "seed=2001", "plant=varied", "duration=7.5"])
    scenario = build(config)
    buffer, ending = in_memory(scenario)
    assert not ending
    log, model = buffer.arrays(), scenario.model
    angles = np.asarray(log["trajectory/qpos"])[:, model.angles]
    left, right = angles[:, model.motors("hip_y", "here")].T
    bodies = np.asarray(log["contacts/body"])
    on = {name: (bodies == model.mj.body(name).id).any(axis=1) for name in ("foot_l", "foot_r")}
    off = {name: int(np.flatnonzero(touches)[-1]) for name, touches in on.items()}
    assert off["foot_l"] - off["foot_r"] > 0.5 / PERIOD
    released = off["foot_l"]
    assert left[released] - right[released] > 1.5  # [rad] legs apart
    turning = np.asarray(log["trajectory/angular_momentum"])[released - 24 : released, 1]
    assert turning.max() > 8.0  # [kg m2/s] the push turns the body
    assert longest_held(log, HELD, PERIOD) > 1.0
    assert np.abs(left[-1] - right[-1]) < 0.2
