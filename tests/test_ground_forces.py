"""The ground's forces over a control period: two ways to add them up, and Newton's second law."""

from itertools import islice

import mujoco
import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.mechanics.contacts import read_contacts
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.simulation import ground_forces
from rotctl.simulation.episode import Episode
from rotctl.simulation.ground_forces import Compiled, Reference

built = pytest.mark.skipif(
    ground_forces.library() is None, reason="the compiled sums are not built here"
)


def periods(overrides, kinds, steps):
    """What each kind makes of the same control periods: [(contacts at the begin, results)]."""
    scenario, found = build(load(overrides)), []
    advance, each = scenario.stepper.advance, [kind(scenario.model.mj) for kind in kinds]

    class All:
        def begin(self, contacts):
            for one in each:
                one.begin(contacts)

        def add(self, data):
            for one in each:
                one.add(data)

        def result(self):
            found.append([one.result() for one in each])
            return found[-1][0]

    scenario.stepper._forces = All()
    contacts = []

    def spy(data, torque, seen):
        contacts.append(seen)
        return advance(data, torque, seen)

    scenario.stepper.advance = spy
    assert len(list(islice(Episode(scenario), steps))) == steps
    return list(zip(contacts, found, strict=True))


@built
@pytest.mark.parametrize(
    "overrides",
    [
        ["behaviour=forward_roll_1"],
        ["behaviour=forward_roll_1", "physics.cone=pyramidal"],
        ["behaviour=stairs"],  # a capsule is the first geom there, a plane is on level ground
        ["behaviour=uneven_terrain", "seed=1"],
        ["behaviour=terrain_roll", "terrain=hazards", "seed=1"],
        ["behaviour=forward_roll_1", "physics=lockstep", "physics.substeps=2"],
    ],
)
def test_compiled_is_the_reference(overrides):
    for _, (one, other) in periods(overrides, (Compiled, Reference), 120):
        for name in one._fields:
            expected = pytest.approx(getattr(other, name), rel=1e-12, abs=1e-9)
            assert getattr(one, name) == expected, name


@pytest.mark.parametrize("kind", [pytest.param(Compiled, marks=built), Reference])
def test_contacts_keep_their_places_and_new_ones_follow(kind):
    """Every newton has a body and a place: those of contacts that come later too."""
    late = 0
    for contacts, (found,) in periods(["seed=1"], (kind,), 180):
        m = contacts.count
        assert found.body[:m].tolist() == contacts.body.tolist()
        assert found.position[:m].tolist() == contacts.position.tolist()
        assert found.normal[:m].tolist() == contacts.frame[:, 0].tolist()
        assert not set(found.body[m:]) & set(contacts.body)
        assert len(set(found.body[m:])) == len(found.body) - m
        assert (found.peak >= np.sqrt((found.mean**2).sum(axis=1)) - 1e-9).all()
        assert found.mean.sum(axis=0) == pytest.approx(found.total, abs=1e-9)
        late += (found.peak[m:] > 10.0).sum()
    assert late > 10


def test_a_force_goes_to_the_nearest_contact_of_its_body(world, supported):
    """Two slots of one body, at its own contact points: each gets its own force."""
    mj, checked = world.mj, 0
    for step in supported:
        data = world.data(step.position, step.velocity)
        mujoco.mj_step2(mj, data)
        contacts = read_contacts(mj, data)
        bodies, counts = np.unique(contacts.body, return_counts=True)
        if not (counts == 2).any():
            continue
        for sums in (Reference(mj), *([Compiled(mj)] if ground_forces.library() else [])):
            sums.begin(contacts)
            sums.add(data)
            found = sums.result()
            for i in np.flatnonzero(contacts.body == bodies[counts == 2][0]):
                local, number = (
                    np.empty(6),
                    int(np.flatnonzero(data.contact.efc_address == contacts.row[i])[0]),
                )
                mujoco.mj_contactForce(mj, data, number, local)
                assert found.mean[i] == pytest.approx(contacts.frame[i].T @ local[:3], abs=1e-9)
                checked += bool(local[0] > 1.0)
    assert checked > 20


def test_without_room_for_a_contact_the_sum_is_still_right(monkeypatch):
    whole = [found.total for _, (found,) in periods(["seed=1"], (Reference,), 60)]
    monkeypatch.setattr(ground_forces, "SLOTS", 1)
    monkeypatch.setattr(ground_forces, "library", lambda: None)
    for (_, (found,)), total in zip(periods(["seed=1"], (Reference,), 60), whole, strict=True):
        assert len(found.body) <= 1
        assert found.total == pytest.approx(total, abs=1e-9)


# ---------------------------------------------------------------- Newton's second law


def rates(*overrides):
    """Change of momentum in each control step less gravity, and the ground's force [N]."""
    scenario = build(load(list(overrides)))
    buffer, breakdown = in_memory(scenario)
    assert not breakdown
    weight = scenario.model.mass * scenario.model.gravity
    gained = np.diff(buffer.trajectory.linear_momentum, axis=0) * scenario.config.controller.rate
    return gained - weight, buffer.contacts.ground_force[:-1], buffer


@pytest.mark.parametrize(
    "overrides",
    [
        ["behaviour=forward_roll_1"],
        ["behaviour=uneven_terrain"],
        ["behaviour=forward_roll_1", "physics=lockstep"],
    ],
)
def test_the_ground_s_force_is_the_change_of_momentum_less_gravity(overrides):
    """To first order in the physics step, as both integrators are."""
    worst = {}
    for substeps in (4, 16):
        momentum, force, _ = rates(*overrides, f"physics.substeps={substeps}", "duration=3")
        assert np.abs(force).max() > 1000.0
        worst[substeps] = np.sqrt(((momentum - force) ** 2).mean())
    assert np.corrcoef(momentum.ravel(), force.ravel())[0, 1] > 0.999
    assert worst[16] < 0.5 * worst[4]


def test_in_the_log_the_contacts_add_up_to_the_ground_s_force():
    _, _, buffer = rates("seed=2", "duration=3")
    contacts = buffer.contacts
    total = contacts.force_realised.astype(float).sum(axis=1)
    assert total == pytest.approx(contacts.ground_force, abs=1e-3)  # single precision
    filled = (contacts.body >= 0).sum(axis=1)
    assert (filled >= contacts.count).all()
    assert (filled > contacts.count).any()
    later = np.arange(contacts.body.shape[1]) >= contacts.count[:, None]
    assert not contacts.used[later].any()
    assert not contacts.force_predicted[later].any()
    largest = np.sqrt((contacts.ground_force**2).sum(axis=1))
    assert (contacts.ground_force_peak >= largest - 1e-9).all()
    assert (contacts.ground_force_peak > 1.2 * largest).any()
