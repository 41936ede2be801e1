"""Contact rows and forces against mj_jac and mj_contactForce, for both friction cones."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from rotctl.mechanics.contacts import contact_jacobian, read_contacts, realised_forces
from rotctl.simulation.placing import place
from rotctl.simulation.start import Start

CONES = {
    "elliptic": mujoco.mjtCone.mjCONE_ELLIPTIC,
    "pyramidal": mujoco.mjtCone.mjCONE_PYRAMIDAL,
}
BOX_GROUND = """
<mujoco>
  <option cone="{cone}" jacobian="dense"/>
  <worldbody>
    <geom name="ground" type="box" size="5 5 0.5" pos="0 0 -0.5" euler="0 {tilt} 0"
          friction="0.7"/>
    <body name="log" pos="0 0 0.5">
      <freejoint/>
      <geom type="capsule" size="0.1 0.4" euler="90 30 0" mass="3" friction="0.7" condim="3"/>
    </body>
  </worldbody>
</mujoco>
"""


@pytest.fixture(scope="module", params=CONES)
def cone(request, world):
    """The character's model with that friction cone, and friction that differs by axis."""
    return world.model_copy(cone=CONES[request.param], impratio=2.0)


def ground_contacts(mj, data):
    """Indices into data.contact of contacts with the world."""
    bodies = mj.geom_bodyid[data.contact.geom]
    return np.flatnonzero((bodies == 0).any(axis=1))


def rows_from_mj_jac(mj, data, contacts):
    rows = []
    for body, point, frame in zip(contacts.body, contacts.position, contacts.frame, strict=True):
        jacobian = np.zeros((3, mj.nv))
        mujoco.mj_jac(mj, data, jacobian, None, point, int(body))
        rows.append(frame @ jacobian)
    return np.concatenate(rows)


def test_rows_are_velocities_along_the_frame(cone, world, supported):
    for step in supported[::5]:
        data = world.data(step.position, step.velocity, cone)
        contacts = read_contacts(cone, data)
        expected = rows_from_mj_jac(cone, data, contacts)
        assert contacts.count == len(ground_contacts(cone, data)) >= 2
        found = contact_jacobian(cone, data, contacts)
        assert found.shape == (3 * contacts.count, cone.nv)
        assert np.abs(found - expected).max() < 1e-11


def test_frames_are_right_handed_and_point_out_of_the_ground(cone, world, supported):
    for step in supported[::5]:
        contacts = read_contacts(cone, world.data(step.position, step.velocity, cone))
        for frame in contacts.frame:
            assert frame[0] == pytest.approx([0.0, 0.0, 1.0], abs=1e-12)
            assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12)
            assert np.linalg.det(frame) == pytest.approx(1.0, abs=1e-12)


def test_realised_forces(cone, world, supported):
    """World forces equal MuJoCo's own contact forces, rotated; some friction is at work."""
    sliding = 0.0
    for step in supported[::5]:
        data = world.data(step.position, step.velocity, cone)
        contacts = read_contacts(cone, data)
        data.ctrl[:] = step.decision.torque
        mujoco.mj_forward(cone, data)
        found = realised_forces(cone, data, contacts)
        for i, force in zip(ground_contacts(cone, data), found, strict=True):
            local = np.empty(6)
            mujoco.mj_contactForce(cone, data, i, local)
            expected = data.contact[i].frame.reshape(3, 3).T @ local[:3]
            assert force == pytest.approx(expected, abs=1e-8 * (1 + np.abs(expected).max()))
            sliding = max(sliding, np.abs(force[:2]).max())
        assert (found[:, 2] >= 0).all()
    assert sliding > 10.0


def test_realised_forces_accelerate_the_centre_of_mass(cone, world, supported):
    """Joint limits and self contacts are internal: the ground's forces and gravity are all."""
    for step in supported[::10]:
        data = world.data(step.position, step.velocity, cone)
        contacts = read_contacts(cone, data)
        data.ctrl[:] = step.decision.torque
        mujoco.mj_forward(cone, data)
        total = realised_forces(cone, data, contacts).sum(axis=0)
        measured = world.rates_by_difference(step.position, step.velocity, data.qacc)[:3]
        gravity = world.model.mass * world.model.gravity
        assert total + gravity == pytest.approx(measured, abs=1e-3 * (1 + np.abs(total).max()))


@pytest.mark.parametrize("cone_name", CONES)
@pytest.mark.parametrize("tilt", [0, 20])
def test_ground_as_second_geom(cone_name, tilt):
    """A capsule comes before a box, so MuJoCo's frame points into this ground."""
    mj = mujoco.MjModel.from_xml_string(BOX_GROUND.format(cone=cone_name, tilt=tilt))
    data = mujoco.MjData(mj)
    data.qvel[:] = [0.1, 0.2, -0.3, 0.4, 0.5, 0.6]
    for _ in range(500):
        mujoco.mj_step(mj, data)
        if data.ncon:
            break
    mujoco.mj_step1(mj, data)
    contacts = read_contacts(mj, data)
    assert contacts.count >= 1
    assert mj.geom(int(data.contact[0].geom1)).type == mujoco.mjtGeom.mjGEOM_CAPSULE
    expected = rows_from_mj_jac(mj, data, contacts)
    assert np.abs(contact_jacobian(mj, data, contacts) - expected).max() < 1e-12
    normal = [np.sin(np.radians(tilt)), 0.0, np.cos(np.radians(tilt))]
    assert contacts.frame[:, 0] == pytest.approx(np.tile(normal, (contacts.count, 1)), abs=1e-9)
    mujoco.mj_forward(mj, data)
    total = realised_forces(mj, data, contacts).sum(axis=0)
    weight = mj.body_mass[1] * mj.opt.gravity
    assert mj.body_mass[1] * data.qacc[:3] == pytest.approx(total + weight, abs=1e-6)
    assert total @ normal > 1.0


def test_self_contacts_are_left_out(world):
    """Thighs pressed together high above the ground: MuJoCo sees contacts, we see none."""
    position = np.zeros(world.mj.nq)
    position[:7] = [0, 0, 10, 1, 0, 0, 0]
    for side in ("l", "r"):
        position[world.mj.joint(f"hip_x_{side}").qposadr[0]] = -0.5
    data = world.data(position, np.zeros(world.mj.nv))
    contacts = read_contacts(world.mj, data)
    assert data.ncon > 0
    assert contacts.count == 0
    assert contact_jacobian(world.mj, data, contacts).shape == (0, world.mj.nv)
    mujoco.mj_forward(world.mj, data)
    assert realised_forces(world.mj, data, contacts).shape == (0, 3)


def test_self_contacts_beside_ground_contacts(cone, world):
    """Rows are picked by address: self contacts and joint limits do not shift them."""
    pose = np.zeros(cone.nu)
    for name, angle in {"hip_x": -0.5, "hip_y": 1.2, "elbow": 2.6}.items():
        for side in ("_l", "_r"):
            pose[world.model.joint_names.index(name + side)] = angle
    data = mujoco.MjData(cone)
    start = Start(pitch=-1.0, velocity=np.zeros(3), angular_velocity=np.zeros(3))
    behaviour = world.scenario.behaviour
    usual = replace(behaviour.start(start.pitch), pose=pose)
    place(replace(world.model, mj=cone), data, start, usual, behaviour.axes)
    data.qpos[2] -= 0.02
    mujoco.mj_step1(cone, data)
    contacts = read_contacts(cone, data)
    assert (data.efc_type == mujoco.mjtConstraint.mjCNSTR_LIMIT_JOINT).sum() >= 2
    assert data.ncon > contacts.count > 0
    expected = rows_from_mj_jac(cone, data, contacts)
    assert np.abs(contact_jacobian(cone, data, contacts) - expected).max() < 1e-11


def test_friction_is_the_ground_s(world, supported):
    state = world.state(supported[0])
    assert (state.contacts.friction == world.config.terrain.friction).all()
