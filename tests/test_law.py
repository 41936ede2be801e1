"""One law for any stack of objectives: both forms to rounding, with tasks of every kind added.

The literal form is solved as least squares over torques, forces and blend, on the limits that the
condensed form's answer lies on; multipliers then say whether that is the literal form's minimum.
"""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from exact import Polished, written_out
from questions import any_task, look_at, with_tasks

from rotctl.config.loading import load
from rotctl.control import condensed
from rotctl.control.kinds import KINDS
from rotctl.qp.active_set import ActiveSet
from rotctl.qp.boxqp import BoxQP
from rotctl.runs.scenario import build

SAME = 1e-9  # of the largest torque, where no limit binds
LIMITED = 1e-5  # [N m] where one does: the condensed form then squares its rows
OPTIMAL = 1e-6  # what multipliers leave of the cost's slope, relative
EPISODES = [  # 40 states each
    ["behaviour=forward_roll_1", "seed=2001"],
    ["behaviour=backward_roll_1", "seed=2002", "character.exclude_from_control=[]"],
    ["behaviour=backward_roll_1", "seed=2002", "controller.supervisor=none"],
    ["behaviour=sideways_roll", "seed=2003", "disturbance=wind"],
    ["behaviour=terrain_roll", "seed=2004", "terrain=hazards"],
    ["behaviour=incline", "seed=2005", "physics=lockstep"],
    ["behaviour=stand", "seed=2006", "disturbance=push", "controller.sees_disturbance=true"],
]


def some_tasks(count, model, rng):
    """Tasks of that many kinds, some of whose rows have no weight."""
    names = rng.permutation(list(KINDS))[:count]
    tasks = [any_task(name, model, rng) for name in names]
    for task in tasks:
        task["weight"] *= rng.uniform(size=(1, 3)) > 0.2
    return tasks


def assert_one_law(question, stack):
    """Both forms of a stack have one minimum; whether a torque limit binds there."""
    found = condensed.solve(stack, Polished())
    assert found.solution.solved, found.solution.reason
    expected, left = written_out(stack, question.model, question.state, found)
    assert left < OPTIMAL
    binds = bool((np.abs(expected.torque) >= stack.torque_limit - 1e-6).any())
    within = LIMITED if binds else SAME * np.abs(expected.torque).max()
    assert np.abs(found.torque - expected.torque).max() <= within
    assert found.blend == pytest.approx(expected.blend, abs=1e-8)
    rates, other = (stack.maps @ answer.force.ravel() for answer in (found, expected))
    assert rates == pytest.approx(other, abs=1e-8 * (1 + np.abs(other).max(initial=0.0)))
    default = condensed.solve(stack, BoxQP())
    if not default.solution.solved:  # it stops short now and then
        default = condensed.solve(stack, ActiveSet())
    assert np.abs(default.torque - expected.torque).max() <= 1e-3
    return binds


@pytest.mark.parametrize("overrides", EPISODES, ids=" ".join)
def test_the_condensed_form_is_the_literal_one(overrides):
    """With 0, 1 and 3 tasks beside those of the behaviour; over all contacts, and over some."""
    rng, compared = np.random.default_rng(0), []

    def look(question):
        for count in (0, 1, 3):
            stack = question.stack(*some_tasks(count, question.model, rng))
            compared.append(assert_one_law(question, stack))
            if count == 1:
                kept = rng.uniform(size=stack.contacts) < 0.6
                assert_one_law(question, stack.subset(kept))

    look_at(build(load(overrides)), 160, look, every=4)
    assert len(compared) == 120
    assert sum(compared) < 60  # in most states no limit binds


def test_so_it_is_where_limits_bind():
    """With a fifth of the strength nearly all of them do."""
    rng, binding = np.random.default_rng(1), []

    def look(question):
        for count in (0, 1, 3):
            stack = question.stack(*some_tasks(count, question.model, rng))
            weak = replace(stack, torque_limit=0.2 * stack.torque_limit)
            binding.append(assert_one_law(question, weak))

    look_at(build(load(["seed=2001"])), 160, look, every=8)
    assert sum(binding) > 45


@pytest.mark.parametrize("name", KINDS)
def test_a_task_without_weight_is_not_there(name):
    rng, moved = np.random.default_rng(2), 0.0

    def look(question):
        nonlocal moved
        task = any_task(name, question.model, rng)
        weightless = task.copy()
        weightless["weight"] = 0.0
        torques = []
        for more in ([], [weightless], [task]):
            stack = question.stack(*more)
            torques.append(condensed.solve(stack, Polished()).torque)
        absent, without, with_it = torques
        assert np.abs(absent - without).max() <= 1e-12 * np.abs(absent).max()
        moved = max(moved, np.abs(absent - with_it).max())

    look_at(build(load(["seed=2001"])), 120, look, every=12)
    assert moved > 0.1  # [N m] the same task with a weight acts


@pytest.mark.parametrize("name", [name for name in KINDS if not KINDS[name].momentum])
def test_a_task_of_great_weight_is_met(name):
    """What can be met alone is met: torque limits and the momenta set aside."""
    rng, met = np.random.default_rng(3), 0

    def look(question):
        nonlocal met
        task = any_task(name, question.model, rng, weight=1e4)
        alone = question.command._replace(tasks=np.zeros(0, task.dtype))
        alone = alone._replace(contact=replace(alone.contact, weight=0.0))
        stack = replace(question, command=alone).stack(task)
        stack = replace(stack, torque_limit=np.full(question.model.mj.nu, 1e9))
        (rows,) = stack.tasks
        if not len(rows.rows.wanted):
            return
        found = condensed.solve(stack, Polished())
        passive = stack.drift + stack.wanted
        force = found.force.ravel()
        gives = stack.actuation @ found.torque + stack.mobility @ force + passive
        given = gives[3 * stack.contacts :]
        scale = 1 + np.abs(rows.rows.wanted).max()
        assert given == pytest.approx(rows.rows.wanted, abs=1e-2 * scale)
        met += 1

    look_at(build(load(["seed=2001"])), 60, look, every=6)
    assert met > 3


# ---------------------------------------------------------------- what a decision says of its tasks


@pytest.mark.parametrize("backend", ["compiled", "reference"])
def test_errors_wishes_and_predictions_are_true(world, backend):
    """Of every kind: the rows, at the acceleration that the decided torques and forces bring.

    Rates of momenta along it are differences of what the bodies sum up to.
    """
    rng, checked = np.random.default_rng(4), 0
    names = list(KINDS)
    settings = replace(world.settings, backend=backend)
    scenario = build(replace(world.config, seed=2007, controller=settings))
    assert scenario.controller.backend == backend
    model, nv = world.model, world.mj.nv

    def look(question):
        nonlocal checked
        more = [any_task(name, model, rng) for name in rng.permutation(names)]
        command, state = with_tasks(question.command, *more), question.state
        decision = scenario.controller.decide(state, command, question.blend)
        assert decision.fallback == 0
        M = np.zeros((nv, nv))
        mujoco.mj_fullM(world.mj, state.data, M)
        pushed = -state.bias
        pushed[model.joints] += decision.torque
        for body, at, force in zip(
            state.contacts.body, state.contacts.position, decision.force, strict=True
        ):
            mujoco.mj_applyFT(world.mj, state.data, force, np.zeros(3), at, body, pushed)
        acceleration = np.linalg.solve(M, pushed)
        rates = world.rates_by_difference(state.position, state.velocity, acceleration)
        assert decision.error.shape == decision.wanted.shape == (len(command.tasks), 3)
        wanted = np.zeros(6)
        for i, task in enumerate(command.tasks):
            rows = KINDS[names[task["kind"]]].rows(task, model, state)
            given = rates if KINDS[names[task["kind"]]].momentum else acceleration
            scale = 1e-4 if KINDS[names[task["kind"]]].momentum else 1e-7
            k = min(len(rows.wanted), 3)
            expected = rows.matrix[:k] @ given
            scale *= 1 + np.abs(expected).max(initial=0.0)
            assert decision.predicted[i, :k] == pytest.approx(expected, abs=scale)
            assert decision.wanted[i, :k] == pytest.approx(rows.wanted[:k], rel=1e-9, abs=1e-9)
            assert not decision.wanted[i, k:].any()
            assert not decision.predicted[i, k:].any()
            assert decision.error[i] == pytest.approx(rows.error, rel=1e-9, abs=1e-9)
            if KINDS[names[task["kind"]]].momentum:
                wanted += rows.wanted @ rows.matrix
            checked += k
        scale = 1 + np.abs(wanted).max()
        assert decision.rates_wanted == pytest.approx(wanted, abs=1e-9 * scale)
        scale = 1 + np.abs(rates).max()
        assert decision.rates_predicted == pytest.approx(rates, abs=1e-4 * scale)

    look_at(scenario, 120, look, every=6)
    assert checked > 20 * 15
