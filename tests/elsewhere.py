"""An exported model in programs of others, beside MuJoCo: `make elsewhere`, which installs them."""

import os
from pathlib import Path

import mujoco
import numpy as np
import pytest

MODEL = Path(os.environ["ROTCTL_EXPORTED"])


@pytest.fixture(scope="module")
def ours():
    return mujoco.MjModel.from_xml_path(str(MODEL))


def hinges(ours):
    """Name -> range [rad], damping [N m s] and greatest torque [N m]."""
    torque = {
        int(ours.actuator_trnid[i, 0]): ours.actuator_gear[i, 0] * ours.actuator_ctrlrange[i, 1]
        for i in range(ours.nu)
    }
    return {
        ours.joint(j).name: (
            *ours.jnt_range[j],
            ours.dof_damping[ours.jnt_dofadr[j]].item(),
            torque[j],
        )
        for j in range(ours.njnt)
        if ours.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE
    }


@pytest.fixture(scope="module")
def pin():
    pinocchio = pytest.importorskip("pinocchio", reason="make elsewhere installs it")
    return pinocchio, pinocchio.buildModelFromMJCF(str(MODEL))


def places(ours, theirs):
    """Name of each hinge -> its velocity's index there: those of one body are one joint of many."""
    names = list(hinges(ours))
    found = {}
    for name, joint in list(zip(theirs.names, theirs.joints, strict=True))[2:]:  # world, root
        first = names.index(name.removeprefix("Composite_"))
        found |= {names[first + k]: joint.idx_v + k for k in range(joint.nv)}
    return found


def test_pinocchio_has_the_same_mass_limits_and_damping(ours, pin):
    pinocchio, theirs = pin
    assert theirs.nv == ours.nv
    mass = pinocchio.computeTotalMass(theirs)
    assert mass == pytest.approx(mujoco.mj_getTotalmass(ours))
    found, wanted = places(ours, theirs), hinges(ours)
    assert set(found) == set(wanted)
    for name, (low, high, damping, torque) in wanted.items():
        row = found[name]
        limits = theirs.lowerPositionLimit[row + 1], theirs.upperPositionLimit[row + 1]
        assert limits == pytest.approx((low, high)), name  # the root has a coordinate more
        assert theirs.damping[row] == pytest.approx(damping), name
        assert theirs.upperEffortLimit[row] == pytest.approx(torque), name


def test_pinocchio_has_the_same_inertia(ours, pin):
    pinocchio, theirs = pin
    data = mujoco.MjData(ours)
    mujoco.mj_forward(ours, data)
    full = np.zeros((ours.nv, ours.nv))
    mujoco.mj_fullM(ours, data, full)
    found = pinocchio.crba(theirs, theirs.createData(), pinocchio.neutral(theirs))
    found = np.triu(found) + np.triu(found, 1).T  # armature is in it
    there = places(ours, theirs)
    here = [int(ours.joint(name).dofadr[0]) for name in there]
    rows = list(there.values())
    assert found[np.ix_(rows, rows)] == pytest.approx(full[np.ix_(here, here)], rel=1e-4, abs=1e-6)


def test_gymnasium_steps_it(ours):
    import gymnasium

    env = gymnasium.make("Humanoid-v5", xml_file=str(MODEL.absolute()))
    env.reset(seed=0)
    theirs = env.unwrapped.model
    assert (theirs.nv, theirs.nu) == (ours.nv, ours.nu)
    for name in ("actuator_gear", "jnt_range", "dof_damping", "body_mass"):
        assert np.array_equal(getattr(theirs, name), getattr(ours, name)), name
    assert np.array_equal(env.action_space.high, ours.actuator_ctrlrange[:, 1].astype(np.float32))
    observed = env.step(env.action_space.sample())[0]
    assert np.isfinite(observed).all()
    env.close()
