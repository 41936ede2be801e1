"""Flight: where a body lands that chooses its shape alone, against mechanics that know no law."""

import mujoco
import numpy as np
import pytest
from flights import ARCHED, HEAD_FIRST, LEFT, LONG, TUCK, flier, fly, spawn

from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.mechanics.shape import Shapes
from rotctl.motion import make_pose
from rotctl.runs.scenario import build


@pytest.fixture(scope="module")
def dive():
    return flier(1.5)


def pose_of(model, pose):
    return make_pose(model, pose, "pose")


def inertia_by_sum(model, pose):
    """About the centre of mass, from every body's own inertia and place."""
    data = mujoco.MjData(model.mj)
    data.qpos[3:7] = [1, 0, 0, 0]
    data.qpos[model.angles] = pose
    mujoco.mj_forward(model.mj, data)
    total = np.zeros((3, 3))
    for body in range(1, model.mj.nbody):
        turn = data.ximat[body].reshape(3, 3)
        away = data.xipos[body] - data.subtree_com[1]
        total += turn @ np.diag(model.mj.body_inertia[body]) @ turn.T
        total += model.mj.body_mass[body] * (away @ away * np.eye(3) - np.outer(away, away))
    return total


@pytest.mark.parametrize("pose", [LONG, TUCK, ARCHED])
def test_inertia_of_a_shape_is_that_of_its_bodies(dive, pose):
    angles = pose_of(dive.model, pose)
    found = Shapes(dive.model).inertia(angles, LEFT)
    armature = 0.5  # [kg m2] the joints' own, which moves with them and is no body's
    assert found == pytest.approx(inertia_by_sum(dive.model, angles)[1, 1], abs=armature)


@pytest.mark.parametrize("behaviour", ["dive_forward", "dive_backward"])
@pytest.mark.parametrize("shape", ["tuck", "pike"])
def test_a_diver_spins_about_the_axis_of_greatest_inertia(behaviour, shape):
    """About the middle axis, Euler, whatever is off grows: of old tucks that was the left one."""
    diver = build(load([f"behaviour={behaviour}", f"behaviour.shape={shape}"]))
    law = diver.behaviour._laws["flight"]
    for amount, more in ((0.6, 1.1), (0.7, 1.1), (0.8, 1.1), (0.9, 1.1), (1.0, 1.0)):
        inertia = inertia_by_sum(diver.model, law.tucking.pose(amount, law.landing.usual))
        others = np.linalg.eigvalsh(inertia[np.ix_([0, 2], [0, 2])])
        assert np.abs(inertia[1, [0, 2]]).max() < 1e-6  # both sides are alike: left is a main axis
        assert inertia[1, 1] > more * others.max(), amount


def test_a_change_of_shape_turns_a_body_that_has_no_momentum(dive):
    """A cat's turn: no gravity, no momentum, joints pulled from one pose to another."""
    model = dive.model
    start, end = pose_of(model, LONG), pose_of(model, TUCK)
    data = mujoco.MjData(model.mj)
    spawn(model, data, start, 0.0, 5.0, 0.0, np.zeros(3))
    gravity = model.mj.opt.gravity.copy()
    model.mj.opt.gravity[:] = 0.0
    model.mj.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    try:
        for step in range(2400):
            share = min(step / 2000, 1.0)
            wanted = start + share * (end - start)
            error = wanted - data.qpos[model.angles]
            data.ctrl[:] = 900.0 * error - 40.0 * data.qvel[model.joints]
            mujoco.mj_step(model.mj, data)
    finally:
        model.mj.opt.gravity[:] = gravity
        model.mj.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    front = data.xmat[1].reshape(3, 3)[:, 0]
    turned = np.arctan2(-front[2], front[0])
    reached = data.qpos[model.angles]
    assert np.abs(reached - end).max() < 0.1
    assert Shapes(model).turn(start, reached, LEFT) == pytest.approx(turned, abs=0.03)
    assert abs(turned) > 0.15  # [rad] what the law would miss without it


@pytest.mark.parametrize(
    ("turns", "least", "height", "up"),
    [
        (1.5, 26.0, 11.0, 2.5),
        (0.5, 8.5, 11.0, 2.5),
        (-1.5, 26.0, 11.0, 2.5),
        (-2.5, 44.0, 11.0, 2.5),
    ],
)
def test_it_lands_at_its_attitude_over_a_range_of_momenta(turns, least, height, up):
    """|H| over a range of 1:3, or as far as the longest shape goes: 3 degrees, nearly always."""
    rng, flights = np.random.default_rng(7), 4
    scenario = flier(turns)
    law = scenario.behaviour._laws["flight"]
    most = min(3.0 * least, 0.93 * abs(law._target) / (1.7 * law.tucking.slowness.min()))
    errors = []
    for momentum in np.geomspace(least, most, flights):
        landed = fly(flier(turns), momentum, height, up, rng.uniform(0.0, 0.4))
        errors.append(landed.error)
        assert landed.drift < 0.05  # it has nothing to push against
    late = np.abs(errors) > 3.0
    assert late.sum() <= 1, errors


def test_the_time_to_the_landing_is_that_of_a_fall(dive):
    """As MuJoCo throws it: the landing comes when the law says, whatever shape it is in."""
    for up, height in ((2.5, 11.0), (-1.0, 6.0)):
        law = dive.behaviour._laws["flight"]
        data = mujoco.MjData(dive.model.mj)
        spawn(
            dive.model, data, law.tucking.pose(1.0, law.landing.usual), 0.0, height, up, np.zeros(3)
        )
        mujoco.mj_forward(dive.model.mj, data)
        told = law.landing.usual_time(up, height)
        while data.subtree_com[1, 2] > law.landing.usual.height:
            mujoco.mj_step(dive.model.mj, data)
        assert data.time == pytest.approx(told, abs=0.01)


def test_too_little_momentum_tucks_all_the_way_and_falls_short():
    landed = fly(flier(1.5), 20.0, 11.0, 2.5, 0.2)
    assert -120.0 < landed.error < -20.0


def test_momentum_that_a_stage_plans_for_is_what_the_flight_needs():
    """What `momentum` says for an average tuck turns a rigid body of that shape as far in time."""
    scenario = flier(1.5)
    law = scenario.behaviour._laws["flight"]
    assert law.tucking.mean_slowness(0.0, 0.0, 1.7) == pytest.approx(
        1.0 / Shapes(scenario.model).inertia(pose_of(scenario.model, LONG), LEFT)
    )
    held, tight = law.tucking.mean_slowness(1.0, 1.0, 100.0), pose_of(scenario.model, TUCK)
    assert held == pytest.approx(1.0 / Shapes(scenario.model).inertia(tight, LEFT), rel=0.03)


def test_a_flight_names_what_it_does_not_know():
    with pytest.raises(InputError, match=r"flight.tuck names the unknown joint 'hips'"):
        flier(1.0, HEAD_FIRST | {"tuck": {"hips": 1.0}})
    with pytest.raises(InputError, match="opening"):
        flier(1.0, HEAD_FIRST | {"opening": 0.0})
