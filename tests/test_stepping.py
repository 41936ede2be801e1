"""Advancing the physics, and noticing when it can no longer be trusted."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from rotctl.mechanics import compilation
from rotctl.mechanics.contacts import read_contacts
from rotctl.simulation import stepping
from rotctl.simulation.stepping import MujocoStepper


@pytest.fixture(params=[1, 4])
def substeps(request):
    return request.param


@pytest.fixture
def model(world, substeps):
    physics = replace(world.config.physics, substeps=substeps)
    return compilation.build(world.config.character, world.config.terrain, physics, 60.0)


def fresh(model, step):
    data = mujoco.MjData(model.mj)
    data.qpos[:], data.qvel[:] = step.position, step.velocity
    return data


def one_period(model, stepper, data, torque):
    stepper.evaluate(data)
    contacts = read_contacts(model.mj, data)
    return stepper.advance(data, torque, contacts)


def test_a_period_is_a_sixtieth(model, substeps, supported):
    stepper, data = MujocoStepper(model, substeps), fresh(model, supported[0])
    assert model.mj.opt.timestep == pytest.approx(1 / 60 / substeps, rel=1e-12)
    for i in range(1, 4):
        one_period(model, stepper, data, supported[0].decision.torque)
        assert data.time == pytest.approx(i / 60, abs=1e-12)


def test_equals_mj_step_bit_for_bit(model, substeps, supported):
    """The two halves of a step around the controller are MuJoCo's own step."""
    for step in supported[::40]:
        stepper, data, plain = (
            MujocoStepper(model, substeps),
            fresh(model, step),
            fresh(model, step),
        )
        for _ in range(3):
            one_period(model, stepper, data, step.decision.torque)
            plain.ctrl[:] = step.decision.torque
            for _ in range(substeps):
                mujoco.mj_step(model.mj, plain)
        for name in ("qpos", "qvel", "qacc", "ctrl", "qacc_warmstart"):
            assert getattr(data, name).tobytes() == getattr(plain, name).tobytes()
        assert stepper.complaint(data) == ""


def test_the_torque_is_held(model, substeps, supported):
    """A different torque gives a different motion: ctrl reaches the very first substep."""
    step, ends = supported[0], []
    for scale in (0.0, 1.0):
        stepper, data = MujocoStepper(model, substeps), fresh(model, step)
        one_period(model, stepper, data, scale * step.decision.torque)
        ends.append(data.qvel.copy())
        assert data.ctrl == pytest.approx(scale * step.decision.torque, abs=0)
    assert np.abs(ends[1] - ends[0]).max() > 0.1


def test_forces_are_means_over_the_substeps(model, substeps, supported):
    """As MuJoCo itself reads them, body by body, from steps that it makes alone."""
    for step in supported[::20]:
        stepper, data, plain = (
            MujocoStepper(model, substeps),
            fresh(model, step),
            fresh(model, step),
        )
        found = one_period(model, stepper, data, step.decision.torque)
        plain.ctrl[:] = step.decision.torque
        each, deepest = np.zeros((substeps, model.mj.nbody, 3)), 0.0
        for k in range(substeps):
            mujoco.mj_step(model.mj, plain)
            for i, contact in enumerate(plain.contact):
                bodies = model.mj.geom_bodyid[contact.geom]
                if (bodies == 0).any():
                    local = np.empty(6)
                    mujoco.mj_contactForce(model.mj, plain, i, local)
                    each[k, bodies.max()] += contact.frame.reshape(3, 3).T @ local[:3]
                    deepest = max(deepest, -contact.dist)
        for body, mean in enumerate(each.mean(axis=0)):
            assert found.mean[found.body == body].sum(axis=0) == pytest.approx(mean, abs=1e-8)
        assert found.total == pytest.approx(each.mean(axis=0).sum(axis=0), abs=1e-8)
        largest = np.sqrt((each.sum(axis=1) ** 2).sum(axis=1)).max()
        assert found.total_peak == pytest.approx(largest, abs=1e-8)
        assert found.penetration == deepest > 0.0


def test_no_complaint_at_the_start(model, substeps, supported):
    stepper, data = MujocoStepper(model, substeps), fresh(model, supported[0])
    stepper.evaluate(data)
    assert stepper.complaint(data) == ""


@pytest.mark.parametrize("bad", [np.nan, np.inf])
@pytest.mark.parametrize("name", ["qpos", "qvel"])
def test_a_state_that_is_not_finite(model, substeps, supported, name, bad):
    stepper, data = MujocoStepper(model, substeps), fresh(model, supported[0])
    getattr(data, name)[8] = bad
    stepper.evaluate(data)
    kind = "position" if name == "qpos" else "velocity"
    assert stepper.complaint(data) == f"MuJoCo warns: {kind} not finite or too large"


@pytest.mark.filterwarnings("ignore:invalid value")
def test_a_state_that_mujoco_has_not_looked_at(model, substeps, supported):
    stepper, data = MujocoStepper(model, substeps), fresh(model, supported[0])
    data.qvel[8] = np.nan
    assert stepper.complaint(data) == "the state is not finite"
    data.qvel[8], data.qvel[9] = np.inf, -np.inf
    assert stepper.complaint(data) == "the state is not finite"


def test_a_control_that_is_not_finite(model, substeps, supported):
    stepper, data = MujocoStepper(model, substeps), fresh(model, supported[0])
    one_period(model, stepper, data, np.full(model.mj.nu, np.nan))
    assert stepper.complaint(data) == "MuJoCo warns: control not finite"


def test_a_blow_up_is_noticed_and_kept(model, substeps, supported):
    """Nothing is reset in silence: the state that went wrong is still there to see."""
    stepper, data = MujocoStepper(model, substeps), fresh(model, supported[0])
    data.qvel[3:6] = 1e9
    one_period(model, stepper, data, np.zeros(model.mj.nu))
    stepper.evaluate(data)
    assert stepper.complaint(data).startswith("MuJoCo warns: ")
    assert np.abs(data.qvel).max() > 1e6 or not np.isfinite(data.qvel).all()


def test_a_clock_that_was_reset(model, substeps, supported):
    stepper, data = MujocoStepper(model, substeps), fresh(model, supported[0])
    one_period(model, stepper, data, np.zeros(model.mj.nu))
    assert stepper.complaint(data) == ""
    mujoco.mj_resetData(model.mj, data)
    assert stepper.complaint(data) == "MuJoCo reset the simulation"


def test_every_warning_has_words():
    kinds = {w for w in mujoco.mjtWarning.__members__.values() if w != mujoco.mjtWarning.mjNWARNING}
    assert set(stepping.WARNINGS) == kinds


@pytest.mark.parametrize("kind", list(stepping.WARNINGS))
def test_each_warning_is_a_complaint(world, kind):
    data = mujoco.MjData(world.mj)
    data.warning[int(kind)].number = 1
    assert MujocoStepper(world.model, 4).complaint(data) == (
        f"MuJoCo warns: {stepping.WARNINGS[kind]}"
    )
