"""The compiled control step against the reference, state by state."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from both import along

from rotctl.config import load
from rotctl.control import Controller, compiled
from rotctl.mechanics.state import read
from rotctl.scenario import build
from rotctl.simulation.episode import Episode
from rotctl.simulation.loop import simulate

pytestmark = pytest.mark.skipif(
    compiled.library() is None,
    reason="the compiled control step is not built here (no C compiler at installation)",
)


@pytest.mark.parametrize(
    "overrides",
    [
        ["seed=1"],
        ["seed=2", "controller.supervisor=none"],
        ["seed=3", "controller.supervisor=modified"],
        ["seed=4", "behaviour=forward_roll_1_phase", "controller.contact.weight=0"],
        ["seed=5", "excursion=root"],
        ["seed=3", "behaviour=terrain_roll", "terrain=hazards"],
    ],
)
def test_same_torques_and_contacts_as_the_reference(overrides):
    """300 states each: 1800 in all."""
    dropped = limited = 0
    for asked in along(build(load(overrides)), 300):
        expected, found, slow, fast = asked.expected, asked.found, asked.slow, asked.fast
        # Where the reference's first solver stopped short, its second one is as good, not the same.
        exact = 1e-6 if fast.fallback == slow.fallback else 1e-5
        scale = np.abs(slow.torque).max()
        assert np.abs(fast.torque - slow.torque).max() <= exact * scale
        assert fast.used.tolist() == slow.used.tolist()
        assert fast.blend == pytest.approx(slow.blend, abs=1e-6)
        for name in ("force", "rates_wanted", "rates_predicted"):
            expected_values = getattr(slow, name)
            within = exact * max(100.0, np.abs(expected_values).max(initial=0.0))
            assert getattr(fast, name) == pytest.approx(expected_values, abs=within)
        for name in vars(expected.momentum):
            a, b = getattr(found.momentum, name), getattr(expected.momentum, name)
            assert a == pytest.approx(b, rel=1e-9, abs=1e-9)
        for name in vars(expected.contacts):
            a, b = getattr(found.contacts, name), getattr(expected.contacts, name)
            assert a.tolist() == b.tolist()
        assert found.trunk_axes == pytest.approx(expected.trunk_axes, abs=1e-12)
        assert (found.position == expected.position).all()
        dropped += int((~slow.used).sum())
        limited += int((np.abs(slow.torque) >= 0.999 * 80).any())
    assert limited > 0
    if "controller.supervisor=none" not in overrides:
        assert dropped > 0


def test_weak_joints_make_limits_bind():
    """With a fifth of the strength the full form is needed nearly always."""
    scenario = build(load(["seed=5"]))
    weak = replace(scenario.model, torque_limit=0.2 * scenario.model.torque_limit)
    bound = 0
    for asked in along(replace(scenario, model=weak), 60):
        a, b = asked.slow, asked.fast
        assert np.abs(a.torque - b.torque).max() <= 1e-6 * np.abs(a.torque).max()
        bound += int((np.abs(a.torque) >= weak.torque_limit - 1e-9).any())
    assert bound > 30


def test_any_other_state_takes_the_reference():
    """Part of a state is kept on the C side: only the one read last may be decided upon."""
    scenario = build(load([]))
    model, behaviour = scenario.model, scenario.behaviour
    fast = Controller(model, replace(scenario.config.controller, backend="compiled"))
    slow = Controller(model, replace(scenario.config.controller, backend="reference"))
    data = Episode(scenario).data
    mujoco.mj_step1(model.mj, data)
    first = fast.read(data)
    command = behaviour.command(behaviour.begin(0.0, first), first)
    velocity = data.qvel.copy()
    data.qvel[:] += 1.0
    mujoco.mj_step1(model.mj, data)
    fast.read(data)
    data.qvel[:] = velocity
    mujoco.mj_step1(model.mj, data)
    other = read(model, data)
    found, expected = (c.decide(other, command, 0.5).torque for c in (fast, slow))
    assert found.tobytes() == expected.tobytes()
    assert found == pytest.approx(slow.decide(first, command, 0.5).torque, rel=1e-9, abs=1e-9)


def test_what_it_returns_is_the_caller_s():
    """The next step does not change an earlier state or decision."""
    steps = list(along(build(load(["seed=6"])), 12))
    assert len({asked.found.momentum.com.tobytes() for asked in steps}) == 12
    assert len({asked.fast.torque.tobytes() for asked in steps}) == 12


def test_it_serves_the_default_only():
    scenario = build(load([]))
    settings, model = scenario.config.controller, scenario.model
    assert compiled.serves(settings, model)
    assert not compiled.serves(replace(settings, solver="osqp"), model)
    assert not compiled.serves(replace(settings, form="literal"), model)
    assert Controller(model, replace(settings, solver="osqp")).backend == "reference"


@pytest.mark.parametrize("backend", ["compiled", "reference"])
def test_two_runs_are_the_same_bytes(backend):
    def trajectory():
        scenario = build(load(["seed=7", f"controller.backend={backend}"]))
        buffer = simulate(scenario, 1.0, 64).buffer
        return b"".join(array.tobytes() for array in buffer.arrays().values())

    assert trajectory() == trajectory()
