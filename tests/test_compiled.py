"""The compiled control step against the reference, state by state."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from rotctl.config import load
from rotctl.control import Controller, compiled
from rotctl.mechanics.state import read
from rotctl.scenario import build
from rotctl.simulation.loop import INITIAL_BLEND, simulate
from rotctl.simulation.start import place

pytestmark = pytest.mark.skipif(
    compiled.library() is None,
    reason="the compiled control step is not built here (no C compiler at installation)",
)


def both(scenario):
    """A compiled and a reference controller of one model."""
    settings = scenario.config.controller
    return (
        Controller(scenario.model, replace(settings, backend="compiled")),
        Controller(scenario.model, replace(settings, backend="reference")),
    )


def along_a_roll(overrides, steps):
    """Pairs of states and decisions along a roll that the reference drives."""
    scenario = build(load(overrides))
    fast, slow = both(scenario)
    assert (fast.backend, slow.backend) == ("compiled", "reference")
    model, behaviour = scenario.model, scenario.behaviour
    data = mujoco.MjData(model.mj)
    place(model, data, scenario.start, behaviour.orientation, behaviour.pose(scenario.start.pitch))
    now, blend = behaviour.begin(scenario.start.pitch), INITIAL_BLEND
    for _ in range(steps):
        scenario.stepper.evaluate(data)
        expected = slow.read(data)
        now = behaviour.advance(now, expected)
        desired = behaviour.desired(expected, now)
        found = fast.read(data)
        decision = slow.decide(expected, desired, blend)
        yield expected, found, decision, fast.decide(found, desired, blend)
        blend = decision.blend
        scenario.stepper.advance(data, decision.torque, expected.contacts)


@pytest.mark.parametrize(
    "overrides",
    [
        ["seed=1"],
        ["seed=2", "controller.supervisor=none"],
        ["seed=3", "controller.supervisor=modified"],
        ["seed=4", "behaviour=forward_roll_1_phase", "controller.weights.contact_velocity=0"],
        ["seed=5", "controller=root"],
        ["seed=3", "behaviour=terrain_roll", "terrain=hazards"],
    ],
)
def test_same_torques_and_contacts_as_the_reference(overrides):
    """300 states each: 1800 in all."""
    dropped = limited = 0
    for expected, found, slow, fast in along_a_roll(overrides, 300):
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
    fast = Controller(weak, replace(scenario.config.controller, backend="compiled"))
    slow = Controller(weak, replace(scenario.config.controller, backend="reference"))
    bound = 0
    for expected, _, _, _ in along_a_roll(["seed=5"], 60):
        desired = scenario.behaviour.desired(expected, scenario.behaviour.begin(0.0))
        a = slow.decide(slow.read(expected.data), desired, 0.5)
        b = fast.decide(fast.read(expected.data), desired, 0.5)
        assert np.abs(a.torque - b.torque).max() <= 1e-6 * np.abs(a.torque).max()
        bound += int((np.abs(a.torque) >= weak.torque_limit - 1e-9).any())
    assert bound > 30


def test_any_other_state_takes_the_reference():
    """Part of a state is kept on the C side: only the one read last may be decided upon."""
    scenario = build(load([]))
    fast, slow = both(scenario)
    data = mujoco.MjData(scenario.model.mj)
    place(
        scenario.model,
        data,
        scenario.start,
        scenario.behaviour.orientation,
        scenario.behaviour.pose(0.0),
    )
    mujoco.mj_step1(scenario.model.mj, data)
    first = fast.read(data)
    desired = scenario.behaviour.desired(first, scenario.behaviour.begin(0.0))
    expected = slow.decide(first, desired, 0.5).torque
    velocity = data.qvel.copy()
    data.qvel[:] += 1.0
    mujoco.mj_step1(scenario.model.mj, data)
    fast.read(data)
    data.qvel[:] = velocity
    mujoco.mj_step1(scenario.model.mj, data)
    other = read(scenario.model, data)
    assert fast.decide(other, desired, 0.5).torque.tobytes() == expected.tobytes()


def test_what_it_returns_is_the_caller_s():
    """The next step does not change an earlier state or decision."""
    steps = [(found, fast) for _, found, _, fast in along_a_roll(["seed=6"], 12)]
    assert len({found.momentum.com.tobytes() for found, _ in steps}) == 12
    assert len({fast.torque.tobytes() for _, fast in steps}) == 12


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
        parts = (scenario.model, scenario.behaviour, scenario.controller, scenario.stepper)
        buffer = simulate(*parts, scenario.start, 1.0, 64).buffer
        return b"".join(array.tobytes() for array in buffer.arrays().values())

    assert trajectory() == trajectory()
