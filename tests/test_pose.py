"""Stable PD torques against the implicit formula, solved densely."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from rotctl.control.pose import PoseTracker
from rotctl.mechanics import model as models
from rotctl.mechanics.state import read

PERIOD = 1.0 / 60.0


@pytest.fixture(scope="module")
def gains(world):
    return replace(world.settings.gains, pose_stiffness=600.0, pose_damping=40.0)


@pytest.fixture(scope="module")
def tracker(world, gains):
    return PoseTracker(world.model, gains, PERIOD)


def dense_torques(world, state, gains, pose):
    """tau = Kp (pose - q - h qd) - Kd (qd + h qdd), qdd the answer to that same tau."""
    nv, h = world.mj.nv, PERIOD
    M = np.zeros((nv, nv))
    mujoco.mj_fullM(world.mj, state.data, M)
    inertia = np.diag(M)[6:] - world.mj.dof_armature[6:]
    Kp, Kd = gains.pose_stiffness * inertia, gains.pose_damping * inertia
    q, qd = state.position[7:], state.velocity[6:]
    # Unknowns [qdd (nv), tau (nu)]; M qdd - S' tau = -C ; h Kd qdd_joints + tau = known.
    nu = nv - 6
    system = np.zeros((nv + nu, nv + nu))
    system[:nv, :nv] = M
    system[6:nv, nv:] = -np.eye(nu)
    system[nv:, 6:nv] = h * np.diag(Kd)
    system[nv:, nv:] = np.eye(nu)
    C = state.data.qfrc_bias - state.data.qfrc_passive
    known = Kp * (pose - q - h * qd) - Kd * qd
    return np.linalg.solve(system, np.concatenate((-C, known)))[nv:]


def test_equals_the_implicit_formula(world, steps, tracker, gains):
    for step in steps[::8]:
        state = world.state(step)
        poses = np.array((step.desired.pose_a, step.desired.pose_b))
        found = tracker.torques(state, poses)
        for torque, pose in zip(found, poses, strict=True):
            expected = dense_torques(world, state, gains, pose)
            assert torque == pytest.approx(expected, abs=1e-8 * (1 + np.abs(expected).max()))


def test_linear_in_the_pose(world, steps, tracker):
    """The blend of eq. 7: the torque towards a blended pose is the blend of the torques."""
    for step in steps[::20]:
        a, b = step.desired.pose_a, step.desired.pose_b
        assert np.abs(a - b).max() > 0.1
        gamma = np.array([0.0, 0.25, 0.6, 1.0])[:, None]
        found = tracker.torques(world.state(step), gamma * a + (1 - gamma) * b)
        expected = gamma * found[3] + (1 - gamma) * found[0]
        assert np.abs(found - expected).max() < 1e-8 * (1 + np.abs(expected).max())


def test_no_gains_no_torque(world, steps):
    nothing = replace(world.settings.gains, pose_stiffness=0.0, pose_damping=0.0)
    tracker = PoseTracker(world.model, nothing, PERIOD)
    torque = tracker.torques(world.state(steps[9]), steps[9].desired.pose_a[None])
    assert not torque.any()


def test_state_is_left_alone_and_calls_are_independent(world, steps, tracker):
    state, other = world.state(steps[5]), world.state(steps[60])
    poses = steps[5].desired.pose_a[None]
    before = state.data.M.copy(), state.data.qLD.copy(), state.bias.copy()
    first = tracker.torques(state, poses)
    tracker.torques(other, poses)
    assert np.array_equal(tracker.torques(state, poses), first)
    assert all(
        np.array_equal(x, y)
        for x, y in zip(before, (state.data.M, state.data.qLD, state.bias), strict=True)
    )


@pytest.fixture(scope="module")
def floating(world):
    """The character without gravity, far from the ground, stepped at 60 Hz."""
    physics = replace(world.config.physics, gravity=(0.0, 0.0, 0.0), substeps=1)
    return models.build(world.config.character, world.config.terrain, physics, 60.0)


def hold(model, control, seconds=2.0):
    """Track r = 0.3 rad inside the ranges from rest; the largest error and speed at the end."""
    low, high = model.joint_range.T
    pose = np.clip(0.3, low + 0.1, high - 0.1)
    data = mujoco.MjData(model.mj)
    data.qpos[2] = 10.0
    fastest = 0.0
    for _ in range(round(seconds / PERIOD)):
        mujoco.mj_step1(model.mj, data)
        data.qfrc_applied[6:] = control(read(model, data), pose)  # not clipped to limits
        mujoco.mj_step2(model.mj, data)
        fastest = max(fastest, np.abs(data.qvel[6:]).max())
        if not fastest < 1e4:
            break
    return np.abs(data.qpos[7:] - pose).max(), fastest


def test_stable_at_60_hz_where_explicit_pd_is_not(floating, gains):
    tracker = PoseTracker(floating, gains, PERIOD)

    def explicit(state, pose):
        inertia = state.data.M[floating.diagonal[6:]] - floating.armature
        error = pose - state.position[7:]
        return inertia * (gains.pose_stiffness * error - gains.pose_damping * state.velocity[6:])

    error, fastest = hold(floating, lambda state, pose: tracker.torques(state, pose[None])[0])
    assert error < 0.02
    assert fastest < 20.0
    error, fastest = hold(floating, explicit)
    assert not fastest < 1e3
