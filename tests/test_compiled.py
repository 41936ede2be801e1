"""The compiled control step against the reference, state by state."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from both import along
from questions import Asking, any_task

from rotctl.config.loading import load
from rotctl.config.schema import check
from rotctl.control import Controller, compiled, literal
from rotctl.control.compiled import CompiledStep
from rotctl.control.kinds import KINDS, Kind, Rows
from rotctl.control.pose import PoseTracker
from rotctl.control.stack import collect
from rotctl.mechanics.state import read
from rotctl.runs.scenario import build
from rotctl.settings.plain import put, way
from rotctl.settings.writing import to_dict
from rotctl.simulation.episode import Episode
from rotctl.simulation.loop import simulate

pytestmark = pytest.mark.skipif(
    compiled.library() is None,
    reason="the compiled control step is not built here (no C compiler at installation)",
)


EXACT = 1e-8  # where both took the same way: 1e-11 of 6,000 states
FORCE = 1e-6  # against each other two contacts press as only a small weight says
ALIKE = 0.1  # [N m]


def cost(scenario, asked, decision):
    """What the optimisation over the contacts that are used makes of a decision, by eq. 2."""
    model, settings, command = scenario.model, scenario.controller.settings, asked.command
    data = mujoco.MjData(model.mj)
    data.qpos[:], data.qvel[:] = asked.expected.position, asked.expected.velocity
    mujoco.mj_step1(model.mj, data)
    state = read(model, data, merging=settings.merging)
    poses = np.array((command.pose_a, command.pose_b))
    torques = PoseTracker(model, 1.0 / settings.rate).torques(state, poses, command.pose)
    stack = collect(model, state, command, settings, torques, asked.blend)
    stack = stack.subset(decision.used[command.candidates(state)])
    force = np.einsum("mij,mj->mi", stack.frame, decision.force[decision.used]).ravel()
    M, pushed = np.zeros((model.mj.nv, model.mj.nv)), stack.jacobian.T @ force - state.bias
    mujoco.mj_fullM(model.mj, data, M)
    pushed[model.joints] += decision.torque
    x = np.concatenate((np.linalg.solve(M, pushed), decision.torque, force, [decision.blend]))
    return sum(
        0.5 * part.W @ (part.A @ x - part.b) ** 2
        for part in literal.objectives(stack, model, state, M)
    )


def assert_as_good(scenario, asked):
    """Where a first solver stopped short, on a sum that the other rounds otherwise or on one alike.

    The next one answered; where many forces do nearly as well theirs differ, by newtons even.
    """
    best = cost(scenario, asked, asked.slow)
    assert cost(scenario, asked, asked.fast) == pytest.approx(best, rel=EXACT)
    assert asked.fast.torque == pytest.approx(asked.slow.torque, abs=ALIKE)


@pytest.mark.parametrize(
    "overrides",
    [
        ["controller.pose.explicit=true"],
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
    scenario = build(load(overrides))
    for asked in along(scenario, 300):
        expected, found, slow, fast = asked.expected, asked.found, asked.slow, asked.fast
        assert fast.used.tolist() == slow.used.tolist()
        assert fast.rates_wanted == pytest.approx(slow.rates_wanted, rel=EXACT, abs=EXACT)
        if not (fast.fallback or slow.fallback):
            for name in ("torque", "force", "rates_predicted", "blend"):
                value = getattr(slow, name)
                exact = FORCE if name == "force" else EXACT
                within = exact * max(100.0, np.abs(value).max(initial=0.0))
                assert getattr(fast, name) == pytest.approx(value, abs=within), name
        else:
            assert_as_good(scenario, asked)
        for name in expected.momentum._fields:
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


def test_heels_are_held_out_alike():
    """Who stands on the front of the feet, pushed."""
    data = to_dict(load(["seed=2", "behaviour=stand", "disturbance=push"]))
    config = check(put(data, way("behaviour.stages.0.toes"), ["foot"]))
    held_out = 0
    for asked in along(build(config), 60):
        assert asked.fast.used.tolist() == asked.slow.used.tolist()
        assert asked.fast.torque == pytest.approx(asked.slow.torque, abs=100.0 * EXACT)
        held_out += int((~asked.command.candidates(asked.expected)).sum())
    assert held_out > 20


def test_contacts_of_limbs_that_turn_fast_are_held_alike():
    """Who stands, pushed, with the accelerations that the limbs' turning gives contacts."""
    asked = ["seed=2", "behaviour=stand", "disturbance=push"]
    found = []
    for centripetal in (True, False):
        config = load([*asked, f"controller.contact.centripetal={str(centripetal).lower()}"])
        for step in along(build(config), 90):
            assert step.fast.torque == pytest.approx(step.slow.torque, abs=100.0 * EXACT)
        found.append(step.slow.torque)
    assert np.abs(found[0] - found[1]).max() > 1e-3  # [N m]


@pytest.mark.parametrize(
    "overrides",
    [
        ["seed=1"],
        ["seed=1", "behaviour=forward_roll_1_on_head"],
        ["seed=2", "physics=lockstep", "behaviour=incline"],
        ["seed=3", "behaviour=terrain_roll", "terrain=hazards"],
        ["seed=4", "behaviour=stand", "disturbance=push", "controller.sees_disturbance=true"],
        ["seed=5", "disturbance=wind", "controller.sees_disturbance=true", "physics.density=20"],
    ],
    ids=" ".join,
)
def test_all_kinds_of_task_at_once(overrides):
    """To rounding: what tasks lack, want and get, and the torques."""
    scenario, rng = build(load(overrides)), seeded()
    names = [*KINDS, *KINDS]
    more = [any_task(name, scenario.model, rng) for name in names]
    asking = replace(scenario, behaviour=Asking(scenario.behaviour, more))
    compared = 0
    for asked in along(asking, 100):
        slow, fast = asked.slow, asked.fast
        assert asked.found.bias == pytest.approx(asked.expected.bias, rel=1e-12, abs=1e-12)
        if fast.fallback or slow.fallback:
            assert_as_good(asking, asked)
            continue
        compared += fast.fallback == 0
        assert fast.used.tolist() == slow.used.tolist()
        assert fast.error == pytest.approx(slow.error, rel=1e-10, abs=1e-10)
        for name in ("wanted", "rates_wanted"):
            assert_close(getattr(fast, name), getattr(slow, name), 1e-10)
        for name in ("torque", "predicted", "rates_predicted"):
            assert_close(getattr(fast, name), getattr(slow, name), 1e-7)
    assert compared > 90


def seeded():
    return np.random.default_rng(8)


def assert_close(found, expected, within):
    """Relative to the largest of its numbers."""
    assert found == pytest.approx(expected, abs=within * (1.0 + np.abs(expected).max()))


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


@pytest.fixture
def refused(monkeypatch):
    """Of each question so far, whether C left it to the reference."""
    said, decide = [], CompiledStep.decide

    def told(*question):
        decision = decide(*question)
        said.append(decision is None)
        return decision

    monkeypatch.setattr(CompiledStep, "decide", told)
    return said


def test_a_kind_that_c_has_not_is_decided_by_the_reference(monkeypatch, refused):
    def nodding(task, model, state):
        """The joint of number `body`; of this test alone."""
        matrix = np.zeros((1, model.mj.nv))
        matrix[0, int(task["body"]) + model.joints.start] = 1.0
        return Rows(matrix, task["acceleration"][:1], task["weight"][:1], np.zeros(3))

    monkeypatch.setitem(KINDS, "nodding", Kind(len(KINDS), momentum=False, rows=nodding))
    scenario = build(load(["seed=1"]))
    task = any_task("nodding", scenario.model, seeded(), weight=1.0)
    moved = []
    for more in ([], [task]):
        scenario = build(load(["seed=1"]))
        asking = replace(scenario, behaviour=Asking(scenario.behaviour, more))
        for asked in along(asking, 20):
            assert_close(asked.fast.torque, asked.slow.torque, EXACT)
            assert asked.fast.predicted.shape == (2 + len(more), 3)
        moved.append(asked.fast.torque)
    assert refused == [False] * 20 + [True] * 20
    assert np.abs(moved[1] - moved[0]).max() > 0.1


@pytest.mark.parametrize("count", [compiled.TASKS - 2, compiled.TASKS - 1, 100])
def test_more_tasks_than_c_has_room_for_are_decided_by_the_reference(count, refused):
    scenario, rng = build(load(["seed=1"])), seeded()
    names = ["point", "attitude", "linear"]
    more = [any_task(names[i % 3], scenario.model, rng, weight=1e-3) for i in range(count)]
    asking = replace(scenario, behaviour=Asking(scenario.behaviour, more))
    for asked in along(asking, 5):
        assert_close(asked.fast.torque, asked.slow.torque, 1e-7)
    assert refused == [count + 2 > compiled.TASKS] * 5


@pytest.mark.parametrize("overrides", [[], ["terrain=hazards"]])
def test_rows_of_many_joints_fit_in_whatever_else_lies_about(overrides, refused):
    scenario, rng = build(load(["seed=1", *overrides])), seeded()
    more = [any_task("limits", scenario.model, rng, weight=1e-3) for _ in range(2)]
    for task in more:
        task["point"] = 10.0  # [rad] every joint is nearer to a stop
    asking = replace(scenario, behaviour=Asking(scenario.behaviour, more))
    for asked in along(asking, 5):
        assert asked.slow.error[-1, 0] > 15  # joints, each with a row
        assert_close(asked.fast.torque, asked.slow.torque, 1e-7)
    assert not any(refused)


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
