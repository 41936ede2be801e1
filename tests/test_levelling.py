"""Flights with momentum across their way: what is planned, against mechanics that know no law."""

import mujoco
import numpy as np
import pytest
from flights import ARCHED, HEAD_FIRST, LONG, TUCK, flier, spawn

from rotctl.behaviours.aerial.levelling import Ahead, Levelled, _solved
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.metrics.criteria import dive
from rotctl.motion import make_pose
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.simulation.episode import Episode

SEEDS = (2001, 2014, 2015)  # without arms each enters 5 degrees off, or 6
LEVEL = {
    "arms": {"shoulder_y_l": -1.0, "shoulder_x_l": 1.0},
    "interval": 1 / 60,
    "twist": 0.0005,
    "effort": 0.0001,
}


@pytest.fixture(scope="module")
def law():
    return flier(1.5, HEAD_FIRST | {"levelling": LEVEL}).behaviour._laws["flight"]


def test_three_equations_are_solved():
    rng = np.random.default_rng(3)
    for _ in range(5):
        some = rng.normal(size=(3, 3))
        matrix, right = some @ some.T + np.eye(3), rng.normal(size=3)
        found = _solved(tuple(map(tuple, matrix.tolist())), tuple(right.tolist()))
        assert np.allclose(matrix @ np.array(found), right)


def test_an_arm_to_the_right_is_the_mirror_image(law):
    model, levelling = law._model, law._levelling
    names = list(model.joint_names)
    left, right = levelling.offset(0.5), levelling.offset(-0.5)
    assert left[names.index("shoulder_x_l")] == right[names.index("shoulder_x_r")] == 0.5
    assert np.count_nonzero(left) == np.count_nonzero(right) == 2
    assert not levelling.offset(0.0).any()


@pytest.mark.parametrize("moves", [False, True])
def test_the_plan_ends_where_mechanics_end(law, moves):
    """MuJoCo, without gravity: a body that tumbles, with joints that follow the planned shapes."""
    model = law._model
    start = make_pose(model, TUCK, "tuck")
    end = make_pose(model, LONG if moves else TUCK, "end")
    data = mujoco.MjData(model.mj)
    spawn(model, data, start, 0.3, 5.0, 0.0, np.array([2.0, 30.0, 3.0]))
    time, mj = 0.5, model.mj
    ahead = Ahead(
        time,
        0.0,
        tuple(data.qpos[3:7].tolist()),
        [2.0, 30.0, 3.0],
        start,
        lambda after: start + min(after / time, 1.0) * (end - start),
        lambda after: 1.0,
        lambda after: 1.0,
        np.eye(3).tolist(),
        0.0,
        1.0,
    )
    planned = np.array(law._levelling._landed(0.0, 0.0, ahead))
    kept = mj.opt.gravity.copy(), mj.opt.timestep, mj.opt.disableflags
    mj.opt.gravity[:], mj.opt.timestep = 0.0, 1e-4
    mj.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    try:
        while data.time < time:
            wanted, speed = ahead.pose(data.time), (end - start) / time
            data.ctrl[:] = 4000.0 * (wanted - data.qpos[model.angles]) + 40.0 * (
                speed - data.qvel[model.joints]
            )
            mujoco.mj_step(mj, data)
    finally:
        mj.opt.gravity[:], mj.opt.timestep, mj.opt.disableflags = kept
    off = 2.0 * np.arccos(min(abs(float(planned @ data.qpos[3:7])), 1.0))
    assert off < 0.05  # [rad] of some 3 that it turns


def test_a_fall_from_anywhere_is_looked_at_in_so_many_parts(law, monkeypatch):
    asked, shapes = [], law._levelling._shapes
    spin = shapes.spin
    monkeypatch.setattr(shapes, "spin", lambda *pose: asked.append(1) or spin(*pose))
    pose = make_pose(law._model, TUCK, "tuck")
    axes, still = np.eye(3).tolist(), (1.0, 0.0, 0.0, 0.0)

    def share(after):
        return 1.0

    for time, parts in ((0.01, 6), (1.0, 20), (1e6, 100)):
        asked.clear()
        ahead = Ahead(
            time, 0.0, still, [0.0, 1.0, 0.0], pose, lambda _: pose, share, share, axes, 0.0, 1.0
        )
        law._levelling._landed(0.0, 0.0, ahead)
        assert len(asked) == parts


def test_a_flight_without_momentum_across_needs_no_arms():
    scenario = flier(1.5, HEAD_FIRST | {"levelling": LEVEL})
    episode, law = Episode(scenario), scenario.behaviour._laws["flight"]
    pose = law.tucking.pose(-0.6, law.landing.usual)
    spawn(scenario.model, episode.data, pose, 0.2, 11.0, 2.5, np.array([0.0, 45.0, 0.0]))
    for moment in episode:
        level = episode.memory.law.level if episode.memory.law else Levelled()
        if moment.state.time > 1.5:
            break
    assert abs(level.amount) < 0.02


def test_arms_bring_the_body_into_its_plane():
    entered = 0
    for seed in SEEDS:
        config = load(["behaviour=flight", f"seed={seed}", "duration=1.9"])
        log = in_memory(build(config))[0].arrays()
        entered += not dive.judge(log, config.criteria, 540.0, 1 / 240)[1]
    assert entered >= len(SEEDS) - 1


def test_levelling_is_of_turns_about_left():
    with pytest.raises(InputError, match=r"flight\.levelling: is of turns about left"):
        _pirouette_with_arms()


def _pirouette_with_arms():
    from rotctl.config.loading import composed
    from rotctl.config.schema import check

    data = composed(["behaviour=pirouette"])
    for stage in data["behaviour"]["stages"]:
        if stage.get("flight"):
            stage["flight"]["levelling"] = LEVEL
    build(check(data))


def test_arms_are_of_the_shapes_that_are_named():
    for shapes, has in (([], True), (["pike"], False), (["pike", "tuck"], True)):
        level = {"levelling": LEVEL | {"shapes": shapes}, "shapes": {"pike": TUCK}}
        law = flier(1.5, HEAD_FIRST | level).behaviour._laws["flight"]
        assert (law._levelling is not None) is has
    with pytest.raises(InputError, match=r"levelling: no shape 'pikes'; valid: tuck"):
        flier(1.5, HEAD_FIRST | {"levelling": LEVEL | {"shapes": ["pikes"]}})


def test_a_shape_midway_is_taken_at_its_amount():
    dish = ARCHED | {"hip_y": 0.6}
    settings = HEAD_FIRST | {"midway": {"amount": 0.3, "pose": dish}}
    law = flier(1.5, settings).behaviour._laws["flight"]
    model, usual = law._model, law.landing.usual
    assert np.allclose(law.tucking.pose(0.3, usual), make_pose(model, dish, "dish"))
    assert np.allclose(law.tucking.pose(1.0, usual), make_pose(model, TUCK, "tuck"))
    assert np.allclose(law.tucking.pose(0.0, usual), usual.pose)
    near = [law.tucking.pose(amount, usual) for amount in (0.2999, 0.3001)]
    assert np.abs(near[1] - near[0]).max() < 0.002
    with pytest.raises(InputError, match=r"its amount 1 is not between 0 and 1"):
        flier(1.5, HEAD_FIRST | {"midway": {"amount": 1.0, "pose": dish}})
