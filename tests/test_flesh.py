"""Flesh: soft at its surface, firm in its depth, on ground that keeps its friction."""

from itertools import islice

import mujoco
import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build, model_of
from rotctl.simulation.episode import Episode

ONSET, DEPTH = 0.2, 0.03  # of conf/character/adult_free_head.yaml
FIRM = 0.95  # of conf/physics/mujoco.yaml
SOFT = {"pelvis", "waist", "chest", "thigh_l", "thigh_r"}
IMPEDANCE = 2  # of the columns of MuJoCo's efc_KBIP


def of_the_ground(scenario, steps=90):
    """Name of the body, contact and impedance of every contact with ground or boxes."""
    model = scenario.model.mj
    for moment in islice(Episode(scenario), steps):
        data = moment.truth.data
        for contact in data.contact:
            first, second = (model.geom_bodyid[geom] for geom in contact.geom)
            if contact.efc_address < 0 or (model.body_rootid[second] == 1) == (
                model.body_rootid[first] == 1
            ):
                continue
            body = second if model.body_rootid[second] == 1 else first
            yield model.body(body).name, contact, data.efc_KBIP[contact.efc_address, IMPEDANCE]


@pytest.mark.parametrize(
    ("overrides", "friction", "size"),
    [
        ((), {1.0}, 1.0),
        (("terrain.friction=0.3", "character.height=1.2"), {0.3}, 1.2 / 1.75),
        (("physics=mat",), {1.0}, 1.0),
        (("behaviour=hazards", "terrain.run_in=0.5", "terrain.friction=0.6"), {0.6}, 1.0),
        (("disturbance=slippery", "disturbance.time=0.7"), {1.0, 0.5}, 1.0),
    ],
)
def test_a_contact_is_as_firm_as_flesh_is_pressed_together_and_as_rough_as_the_ground(
    overrides, friction, size
):
    scenario = build(load([*overrides, "duration=2"]))
    met, rough = set(), set()
    for name, contact, impedance in of_the_ground(scenario):
        rough.add(round(float(contact.friction[0]), 9))
        share = min(-contact.dist / (DEPTH * size), 1.0)
        if name in SOFT:
            met.add(name)
            assert impedance == pytest.approx(ONSET + (FIRM - ONSET) * share, abs=1e-5)
        else:
            assert impedance >= 0.9
        assert contact.solref[0] == scenario.config.physics.contact_solref[0]
    assert met
    assert rough == friction


def test_bodies_that_touch_each_other_are_as_firm_as_without():
    fleshed, bare = (load(["duration=1", *more]) for more in ((), ("character.flesh=null",)))
    one, other = (model_of(config).mj for config in (fleshed, bare))
    assert one.npair > 0
    for name in ("pair_solimp", "pair_solref", "pair_friction"):
        assert np.array_equal(getattr(one, name), getattr(other, name))


def test_an_exported_model_has_it():
    ours = model_of(load(["duration=1"]))
    theirs = mujoco.MjModel.from_xml_string(ours.mjcf)
    for geom in range(ours.mj.ngeom):
        one, other = ours.mj.geom(geom), theirs.geom(ours.mj.geom(geom).name)
        for what in ("solimp", "friction", "solmix"):
            assert np.array_equal(getattr(one, what), getattr(other, what))


def test_in_lockstep_contacts_are_hard():
    one, other = (
        in_memory(build(load(["physics=lockstep", "duration=1", *more])))[0].trajectory.qpos
        for more in ((), ("character.flesh=null",))
    )
    assert np.array_equal(one, other)


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (("character.flesh.bodies=[thig]",),
         "character.flesh.bodies: no body 'thig'; did you mean thigh? valid: pelvis, waist, "),
        (("character.flesh.bodies=[chest,waist,chest]",),
         "character.flesh.bodies: names chest twice"),
        (("character.flesh.depth=0.08",),
         "character.flesh.depth=0.08: must be at most 0.072, which thigh has from its surface to "
         "its middle"),
        (("character.flesh.depth=0.08", "character.height=1.2"),  # told as it is written
         "character.flesh.depth=0.08: must be at most 0.072, "),
        (("character.flesh.depth=0.06", "character.height=1.2"), ""),  # of the drawn
        (("character.flesh.depth=0",), "character.flesh.depth=0: must be greater than 0"),
        (("character.flesh.onset=0",),
         "character.flesh.onset=0: must be greater than or equal to 0.0001"),
        (("character.flesh.onset=0.95",),
         "character.flesh.onset=0.95: must be less than 0.95, which the contact comes to"),
        (("physics=lockstep", "character.flesh.depth=0.04"),
         "character.flesh.depth=0.04: acts on nothing, as contacts of physics=lockstep are hard; "
         "leave flesh as character=adult_free_head has it"),
        (("physics=lockstep",), ""),
    ],
)  # fmt: skip
def test_flesh_that_is_none_is_refused(overrides, message):
    said = ""
    try:
        build(load([*overrides, "duration=1"]))
    except InputError as error:
        said = str(error)
    assert said.startswith(message) if message else not said
