"""Water: what it does to a body against sums that know no law of it."""

from copy import copy

import mujoco
import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.mechanics.bodies import is_character
from rotctl.mechanics.disturbance import Nothing, OnePush
from rotctl.mechanics.water import Water
from rotctl.motion import make_pose
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

PERIOD = 1.0 / 240.0
DEEP = -12.0  # [m] all of a body under water that begins at -10


@pytest.fixture(scope="module")
def pool():
    return build(load(["behaviour=dive_forward"]))


def at(pool, height, velocity=(0.0, 0.0, 0.0), besides=None):
    """A body at rest in its joints, and what the water does to it: (data, wrench)."""
    mj, data = pool.model.mj, mujoco.MjData(pool.model.mj)
    data.qpos[:3], data.qpos[3:7] = (3.0, 0.0, height), (0.8, 0.1, 0.5, 0.3)
    mujoco.mj_normalizeQuat(mj, data.qpos)
    data.qvel[:3] = velocity
    mujoco.mj_step1(mj, data)
    water = Water(mj, pool.model.ground, besides or Nothing())
    return data, water.apply(data, PERIOD, np.nan)


def test_a_body_over_the_water_feels_nothing(pool):
    data, wrench = at(pool, -8.0, (1.0, 0.0, -14.0))
    assert not wrench.any()
    assert not data.xfrc_applied.any()


def test_at_rest_it_bears_a_little_more_than_the_weight(pool):
    _, wrench = at(pool, DEEP)
    ground = pool.model.ground
    weight = pool.model.mass * 9.81
    assert wrench[:3] == pytest.approx([0.0, 0.0, weight * ground.density / ground.body], rel=1e-9)
    assert np.abs(wrench[3:]).max() < 1e-9 * weight  # at the centre of mass: as light as everywhere


def test_half_under_it_bears_a_part_and_the_sum_is_what_bodies_get(pool):
    data, wrench = at(pool, -10.0, (0.0, 0.0, -3.0))
    assert 0.0 < wrench[2] < at(pool, DEEP, (0.0, 0.0, -3.0))[1][2]
    lever = data.xipos - data.subtree_com[1]
    moment = (data.xfrc_applied[:, 3:] + np.cross(lever, data.xfrc_applied[:, :3])).sum(axis=0)
    assert wrench == pytest.approx(np.concatenate((data.xfrc_applied[:, :3].sum(axis=0), moment)))


@pytest.mark.parametrize("speed", [0.5, 5.0, 30.0, 1000.0])
def test_it_takes_speed_and_never_throws_back(pool, speed):
    """However fast: no body's momentum changes its sign in a control period."""
    way = np.array([0.6, 0.0, -0.8])
    data, _ = at(pool, DEEP, tuple(speed * way))
    still, _ = at(pool, DEEP)
    taken = data.xfrc_applied[:, :3] - still.xfrc_applied[:, :3]
    own = is_character(pool.model.mj)
    along = taken[own] @ way * PERIOD
    momentum = pool.model.mj.body_mass[own] * speed
    assert (along < 0.0).all()
    assert (along > -momentum).all()


def test_who_loses_mass_in_the_water_is_not_thrown_back_either(pool):
    """It is borne as before, by its volume; what the drag can take is that of the mass it has."""
    mj, data = copy(pool.model.mj), mujoco.MjData(pool.model.mj)
    data.qpos[:3], data.qpos[3:7] = (3.0, 0.0, DEEP), (1.0, 0.0, 0.0, 0.0)
    mujoco.mj_step1(mj, data)
    water = Water(mj, pool.model.ground, Nothing())
    borne = water.apply(data, PERIOD, np.nan)
    mj.body_mass[:] *= 0.1
    assert water.apply(data, PERIOD, np.nan) == pytest.approx(borne, rel=1e-12)
    still = data.xfrc_applied[:, 0].copy()
    data.qvel[0] = 30.0
    mujoco.mj_step1(mj, data)
    water.apply(data, PERIOD, np.nan)
    own = is_character(mj)
    taken = (data.xfrc_applied[:, 0] - still)[own] * PERIOD
    assert (taken < 0.0).all()
    assert (taken > -mj.body_mass[own] * 30.0).all()


def test_long_and_straight_it_glides(pool):
    """Across the flow it is held back several times as much as along its length."""
    mj, forces = pool.model.mj, []
    entry = make_pose(pool.model, {"shoulder_y": 3.05, "ankle_y": -0.85}, "pose")
    for way in ((0.0, 0.0, -5.0), (5.0, 0.0, 0.0)):
        data = mujoco.MjData(mj)
        data.qpos[:3], data.qpos[pool.model.angles] = (3.0, 0.0, DEEP), entry
        data.qvel[:3] = way
        mujoco.mj_step1(mj, data)
        wrench = Water(mj, pool.model.ground, Nothing()).apply(data, PERIOD, np.nan)
        still = pool.model.mass * 9.81 * pool.model.ground.density / pool.model.ground.body
        forces.append(np.linalg.norm(wrench[:3] - [0.0, 0.0, still]))
    assert forces[1] > 3.0 * forces[0]


def test_a_push_acts_besides(pool):
    push = OnePush(2, np.array([40.0, 0.0, 0.0]), 0.0, 1.0)
    _, pushed = at(pool, DEEP, besides=push)
    _, alone = at(pool, DEEP)
    assert (pushed - alone)[:3] == pytest.approx([40.0, 0.0, 0.0])


def test_a_diver_comes_to_rest_under_water(pool):
    """14 m/s at the entry: gone within a second, one to four metres down."""
    scenario = build(load(["behaviour=dive_forward", "seed=2000", "duration=5.2"]))
    log, _ = in_memory(scenario)
    entered = int(np.flatnonzero(np.diff(log.command.stage) > 0)[-1]) + 1
    speed = np.linalg.norm(log.trajectory.com_velocity, axis=1)
    under = pool.model.ground.water - float(log.trajectory.com[-1, 2])
    assert speed[entered] > 12.0
    assert speed[-1] < 1.0
    assert 0.5 < under < 4.5
