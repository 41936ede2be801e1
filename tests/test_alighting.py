"""Limbs of a roll that goes aside come down on that side, and under a trunk that is not askew."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from rotctl.behaviours.rolling.alighting import Alighting, AlightingSettings
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.mechanics import state as states
from rotctl.runs.scenario import build

SETTINGS = AlightingSettings(
    limbs={"foot": ("hip_x", "hip_z"), "forearm": ("shoulder_x", "shoulder_z")},
    lead=0.1,
    sinking=1.0,
    reach=1e-6,  # a joint moves its limb all the way, however short it is
    most=10.0,
)
LEFT = np.array([0.0, 1.0, 0.0])


@pytest.fixture(scope="module")
def model():
    return build(load(["behaviour=forward_roll_1"])).known


def read(model, velocity, seed=3):
    """A tucked body, any way up, that moves as a whole (3,) [m/s]."""
    rng, data = np.random.default_rng(seed), mujoco.MjData(model.mj)
    data.qpos[2] = 2.0
    data.qpos[3:7] = rng.normal(size=4)
    data.qpos[3:7] /= np.linalg.norm(data.qpos[3:7])
    data.qpos[7:] = rng.uniform(0.3, 0.6, model.mj.nu) * model.joint_range[:, 1]
    data.qvel[:3] = velocity
    mujoco.mj_forward(model.mj, data)
    return states.read(model, data)


def brought(model, state, turns, limb):
    """How far to the left a limb comes, once its joints have turned by little [m]."""
    small, body = 1e-5, model.mj.body(limb).id
    before = state.data.xipos[body, 1]
    later = mujoco.MjData(model.mj)
    later.qpos[:] = state.position
    for motor, by in turns:
        later.qpos[7 + motor] += small * by
    mujoco.mj_forward(model.mj, later)
    return (later.xipos[body, 1] - before) / small


@pytest.mark.parametrize("limb", ["foot_l", "foot_r", "forearm_l", "forearm_r"])
@pytest.mark.parametrize("seed", range(4))
def test_a_limb_that_sinks_comes_as_far_aside_as_the_body_goes_meanwhile(model, limb, seed):
    state = read(model, [0.5, -0.7, -2.0], seed)
    turns = Alighting(SETTINGS, model).turns(state, LEFT, LEFT)
    assert brought(model, state, turns, limb) == pytest.approx(0.1 * -0.7, rel=1e-3)


@pytest.mark.parametrize("limb", ["foot_l", "forearm_r"])
def test_and_to_where_it_would_be_if_the_trunk_were_not_askew(model, limb):
    state, axis = read(model, [0.0, 0.0, -2.0]), np.array([0.3, 0.9, -0.3])
    axis /= np.linalg.norm(axis)
    from_com = state.data.xipos[model.mj.body(limb).id] - state.momentum.com
    turns = Alighting(SETTINGS, model).turns(state, axis, LEFT)
    aside = from_com @ axis - from_com @ LEFT  # to the trunk's left less to the way's
    assert brought(model, state, turns, limb) == pytest.approx(aside, rel=1e-3)


@pytest.mark.parametrize(("sinks", "share"), [(-1.0, 0.0), (0.0, 0.0), (0.25, 0.25), (3.0, 1.0)])
def test_what_does_not_sink_stays_and_what_sinks_slowly_goes_by_its_share(model, sinks, share):
    whole, part = (
        Alighting(SETTINGS, model).turns(read(model, [0.0, 0.4, -speed]), LEFT, LEFT)
        for speed in (1.0, sinks)
    )
    assert [by for _, by in part] == pytest.approx([share * by for _, by in whole], abs=1e-9)


def test_no_joint_goes_further_than_told_or_out_of_its_range(model):
    laws, state = Alighting(replace(SETTINGS, most=0.3), model), read(model, [0.0, 5.0, -2.0])
    turns = laws.turns(state, LEFT, LEFT)
    assert max(abs(by) for _, by in turns) == 0.3
    low, high = model.joint_range.T
    for pose in (low.copy(), high.copy()):
        moved = laws.moved(pose, turns)
        assert ((moved >= low) & (moved <= high)).all()
    beyond = high + 0.1  # a pose that is there already is left there
    assert (laws.moved(beyond, turns) <= beyond).all()


def test_what_cannot_alight_is_refused():
    with pytest.raises(
        InputError,
        match="lies on its side, and no limb comes down beside it: give behaviour.alighting=null",
    ):
        load(["behaviour=sideways_roll", *ASKED])
    for limbs, said in {
        "{foot:[waist_y]}": "foot: waist_y is of no limb on either side",
        "{foot:[hip]}": "names the unknown joint 'hip'",
        "{paw:[hip_x]}": "names the unknown body 'paw'",
        "{foot_l:[hip_x]}": "foot_l is one body; name a limb that both sides have",
        "{foot:[hip_x,shoulder_x]}": "foot: shoulder_x_l does not move it",
    }.items():
        with pytest.raises(InputError, match=said):
            build(load([f"+behaviour.alighting.limbs={limbs}"]))


ASKED = [
    "+behaviour.alighting={limbs:{foot:[hip_x]},lead:0.1,sinking:1.0,reach:0.1,most:0.6}",
]
