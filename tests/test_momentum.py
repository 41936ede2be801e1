"""Momentum and composite inertia against sums over bodies, differences and conservation."""

import mujoco
import numpy as np
import pytest

from rotctl.mechanics.contacts import contact_jacobian, read_contacts, realised_forces
from rotctl.mechanics.momentum import contact_momentum_maps, read_momentum


@pytest.fixture(scope="module")
def readings(world, steps):
    """MuJoCo data of rolling and of random airborne states."""
    airborne = [world.in_the_air(seed, speed=3.0) for seed in range(10)]
    states = airborne + [(s.position, s.velocity) for s in steps[::12]]
    return [world.data(*state) for state in states]


def test_equals_a_sum_over_bodies(world, readings):
    for data in readings:
        momentum = read_momentum(world.mj, data)
        com, linear, angular, inertia = world.body_sums(world.mj, data)
        assert momentum.com == pytest.approx(com, abs=1e-12)
        assert momentum.linear == pytest.approx(linear, abs=1e-10)
        assert momentum.angular == pytest.approx(angular, abs=1e-10)
        assert np.abs(momentum.inertia - inertia).max() < 1e-11
        assert momentum.com_velocity == pytest.approx(linear / world.model.mass, abs=1e-12)
        assert inertia @ momentum.angular_velocity == pytest.approx(angular, abs=1e-10)


def test_momenta_are_those_of_a_moving_body(readings, world):
    """The states compared above are not trivial ones."""
    found = [read_momentum(world.mj, data) for data in readings]
    assert min(np.abs(m.angular).max() for m in found) > 0.1
    assert max(np.abs(m.inertia[0, 2]) for m in found) > 0.1


def test_root_frame_and_offset(world, readings):
    for data in readings:
        momentum = read_momentum(world.mj, data)
        assert momentum.root_rotation == pytest.approx(data.xmat[1].reshape(3, 3), abs=0)
        assert data.xpos[1] + momentum.root_offset == pytest.approx(momentum.com, abs=1e-12)


def test_reading_does_not_change_with_the_data(world):
    """A Momentum is a copy: stepping on does not change it."""
    data = world.data(*world.in_the_air(3))
    momentum = read_momentum(world.mj, data)
    before = {name: np.copy(value) for name, value in momentum._asdict().items()}
    mujoco.mj_step(world.mj, data, 50)
    assert all(np.array_equal(before[name], getattr(momentum, name)) for name in before)


def test_com_velocity_is_the_derivative_of_com(world):
    tiny = 1e-5
    for seed in range(5):
        position, velocity = world.in_the_air(seed)
        com = []
        for h in (-tiny, tiny):
            moved = position.copy()
            mujoco.mj_integratePos(world.mj, moved, velocity, h)
            com.append(read_momentum(world.mj, world.data(moved, velocity)).com)
        found = read_momentum(world.mj, world.data(position, velocity)).com_velocity
        assert found == pytest.approx((com[1] - com[0]) / (2 * tiny), abs=1e-8)


def test_conserved_in_free_flight(world):
    """With the limbs swinging, H and I_c omega stay, L changes by m g t, and I_c changes."""
    mj = world.model_copy(timestep=1e-4, integrator=mujoco.mjtIntegrator.mjINT_RK4)
    data = mujoco.MjData(mj)
    data.qpos[:], data.qvel[:] = world.in_the_air(4, speed=2.0)
    mujoco.mj_forward(mj, data)
    before, joints = read_momentum(mj, data), data.qpos[7:].copy()
    rng = np.random.default_rng(0)
    for _ in range(20):
        data.ctrl[:] = 0.2 * world.model.torque_limit * rng.normal(size=mj.nu)
        mujoco.mj_step(mj, data, 100)
    mujoco.mj_forward(mj, data)
    after = read_momentum(mj, data)
    gained = world.model.mass * world.model.gravity * data.time
    scale = np.abs(before.angular).max()
    assert scale > 5.0
    assert np.abs(data.qpos[7:] - joints).max() > 0.5
    assert np.abs(after.inertia - before.inertia).max() > 0.1
    assert np.abs(after.linear - before.linear - gained).max() < 1e-6
    assert np.abs(after.angular - before.angular).max() < 1e-6


def test_maps_carry_contact_forces_to_momentum_rates(world, supported):
    """The physics' own contact forces explain how fast its L and H change."""
    for step in supported[::10]:
        data = world.data(step.position, step.velocity)
        contacts = read_contacts(world.mj, data)
        momentum = read_momentum(world.mj, data)
        data.ctrl[:] = step.decision.torque
        mujoco.mj_forward(world.mj, data)
        force = realised_forces(world.mj, data, contacts)
        along_frame = np.einsum("mij,mj->mi", contacts.frame, force).ravel()
        maps = contact_momentum_maps(momentum, contact_jacobian(world.mj, data, contacts))
        predicted = maps @ along_frame
        predicted[:3] += world.model.mass * world.model.gravity
        measured = world.rates_by_difference(step.position, step.velocity, data.qacc)
        assert maps.shape == (6, 3 * contacts.count)
        assert predicted == pytest.approx(measured, abs=1e-3 * (1 + np.abs(measured).max()))


def test_maps_are_forces_and_their_moments(world, supported):
    """G is [sum f; sum (p - c) x f] for unit forces at the contact points."""
    for step in supported[::10]:
        state = world.state(step)
        contacts, com = state.contacts, state.momentum.com
        maps = contact_momentum_maps(
            state.momentum, contact_jacobian(world.mj, state.data, contacts)
        )
        directions = contacts.frame.reshape(-1, 3)
        arms = np.repeat(contacts.position - com, 3, axis=0)
        assert np.abs(maps[:3].T - directions).max() < 1e-12
        assert np.abs(maps[3:].T - np.cross(arms, directions)).max() < 1e-12


def test_maps_without_contacts(world):
    data = world.data(*world.in_the_air())
    contacts = read_contacts(world.mj, data)
    assert contact_momentum_maps(
        read_momentum(world.mj, data), contact_jacobian(world.mj, data, contacts)
    ).shape == (6, 0)
