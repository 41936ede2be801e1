"""Flesh: how deep a weight sinks, and how hard a blow is, by MuJoCo's law of soft contacts."""

import mujoco
import pytest

from rotctl.mechanics.flesh import Flesh, add_flesh
from rotctl.mechanics.terrain.ground import add_geom

SOLREF = (0.02, 1.0)
RIGID, DEPTH, ONSET = 0.95, 0.03, 0.2
MASS = 35.0  # [kg] what a seat has above it


def sphere_on_the_ground(flesh):
    """A ball of 10 cm and `MASS` that can only rise and sink, touching the ground."""
    spec = mujoco.MjSpec()
    spec.option.timestep, spec.option.cone = 0.001, mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.default.geom.solref, spec.default.geom.solimp = SOLREF, (0.9, RIGID, 0.001, 0.5, 2.0)
    ball = spec.worldbody.add_body(name="ball", pos=[0, 0, 0.1])
    ball.add_joint(name="up", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0, 0, 1])
    sphere = mujoco.mjtGeom.mjGEOM_SPHERE
    ball.add_geom(type=sphere, size=[0.1, 0, 0], mass=MASS, friction=[0, 0, 0])
    if flesh:
        add_flesh(spec, flesh)
    add_geom(spec, "ground", 0.7, type=mujoco.mjtGeom.mjGEOM_PLANE, size=[1, 1, 1], material="")
    return spec.compile()


def sunk_under(mj, force):
    """How deep [m] it comes to rest when pressed down with `force` [N] beside its weight."""
    data = mujoco.MjData(mj)
    data.qfrc_applied[0] = -force
    mujoco.mj_step(mj, data, 4000)
    assert abs(data.qvel[0]) < 1e-6
    return -data.qpos[0], data


@pytest.mark.parametrize("force", [0.0, 300.0, 900.0, 3000.0])
def test_the_force_grows_with_the_depth(force):
    """At rest (1 - d) F = m d k r, d and k the impedance and stiffness at depth r."""
    depth, data = sunk_under(sphere_on_the_ground(Flesh(("ball",), DEPTH, ONSET)), force)
    impedance = ONSET + (RIGID - ONSET) * min(depth / DEPTH, 1.0)
    stiffness = impedance / (RIGID * SOLREF[0] * SOLREF[1]) ** 2
    held = MASS * stiffness * depth * impedance / (1.0 - impedance)
    assert held == pytest.approx(MASS * 9.81 + force, rel=1e-3)
    assert data.contact.friction[0, :2] == pytest.approx(0.7)  # the ground's alone
    bare, _ = sunk_under(sphere_on_the_ground(None), force)
    assert bare < 0.3 * depth


def test_a_seat_is_no_softer_than_a_measured_one():
    """Young adults' hips have 25 to 36 kN/m at some 900 N (Choi et al., J. Biomech. 162, 2023)."""
    depth, _ = sunk_under(sphere_on_the_ground(Flesh(("ball",), DEPTH, ONSET)), 900.0 - 9.81 * MASS)
    assert 36e3 < 900.0 / depth < 100e3


def hardest(mj, speed):
    """The largest force [N] of a ball that comes down at `speed` [m/s]."""
    data = mujoco.MjData(mj)
    data.qvel[0] = -speed
    forces = []
    for _ in range(200):
        mujoco.mj_step(mj, data)
        forces.append(data.qfrc_constraint[0])
    return max(forces)


def test_a_blow_is_not_hardest_at_the_first_touch():
    soft, bare = (sphere_on_the_ground(it) for it in (Flesh(("ball",), DEPTH, ONSET), None))
    assert hardest(soft, 1.0) < 0.6 * hardest(bare, 1.0)
