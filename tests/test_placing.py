"""A start put into the physics: on the ground, moving as asked."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.behaviours.behaviour import Placement
from rotctl.config.loading import load
from rotctl.maths.rotations import advance
from rotctl.mechanics.bodies import lowest_and_highest
from rotctl.runs import scenario
from rotctl.simulation.episode import Episode
from rotctl.simulation.placing import SINK, place
from rotctl.simulation.start import Start

STARTS = [
    Start(-0.4, np.array([1.1, -0.2, 0.0]), np.array([0.5, 6.0, -0.7])),
    Start(2.5, np.array([-0.6, 0.1, 0.0]), np.array([0.0, -3.0, 0.3])),
    Start(0.0, np.zeros(3), np.zeros(3)),
]
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
WAYS = np.eye(3)  # forward, left and up


@pytest.fixture(params=range(len(STARTS)))
def placed(request, world):
    """(start, pose, data) of a placed character, in a folded and twisted pose."""
    low, high = world.model.joint_range.T
    pose = np.random.default_rng(request.param).uniform(low, high)
    data = mujoco.MjData(world.mj)
    data.qpos[:], data.qvel[:], data.time = 7.0, 7.0, 3.0  # leftovers of another run
    start = STARTS[request.param]
    usual = Placement(advance(UPRIGHT, start.pitch * WAYS[1]), pose)
    place(world.model, data, start, usual, WAYS)
    return start, pose, data


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
    assert min(gaps) == pytest.approx(-SINK, abs=1e-6)  # the model's numbers have six digits
    mine = lowest_and_highest(world.mj, data, world.mj.geom_contype == 1)
    assert mine[0] == pytest.approx(-SINK, abs=1e-6)  # the model's numbers have six digits


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


@pytest.mark.exact
@pytest.mark.parametrize("about", ["left", "right", "head"])
@pytest.mark.parametrize("ground", ["flat", "decline"])
def test_still_is_at_rest_on_the_ground_for_every_roll(about, ground):
    made = scenario.build(
        load(
            ["start=still", "behaviour.alighting=null", "behaviour.catch=null"]
            + [f"behaviour.roll_about={about}", f"terrain={ground}", "seed=2"]
        )
    )
    mj, data = made.model.mj, Episode(made).data
    assert not data.qvel.any()
    assert data.qpos[7:].tolist() == made.start.pose.tolist()
    mujoco.mj_forward(mj, data)
    gaps = [
        mujoco.mj_geomDistance(mj, data, mj.geom("ground").id, geom, 10.0, None)
        for geom in np.flatnonzero((mj.geom_bodyid > 0) & (mj.geom_contype > 0))
    ]
    assert min(gaps) == pytest.approx(-SINK, abs=1e-6)  # the model's numbers have six digits
