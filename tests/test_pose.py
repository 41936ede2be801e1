"""Stable PD torques against the implicit formula, solved densely."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from rotctl.control.pose import PoseTracker
from rotctl.mechanics import compilation
from rotctl.mechanics.state import read

PERIOD = 1.0 / 60.0


@pytest.fixture(scope="module")
def gains(world):
    return replace(world.settings.pose, stiffness=600.0, damping=40.0, horizon=0.0)


@pytest.fixture(scope="module")
def tracker(world):
    return PoseTracker(world.model, PERIOD)


def dense_torques(world, state, gains, pose, h=PERIOD):
    """tau = Kp (pose - q - h qd) - Kd (qd + h qdd), qdd the answer to that same tau."""
    nv = world.mj.nv
    M = np.zeros((nv, nv))
    mujoco.mj_fullM(world.mj, state.data, M)
    inertia = np.diag(M)[6:] - world.mj.dof_armature[6:]
    Kp, Kd = gains.stiffness * inertia, gains.damping * inertia
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


@pytest.mark.parametrize(
    ("horizon", "ahead"), [(0.0, PERIOD), (0.5 * PERIOD, PERIOD), (3.0 * PERIOD, 3.0 * PERIOD)]
)
def test_equals_the_implicit_formula(world, steps, tracker, gains, horizon, ahead):
    """At the end of the horizon, but never nearer than the end of the control period."""
    for step in steps[::8]:
        state = world.state(step)
        poses = np.array((step.command.pose_a, step.command.pose_b))
        found = tracker.torques(state, poses, replace(gains, horizon=horizon))
        for torque, pose in zip(found, poses, strict=True):
            expected = dense_torques(world, state, gains, pose, ahead)
            assert torque == pytest.approx(expected, abs=1e-8 * (1 + np.abs(expected).max()))


def test_explicit_is_eq_6_as_printed(world, steps, tracker, gains):
    for step in steps[::20]:
        state, pose = world.state(step), step.command.pose_a
        M = np.zeros((world.mj.nv, world.mj.nv))
        mujoco.mj_fullM(world.mj, state.data, M)
        inertia = np.diag(M)[6:] - world.mj.dof_armature[6:]
        spring = gains.stiffness * (pose - state.position[7:])
        expected = inertia * (spring - gains.damping * state.velocity[6:])
        found = tracker.torques(state, pose[None], replace(gains, explicit=True, horizon=0.1))
        assert found[0] == pytest.approx(expected, rel=1e-12, abs=1e-9)


def test_linear_in_the_pose(world, steps, tracker, gains):
    """The blend of eq. 7: the torque towards a blended pose is the blend of the torques."""
    for step in steps[::20]:
        a, b = step.command.pose_a, step.command.pose_b
        assert np.abs(a - b).max() > 0.1
        gamma = np.array([0.0, 0.25, 0.6, 1.0])[:, None]
        found = tracker.torques(world.state(step), gamma * a + (1 - gamma) * b, gains)
        expected = gamma * found[3] + (1 - gamma) * found[0]
        assert np.abs(found - expected).max() < 1e-8 * (1 + np.abs(expected).max())


def test_no_gains_no_torque(world, steps, tracker, gains):
    nothing = replace(gains, stiffness=0.0, damping=0.0)
    torque = tracker.torques(world.state(steps[9]), steps[9].command.pose_a[None], nothing)
    assert not torque.any()


def test_state_is_left_alone_and_calls_are_independent(world, steps, tracker, gains):
    state, other = world.state(steps[5]), world.state(steps[60])
    poses = steps[5].command.pose_a[None]
    before = state.data.M.copy(), state.data.qLD.copy(), state.bias.copy()
    first = tracker.torques(state, poses, gains)
    tracker.torques(other, poses, gains)
    assert np.array_equal(tracker.torques(state, poses, gains), first)
    assert all(
        np.array_equal(x, y)
        for x, y in zip(before, (state.data.M, state.data.qLD, state.bias), strict=True)
    )


@pytest.fixture(scope="module")
def floating(world):
    """The character without gravity, far from the ground, stepped at 60 Hz."""
    physics = replace(world.config.physics, gravity=(0.0, 0.0, 0.0), substeps=1)
    return compilation.build(world.config.character, world.config.terrain, physics, 60.0)


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
    tracker = PoseTracker(floating, PERIOD)

    def explicit(state, pose):
        inertia = state.data.M[floating.diagonal[6:]] - floating.armature
        error = pose - state.position[7:]
        return inertia * (gains.stiffness * error - gains.damping * state.velocity[6:])

    def stable(state, pose):
        return tracker.torques(state, pose[None], gains)[0]

    error, fastest = hold(floating, stable)
    assert error < 0.02
    assert fastest < 20.0
    error, fastest = hold(floating, explicit)
    assert not fastest < 1e3
