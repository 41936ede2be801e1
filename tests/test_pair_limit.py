"""No pair of geoms comes near the contacts that the engine keeps; the bound against brute force."""

import copy
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.log import RunLog
from rotctl.mechanics import pair_limit
from rotctl.mechanics.contacts import read_contacts
from rotctl.mechanics.pair_limit import LIMIT, check, crowded, triangles
from rotctl.mechanics.terrain import uneven
from rotctl.runs.run import LOG_NAME, run
from rotctl.runs.scenario import build
from rotctl.simulation.lockstep import LockstepStepper
from rotctl.simulation.stepping import MujocoStepper

LYING = """
<mujoco>
  <asset><hfield name="level" nrow="{n}" ncol="{n}" size="2 2 1 1" elevation="{heights}"/></asset>
  <worldbody>
    <geom name="ground" type="hfield" hfield="level" margin="{margin}"/>
    <body name="log"><freejoint/>
      <geom name="log" type="capsule" size="0.1 {half}" euler="90 0 0" margin="{margin}"/></body>
  </worldbody>
</mujoco>
"""


def lying(cell, length, margin):
    """A capsule on a level field, whose cells are so large [m]."""
    n = round(4.0 / cell) + 1
    heights = " ".join(["0"] * (n * n - 1) + ["0.000001"])
    return mujoco.MjModel.from_xml_string(
        LYING.format(n=n, heights=heights, half=0.5 * length, margin=0.5 * margin)
    )


@pytest.mark.parametrize(("cell", "length"), [(0.1, 0.0), (0.15, 0.2), (0.2, 0.8), (0.25, 1.2)])
def test_no_lie_of_a_capsule_makes_more_contacts_than_the_bound(cell, length):
    """Against the engine: random places and turns, deep and within the margin."""
    bound = triangles(length, 0.1 + 0.04, cell)
    mj, rng, most = lying(cell, max(length, 1e-3), 0.04), np.random.default_rng(0), 0
    data = mujoco.MjData(mj)
    for turn in rng.uniform(0.0, np.pi, 300):
        data.qpos[:3] = *rng.uniform(-0.5, 0.5, 2), rng.uniform(0.0, 0.13)
        data.qpos[3:] = np.cos(0.5 * turn), 0.0, 0.0, np.sin(0.5 * turn)
        mujoco.mj_forward(mj, data)
        most = max(most, data.ncon)
    assert 0.4 * bound < most <= bound


@pytest.mark.parametrize("terrain", ["uneven", "bumps"])
@pytest.mark.parametrize("physics", ["mujoco", "lockstep"])
def test_the_adult_stays_below_the_limit_on_every_heightfield(terrain, physics):
    mj = build(load([f"terrain={terrain}", f"physics={physics}"])).model.mj
    check(mj, "adult", terrain)
    giant = copy.copy(mj)
    giant.geom_size[:] *= 2.0
    with pytest.raises(InputError):
        check(giant, "adult", terrain)


def test_what_could_come_near_it_is_refused_in_one_line():
    with pytest.raises(InputError) as error:
        build(load(["character=adult", "terrain=uneven", "physics=lockstep", "physics.margin=0.1"]))
    assert str(error.value) == (
        "character 'adult' on terrain 'uneven': pelvis (0.2 m long, reach 0.21 m) could make 51 "
        "contacts with cells of 0.15 m, MuJoCo keeps 50 of a pair; choose another terrain, "
        "smaller geoms or a smaller physics.margin"
    )
    build(load(["terrain=stairs_down", "physics=lockstep", "physics.margin=0.1"]))


def test_a_full_pair_is_named():
    """Cells of 4 cm under a capsule of 80 cm; on larger ones nothing is said."""
    mj = lying(0.04, 0.8, 0.04)
    data = mujoco.MjData(mj)
    data.qpos[2] = 0.095
    mujoco.mj_forward(mj, data)
    assert data.ncon == LIMIT
    assert crowded(mj, data) == "ground with log: 50 contacts, all that MuJoCo keeps of a pair"
    mj = lying(0.2, 0.8, 0.04)
    data = mujoco.MjData(mj)
    data.qpos[2] = 0.095
    mujoco.mj_forward(mj, data)
    assert 0 < data.ncon < LIMIT
    assert crowded(mj, data) == ""


@pytest.mark.parametrize("physics", ["mujoco", "lockstep"])
def test_every_physics_step_of_a_control_step_is_looked_at(physics):
    """A log in the air at the begin of the control step, that lies on a fine field in its midst."""
    scenario = build(load([f"physics={physics}", "physics.substeps=8", "controller.rate=10"]))
    mj = lying(0.04, 0.8, 0.04)
    mj.opt.timestep = 0.0125
    fine = SimpleNamespace(mj=mj)
    settings = scenario.config.physics
    stepper = LockstepStepper(fine, settings) if physics == "lockstep" else MujocoStepper(fine, 8)
    data = mujoco.MjData(mj)
    data.qpos[2], data.qvel[2] = 0.3, -4.0
    stepper.evaluate(data)
    assert data.ncon == 0
    none = read_contacts(mj, data)
    stepper.advance(data, np.zeros(0), none)
    assert stepper.remark().startswith("ground with log: 50 contacts, all that MuJoCo keeps")
    data.qpos[2], data.qvel[2] = 9.0, 0.0
    stepper.evaluate(data)
    stepper.advance(data, np.zeros(0), none)
    assert stepper.remark() == ""


def test_the_log_tells_of_a_full_pair(tmp_path, monkeypatch):
    """On cells that would be refused, a few steps of a roll."""
    for name, value in {"LENGTH": 12.0, "CELL": 0.03, "COLUMNS": 401, "ROWS": 401}.items():
        monkeypatch.setattr(uneven, name, value)
    monkeypatch.setattr(pair_limit, "check", lambda *parts: None)
    config = load(["terrain=uneven", "terrain.name=fine", "physics=lockstep", "duration=0.1"])
    log = RunLog.open(run(config, tmp_path).folder / LOG_NAME)
    told = [text for _, text in log.events if "all that MuJoCo keeps of a pair" in text]
    assert told
    assert "with ground_0: 50 contacts" in told[0] or "ground_0 with" in told[0]
