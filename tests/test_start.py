"""Start states: on the ground, moving as asked, the same for the same seed."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl import scenario
from rotctl.mechanics.model import lowest_and_highest
from rotctl.simulation.start import Start, StartSettings, draw, place

STARTS = [
    Start(-0.4, np.array([1.1, -0.2, 0.0]), np.array([0.5, 6.0, -0.7])),
    Start(2.5, np.array([-0.6, 0.1, 0.0]), np.array([0.0, -3.0, 0.3])),
    Start(0.0, np.zeros(3), np.zeros(3)),
]
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
RANGES = StartSettings(
    name="test",
    pitch=(-0.6, 0.0),
    speed_x=(0.6, 1.4),
    speed_y=(-0.1, 0.1),
    angular_velocity_x=(-0.4, 0.4),
    angular_velocity_y=(3.0, 7.0),
    angular_velocity_z=(-0.5, -0.4),
)


@pytest.fixture(params=range(len(STARTS)))
def placed(request, world):
    """(start, pose, data) of a placed character, in a folded and twisted pose."""
    low, high = world.model.joint_range.T
    pose = np.random.default_rng(request.param).uniform(low, high)
    data = mujoco.MjData(world.mj)
    data.qpos[:], data.qvel[:], data.time = 7.0, 7.0, 3.0  # leftovers of another run
    place(world.model, data, STARTS[request.param], UPRIGHT, pose)
    return STARTS[request.param], pose, data


def test_the_lowest_point_is_on_the_ground(world, placed):
    """Distance from the ground to each solid geom, by MuJoCo's own collision code."""
    _, _, data = placed
    mujoco.mj_kinematics(world.mj, data)
    ground = world.mj.geom("ground").id
    gaps = [
        mujoco.mj_geomDistance(world.mj, data, ground, geom, 10.0, None)
        for geom in range(world.mj.ngeom)
        if world.mj.geom_bodyid[geom] > 0 and world.mj.geom_contype[geom] > 0
    ]
    assert min(gaps) == pytest.approx(0.0, abs=1e-9)
    mine = lowest_and_highest(world.mj, data, world.mj.geom_contype == 1)
    assert mine[0] == pytest.approx(0.0, abs=1e-9)


def test_centre_of_mass_velocity_and_angular_momentum(world, placed):
    """The whole body moves as one rigid piece: H = I_c omega."""
    start, _, data = placed
    mujoco.mj_step1(world.mj, data)
    _, linear, angular, inertia = world.body_sums(world.mj, data)
    assert linear / world.model.mass == pytest.approx(start.velocity, abs=1e-12)
    assert angular == pytest.approx(inertia @ start.angular_velocity, abs=1e-10)
    assert not data.qvel[6:].any()


def test_pose_pitch_and_a_clean_slate(placed):
    start, pose, data = placed
    assert data.qpos[7:].tolist() == pose.tolist()
    expected = Rotation.from_euler("y", start.pitch).as_quat(scalar_first=True)
    assert data.qpos[3:7] == pytest.approx(expected, abs=1e-12)
    assert data.qpos[:2].tolist() == [0.0, 0.0]
    assert data.time == 0.0


def test_draw_stays_in_its_ranges_and_fills_them():
    generator = np.random.default_rng(0)
    drawn = [draw(RANGES, generator) for _ in range(200)]
    for values, (low, high) in (
        ([s.pitch for s in drawn], RANGES.pitch),
        ([s.velocity[0] for s in drawn], RANGES.speed_x),
        ([s.velocity[1] for s in drawn], RANGES.speed_y),
        ([s.angular_velocity[0] for s in drawn], RANGES.angular_velocity_x),
        ([s.angular_velocity[1] for s in drawn], RANGES.angular_velocity_y),
        ([s.angular_velocity[2] for s in drawn], RANGES.angular_velocity_z),
    ):
        assert low <= min(values) < low + 0.1 * (high - low)
        assert high - 0.1 * (high - low) < max(values) <= high
    assert all(s.velocity[2] == 0.0 for s in drawn)


def test_same_seed_same_state(world):
    def first_state(seed):
        made = scenario.build(replace(world.config, seed=seed, start=RANGES))
        data = mujoco.MjData(made.model.mj)
        behaviour = made.behaviour
        place(made.model, data, made.start, behaviour.orientation, behaviour.pose(made.start.pitch))
        return data.qpos.tobytes() + data.qvel.tobytes()

    assert first_state(5) == first_state(5)
    assert first_state(5) != first_state(6)


def test_an_empty_range_draws_its_value():
    fixed = replace(RANGES, pitch=(-0.3, -0.3))
    assert draw(fixed, np.random.default_rng(1)).pitch == -0.3
