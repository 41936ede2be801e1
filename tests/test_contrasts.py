"""What the paper tried and rejected: each config asks the controller for what its name says."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl import scenario
from rotctl.behaviours.rolling import FACING
from rotctl.config import load
from rotctl.control.targets import momentum_rates
from rotctl.mechanics.state import read
from rotctl.rotations import rotate


def at_a_state(overrides):
    """A scenario with a state in it, in which pelvis and whole body turn differently."""
    made = scenario.build(load(overrides))
    mj, rng = made.model.mj, np.random.default_rng(4)
    data = mujoco.MjData(mj)
    data.qpos[2] = 50.0
    turned = Rotation.from_rotvec([0.3, 2.0, -0.2])
    data.qpos[3:7] = (
        turned * Rotation.from_quat(made.behaviour.orientation, scalar_first=True)
    ).as_quat(scalar_first=True)
    data.qvel[:] = rng.normal(size=mj.nv)
    data.time = 0.8
    mujoco.mj_step1(mj, data)
    state = read(made.model, data)
    now = made.behaviour.advance(made.behaviour.begin(0.1), state)
    return made, state, now, turned


@pytest.mark.parametrize("about", FACING)
def test_root_control_sees_the_pelvis_alone(about):
    made, state, now, turned = at_a_state(["controller=root", f"behaviour.roll_about={about}"])
    gains, behaviour = made.config.controller.gains, made.behaviour
    found = momentum_rates(behaviour.desired(state, now), state.momentum, made.model.mass, gains)
    velocity = np.empty(6)
    body = mujoco.mjtObj.mjOBJ_BODY
    mujoco.mj_objectVelocity(made.model.mj, state.data, body, 1, velocity, 0)
    assert np.abs(velocity[:3] - state.momentum.angular_velocity).max() > 0.3
    wanted = [0.0, 2 * np.pi * 1.3, 0.0]
    lateral = turned.apply([0, 1, 0])
    axis = np.cross(lateral, [0, 1, 0])
    missing = axis / np.linalg.norm(axis) * np.arccos(lateral[1])
    assert gains.angular_stiffness[1] == 0.0
    expected = state.momentum.inertia @ (
        np.array(gains.angular_stiffness) * missing
        + np.array(gains.angular_damping) * (wanted - velocity[:3])
    )
    assert found[3:] == pytest.approx(expected, rel=1e-9)
    assert rotate(now.orientation, np.array([0.0, 1.0, 0.0])) == pytest.approx(lateral)


def test_progress_under_root_control_is_still_the_whole_body_s():
    _, _, root, _ = at_a_state(["controller=root"])
    _, state, usual, _ = at_a_state([])
    assert root.angle.tolist() == usual.angle.tolist()
    expected = [0.0, 0.1, 0.0] + state.momentum.angular_velocity / 60
    assert root.angle == pytest.approx(expected)


def test_a_tracked_excursion_has_stiffness_and_a_target_that_turns():
    made, state, now, _ = at_a_state(["controller=tracked_excursion"])
    assert made.config.controller.gains.angular_stiffness[1] > 0
    error = made.behaviour.desired(state, now).excursion_error
    assert error[1] == pytest.approx(2 * np.pi * 1.3 * 0.8 - now.angle[1])


@pytest.mark.parametrize(
    ("name", "stiffness", "damping"), [("free_axis", 0.0, 23.0), ("free_rotation", 0.0, 0.0)]
)
def test_free_out_of_plane(name, stiffness, damping):
    gains = load([f"controller={name}"]).controller.gains
    usual = load([]).controller.gains
    assert gains.angular_stiffness == (stiffness, 0.0, stiffness)
    assert gains.angular_damping == (damping, usual.angular_damping[1], damping)


@pytest.mark.parametrize(
    ("name", "climb"), [("decline", -np.sin(np.radians(6))), ("decline_unaligned", 0.0)]
)
def test_the_commanded_velocity_on_the_decline(name, climb):
    made, state, now, _ = at_a_state([f"behaviour={name}"])
    velocity = made.behaviour.desired(state, now).com_velocity
    assert velocity[2] == pytest.approx(climb)
    assert velocity @ velocity == pytest.approx(1.0)
