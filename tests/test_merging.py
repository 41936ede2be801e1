"""Contacts that are one to control: which, that they stay real contacts, and what that changes."""

from dataclasses import replace
from itertools import islice

import mujoco
import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.control import compiled
from rotctl.errors import InputError
from rotctl.mechanics.contacts import Contacts, contact_jacobian, read_contacts
from rotctl.mechanics.merging import APART, Merging, merged
from rotctl.mechanics.state import read
from rotctl.runs.scenario import build
from rotctl.simulation.episode import Episode

NEAR = Merging(distance=0.03, angle=45.0)


def contacts(*given):
    """Contacts from (body, x, lean of the normal [deg], gap); z is 0, row is their number."""
    body, x, lean, gap = (np.array(column, dtype=float) for column in zip(*given, strict=True))
    lean, nothing = np.radians(lean), np.zeros(len(given))
    normal = np.stack([np.sin(lean), nothing, np.cos(lean)], axis=1)
    along = np.stack([np.cos(lean), nothing, -np.sin(lean)], axis=1)
    return Contacts(
        body=body.astype(np.int32),
        position=np.stack([x, nothing, nothing], axis=1),
        frame=np.stack([normal, along, np.cross(normal, along)], axis=1),
        row=np.arange(len(given)),
        friction=np.ones((len(given), 2)),
        gap=gap,
    )


@pytest.mark.parametrize(
    ("given", "kept"),
    [
        ([(1, 0.0, 0.0, -0.001), (1, 0.02, 0.0, -0.002)], [1]),  # the deeper one
        ([(1, 0.0, 0.0, -0.002), (1, 0.02, 0.0, -0.002)], [0]),  # the first of two as deep
        ([(1, 0.0, 0.0, -0.001), (2, 0.02, 0.0, -0.002)], [0, 1]),  # two bodies
        ([(1, 0.0, 0.0, -0.001), (1, 0.04, 0.0, -0.002)], [0, 1]),  # too far apart
        ([(1, 0.0, 0.0, -0.001), (1, 0.02, 44.0, -0.002)], [1]),  # an edge of the grid
        ([(1, 0.0, 0.0, -0.001), (1, 0.02, 90.0, -0.002)], [0, 1]),  # a tread and a riser
        # A chain: the middle one is deepest and stands for both; else its ends stay.
        ([(1, 0.0, 0, -0.001), (1, 0.02, 0, -0.003), (1, 0.04, 0, -0.001)], [1]),
        ([(1, 0.0, 0, -0.003), (1, 0.02, 0, -0.001), (1, 0.04, 0, -0.003)], [0, 2]),
    ],
)
def test_the_deepest_stands_for_those_about_it(given, kept):
    found = merged(contacts(*given), NEAR)
    assert found.row.tolist() == kept
    for i, row in enumerate(kept):
        assert (found.body[i], found.position[i, 0], found.gap[i]) == (
            given[row][0],
            given[row][1],
            given[row][3],
        )


def test_without_a_distance_all_stay_apart():
    twice = contacts((1, 0.0, 0.0, -0.001), (1, 0.0, 0.0, -0.001))
    assert merged(twice, APART) is twice


def test_no_contacts_are_no_contacts():
    one = contacts((1, 0.0, 0.0, -0.001))
    nothing = Contacts(*(getattr(one, name)[:0] for name in vars(one)))
    assert merged(nothing, NEAR).count == 0


def lying(scenario, x, y):
    """Data of the character in its start posture at (x, y), a little into the ground."""
    model, data = scenario.model, Episode(scenario).data
    data.qpos[:2] = x, y
    data.qpos[2] += model.ground.height(x, y) - 0.005
    mujoco.mj_step1(model.mj, data)
    return data


@pytest.fixture(scope="module")
def on_hills():
    """States of a body on hills, in which some contact has a twin."""
    scenario = build(load(["terrain=uneven", "seed=3"]))
    places = np.random.default_rng(5).uniform((5.0, -4.0), (50.0, 4.0), (60, 2))
    return scenario, [lying(scenario, x, y) for x, y in places]


def test_what_stays_are_contacts_of_the_physics(on_hills):
    """Their rows of the Jacobian are MuJoCo's own at their points, and no two are one."""
    scenario, states = on_hills
    mj, dropped = scenario.model.mj, 0
    for data in states:
        everything = read_contacts(mj, data)
        found = read(scenario.model, data, merging=NEAR).contacts
        assert set(found.row.tolist()) <= set(everything.row.tolist())
        assert found.row.tolist() == sorted(found.row.tolist())
        dropped += everything.count - found.count
        rows, point = contact_jacobian(mj, data, found), np.empty((3, mj.nv))
        for i in range(found.count):
            mujoco.mj_jac(mj, data, point, None, found.position[i], found.body[i])
            assert rows[3 * i : 3 * i + 3] == pytest.approx(found.frame[i] @ point, abs=1e-9)
            for j in range(i):
                apart = np.linalg.norm(found.position[i] - found.position[j])
                lean = found.frame[i, 0] @ found.frame[j, 0]
                same = found.body[i] == found.body[j]
                assert not (same and apart < 0.03 and lean > np.cos(np.radians(45.0)))
    assert dropped > 25


def test_each_that_went_is_one_with_one_that_stayed(on_hills):
    scenario, states = on_hills
    went = 0
    for data in states:
        everything = read_contacts(scenario.model.mj, data)
        found = merged(everything, NEAR)
        for i in np.flatnonzero(~np.isin(everything.row, found.row)):
            went += 1
            near = np.linalg.norm(found.position - everything.position[i], axis=1) < 0.03
            deeper = found.gap <= everything.gap[i]
            assert (near & deeper & (found.body == everything.body[i])).any()
    assert went > 25


@pytest.mark.skipif(
    compiled.library() is None,
    reason="the compiled control step is not built here (no C compiler at installation)",
)
@pytest.mark.parametrize("physics", ["mujoco", "lockstep"])
def test_both_backends_see_the_same(physics):
    """Along a roll over hills, which the compiled one drives."""
    scenario = build(load(["behaviour=uneven_terrain", f"physics={physics}", "seed=3"]))
    model, controller, dropped = scenario.model, scenario.controller, []
    assert controller.backend == "compiled"

    class Both:
        """The compiled step, whose every reading is compared."""

        settings, decide = controller.settings, controller.decide

        def read(self, data):
            found = controller.read(data)
            expected = read(model, data, merging=self.settings.merging).contacts
            for name in vars(expected):
                assert getattr(found.contacts, name).tolist() == getattr(expected, name).tolist()
            dropped.append(read(model, data).contacts.count - expected.count)
            return found

    both = Both()
    asked = Episode(replace(scenario, controller=both, observer=both))
    assert len(list(islice(asked, 240))) == 240
    assert sum(dropped) > 50


def test_level_ground_has_none_to_merge():
    """The same bits with and without: limbs touch a plane at points far apart."""
    decided = []
    for distance in (0.0, 0.03):
        scenario = build(load(["seed=2", f"controller.merging.distance={distance}"]))
        decided.append([m.decision.torque for m in islice(Episode(scenario), 60)])
    assert np.array_equal(*decided)


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("distance=-0.01", "controller.merging.distance=-0.01: must be greater than or equal to 0"),
        ("angle=120", "controller.merging.angle=120: must be less than or equal to 90"),
    ],
)
def test_bad_numbers_are_named(override, message):
    with pytest.raises(InputError) as error:
        load([f"controller.merging.{override}"])
    assert str(error.value) == message
