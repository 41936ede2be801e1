"""Loose boxes and fixed bars: what is the character's stays so, and contacts count."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.control import Controller, compiled
from rotctl.log import RunLog
from rotctl.mechanics.bodies import is_character
from rotctl.mechanics.contacts import contact_jacobian, realised_forces
from rotctl.mechanics.state import read
from rotctl.report import shapes, stored_model
from rotctl.report.spacing import change
from rotctl.runs.run import LOG_NAME, run
from rotctl.runs.scenario import build
from rotctl.simulation.episode import Episode


def made(*overrides):
    return build(load(["terrain=hazards", *overrides]))


def among_boxes(scenario, seed=0):
    """Data of a tucked character that moves, with half of the boxes thrown at it."""
    mj, rng = scenario.model.mj, np.random.default_rng(seed)
    data = Episode(scenario).data
    boxes = np.arange(scenario.model.angles.stop, mj.nq, 7)
    for box in boxes[::2]:
        data.qpos[box : box + 3] = data.qpos[:3] + rng.normal(scale=0.25, size=3) * [1, 1, 0.3]
    data.qvel[:] = rng.normal(size=mj.nv)
    mujoco.mj_step1(mj, data)
    return data


@pytest.fixture(scope="module")
def scenario():
    return made("seed=1")


def test_what_is_said_of_joints_is_not_of_boxes(tmp_path):
    log = RunLog.open(run(load(["behaviour=hazards", "duration=4"]), tmp_path).folder / LOG_NAME)
    joints, rates = len(log["model/joint"]), log["trajectory/qvel"]
    assert rates.shape[1] > 6 + joints, "there are boxes"
    second = np.diff(rates[:, 6 : 6 + joints], 2, axis=0) * 60.0**2
    assert log.outcome["jerk"] == pytest.approx(np.sqrt((second**2).mean()))
    thrown = dict(log)
    thrown["trajectory/qvel"] = rates.copy()
    thrown["trajectory/qvel"][:, 6 + joints :] += 100.0
    assert (change(thrown) == change(log)).all(), "frames of a filmstrip lie where it moves"


@pytest.fixture(scope="module")
def hit(scenario):
    """A state in which the character touches boxes as well as the ground."""
    for seed in range(50):
        data = among_boxes(scenario, seed)
        bodies = scenario.model.mj.geom_bodyid[data.contact.geom]
        own = is_character(scenario.model.mj)[bodies]
        if ((own.sum(axis=1) == 1) & (bodies > 0).all(axis=1)).sum() >= 3:
            return data
    raise AssertionError("no state with boxes in reach")


def test_the_character_comes_first(scenario):
    """Its part of the model is that of flat ground, body by body and dof by dof."""
    flat = build(load([])).model
    model = scenario.model
    assert model.mj.nv == flat.mj.nv + 6 * len(model.ground.boxes) > flat.mj.nv
    assert model.joint_names == flat.joint_names
    assert (model.joints, model.angles) == (flat.joints, flat.angles)
    assert is_character(model.mj).sum() == flat.mj.nbody - 1
    for name in ("mass", "torque_limit", "armature", "joint_range", "trunk", "trunk_weights"):
        assert np.array_equal(getattr(model, name), getattr(flat, name)), name


def test_momentum_is_the_character_s_alone(scenario, hit):
    """Against Newton and Euler, over the character's bodies one by one."""
    mj, found = scenario.model.mj, read(scenario.model, hit).momentum
    chosen = np.flatnonzero(is_character(mj))
    mass = mj.body_mass[chosen]
    com = mass @ hit.xipos[chosen] / mass.sum()
    linear, angular, velocity = np.zeros(3), np.zeros(3), np.empty(6)
    for body in chosen:
        mujoco.mj_objectVelocity(mj, hit, mujoco.mjtObj.mjOBJ_BODY, body, velocity, 0)
        axes = hit.ximat[body].reshape(3, 3)
        arm = hit.xipos[body] - com
        linear += mj.body_mass[body] * velocity[3:]
        angular += axes @ (mj.body_inertia[body] * (axes.T @ velocity[:3]))
        angular += mj.body_mass[body] * np.cross(arm, velocity[3:])
    assert found.com == pytest.approx(com, abs=1e-9)
    assert found.linear == pytest.approx(linear, abs=1e-9)
    assert found.angular == pytest.approx(angular, abs=1e-9)


def test_contacts_with_boxes_carry_the_character(scenario, hit):
    """The realised forces are what changes its momentum: no contact is left out or doubled."""
    mj = scenario.model.mj
    mujoco.mj_forward(mj, hit)
    contacts = read(scenario.model, hit).contacts
    assert is_character(mj)[contacts.body].all()
    force = realised_forces(mj, hit, contacts).sum(axis=0)
    inertial = np.empty(mj.nv)
    mujoco.mj_mulM(mj, hit, inertial, hit.qacc)
    assert np.abs(force).max() > 10.0
    # Newton's method ends before the residual is 0: 3e-6 of the force were measured.
    assert inertial[:3] + hit.qfrc_bias[:3] == pytest.approx(force, rel=1e-5, abs=1e-3)


def test_rows_are_the_character_s_velocity(scenario, hit):
    """Along its frame, a contact point of the body moves as MuJoCo's own Jacobian says."""
    mj = scenario.model.mj
    contacts = read(scenario.model, hit).contacts
    rows = contact_jacobian(mj, hit, contacts)
    assert not rows[:, scenario.model.joints.stop :].any()
    point = np.empty((3, mj.nv))
    for i in range(contacts.count):
        mujoco.mj_jac(mj, hit, point, None, contacts.position[i], contacts.body[i])
        assert rows[3 * i : 3 * i + 3] == pytest.approx(contacts.frame[i] @ point, abs=1e-9)


@pytest.mark.parametrize("backend", ["compiled", "reference"])
def test_boxes_out_of_reach_change_nothing(backend):
    """The same torques as on flat ground, from either backend."""
    if backend == "compiled" and compiled.library() is None:
        pytest.skip("the compiled control step is not built here")
    decided = []
    for terrain in ("flat", "hazards"):
        one = build(load([f"terrain={terrain}", f"controller.backend={backend}", "seed=2"]))
        assert one.controller.backend == backend
        episode = Episode(one)
        episode.data.qpos[2] -= 1e-3  # onto the ground, not just to it
        decided.append(next(iter(episode)).decision)
    assert len(decided[0].used) > 0
    assert decided[0].torque == pytest.approx(decided[1].torque, rel=1e-7, abs=1e-7)
    assert decided[0].force == pytest.approx(decided[1].force, rel=1e-6, abs=1e-6)


def test_the_literal_form_agrees_among_boxes(scenario, hit):
    """Eq. 2 as written, accelerations of the boxes included, gives the condensed form's torques."""
    settings = scenario.config.controller
    tight = replace(settings, backend="reference", solver="qpsolvers:daqp")
    state = read(scenario.model, hit)
    command = scenario.behaviour.command(scenario.behaviour.begin(0.0, state), state)
    command = command._replace(supervisor="none")
    condensed = Controller(scenario.model, tight).decide(state, command, 0.5)
    literal = Controller(scenario.model, replace(tight, form="literal"))
    written = literal.decide(state, command, 0.5)
    assert written.fallback == condensed.fallback == 0
    assert written.torque == pytest.approx(condensed.torque, abs=1e-2)


def test_a_roll_pushes_boxes_and_the_log_shows_it(tmp_path):
    config = load(["terrain=hazards", "seed=6", "duration=6", "behaviour=terrain_roll"])
    result = run(config, tmp_path)
    log = RunLog.open(result.folder / LOG_NAME)
    model = stored_model.load(log)
    boxes = np.flatnonzero(~is_character(model))[1:] - 1  # the world has no pose
    assert len(boxes) == len(build(config).model.ground.boxes) >= 3
    seen = shapes.poses(model, log["trajectory/qpos"][[0, -1]])
    moved = np.linalg.norm(seen.positions[1, boxes] - seen.positions[0, boxes], axis=1)
    assert moved.max() > 0.02  # pushed; those that only settle move 0.1 mm
    assert (moved < 1e-3).any()  # those not reached yet
    assert all(shapes.bodies(model)[box][0]["kind"] == "box" for box in boxes)
    assert seen.com[1] == pytest.approx(log["trajectory/com"][-1], abs=1e-6)


def test_bars_and_boxes_follow_the_seed():
    def things(seed):
        return made(f"seed={seed}", "duration=19").model.ground

    one, same, other = things(4), things(4), things(5)
    assert (one.bars, one.boxes) == (same.bars, same.boxes)
    assert one.bars != other.bars
    assert one.boxes != other.boxes
    assert (len(one.bars), len(one.boxes)) == (14, 14)  # a whole stretch
    x = sorted(thing.centre[0] for thing in (*one.bars, *one.boxes))
    assert x[0] > 1.5
    assert min(np.diff(x)) >= 1.0  # half a spacing


def test_boxes_rest_until_they_are_touched():
    one = made("seed=0")
    data = mujoco.MjData(one.model.mj)
    data.qpos[0] = -50.0
    before = data.qpos.copy()
    mujoco.mj_step(one.model.mj, data, 240)
    boxes = slice(one.model.angles.stop, None)
    assert data.qpos[boxes] == pytest.approx(before[boxes], abs=5e-3)
