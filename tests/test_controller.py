"""The whole-body controller: two passes, fallbacks, and what a decision says."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from rotctl.behaviours.behaviour import Placement
from rotctl.control import Controller, condensed, controller
from rotctl.control.kinds import KINDS
from rotctl.control.pose import PoseTracker
from rotctl.errors import InputError
from rotctl.mechanics.contacts import contact_jacobian
from rotctl.mechanics.state import read
from rotctl.qp import Solution, failed, make_solver
from rotctl.simulation.placing import place
from rotctl.simulation.start import Start


class Broken:
    """A solver that says so."""

    shape = "rows"

    def __init__(self, name, shape="rows", good_passes=0):
        self.name, self.shape, self.left = name, shape, good_passes
        self.calls = 0

    def solve(self, problem, start):
        self.calls += 1
        self.left -= 1
        if self.left >= 0:
            return make_solver("qpsolvers:daqp").solve(problem, start)
        return failed(problem, "poisoned", iterations=7)


class Poisoned(Broken):
    """A solver that says it solved, and did not."""

    def solve(self, problem, start):
        return Solution(np.full(len(problem.f), np.nan), True, 3, 0.0)


@pytest.fixture
def with_solvers(world, monkeypatch):
    """A controller whose solvers of these names are replaced."""

    def make(strength=1.0, last=None, **solvers):
        if last is not None:
            monkeypatch.setattr(controller, "ActiveSet", lambda: last)
        model = replace(world.model, torque_limit=strength * world.model.torque_limit)
        found = {**solvers}
        monkeypatch.setattr(
            controller, "make_solver", lambda name: found.get(name) or make_solver(name)
        )
        chosen = next(iter(found))
        return Controller(model, replace(world.settings, solver=chosen))

    return make


def decide(world, chosen, step):
    return chosen.decide(world.state(step), step.command, step.blend)


def pose_torques(world, step):
    tracker = PoseTracker(world.model, 1.0 / world.settings.rate)
    poses = np.array((step.command.pose_a, step.command.pose_b))
    return tracker.torques(world.state(step), poses, step.command.pose)


# ---------------------------------------------------------------- the normal case


def test_torques_are_within_limits(world, steps):
    limit = world.model.torque_limit
    assert all((np.abs(step.decision.torque) <= limit).all() for step in steps)
    assert all(0.0 <= step.decision.blend <= 1.0 for step in steps)


def test_a_roll_needs_no_fallback(steps):
    for step in steps:
        decision = step.decision
        assert (decision.status, decision.fallback, decision.reasons) == (0, 0, ())
        assert decision.residual <= 1e-5


def test_forces_and_rates_fit_together(world, steps):
    """World forces at the contact points explain the predicted momentum rates."""
    for step in steps[::5]:
        state, decision = world.state(step), step.decision
        assert decision.force.shape == (state.contacts.count, 3)
        arms = state.contacts.position - state.momentum.com
        linear = decision.force.sum(axis=0) + world.model.mass * world.model.gravity
        angular = np.cross(arms, decision.force).sum(axis=0)
        scale = 1e-8 * (1 + np.abs(decision.rates_predicted).max())
        assert decision.rates_predicted == pytest.approx(np.r_[linear, angular], abs=scale)


def test_rates_wanted_are_eq_3_and_4(world, steps):
    gains, mass = world.settings.tasks, world.model.mass
    for step in steps[::20]:
        state = world.state(step)
        momentum = state.momentum
        linear, spin = step.command.copy().tasks
        linear["stiffness"] = 3.0, 5.0, 7.0
        linear["target"][:3] = momentum.com + [0.1, -0.2, 0.3]
        away = linear["velocity"] - momentum.com_velocity
        pull = np.diag([3.0, 5.0, 7.0]) @ [0.1, -0.2, 0.3]
        expected = mass * (pull + np.diag(gains["linear"].damping) @ away)
        found = KINDS["linear"].rows(linear, world.model, state)
        assert found.wanted == pytest.approx(expected, rel=1e-9, abs=1e-9)
        away = spin["velocity"] - momentum.angular_velocity
        expected = momentum.inertia @ (
            np.diag(gains["spin"].stiffness) @ spin["target"][:3]
            + np.diag(gains["spin"].damping) @ away
        )
        found = KINDS["spin"].rows(spin, world.model, state)
        assert found.wanted == pytest.approx(expected, rel=1e-9, abs=1e-9)
        assert step.decision.rates_wanted[3:] == pytest.approx(expected, rel=1e-9, abs=1e-9)
        linear = KINDS["linear"].rows(step.command.tasks[0], world.model, state).wanted
        assert step.decision.rates_wanted[:3] == pytest.approx(linear, rel=1e-9, abs=1e-9)


def test_supervisor_as_written(world, steps):
    """Used are the candidates whose first-pass force, or moment about the CM, is large."""
    limits, dropped = world.settings.thresholds, 0
    for step in steps[::3]:
        state, stack = world.stack(step)
        candidates = ~world.model.excluded[state.contacts.body]
        first = condensed.solve(stack, make_solver("boxqp"))
        force = np.einsum("mij,mi->mj", stack.frame, first.force)
        arms = state.contacts.position[candidates] - state.momentum.com
        size = np.linalg.norm(force, axis=1)
        moment = np.linalg.norm(np.cross(arms, force), axis=1)
        expected = np.zeros(len(candidates), dtype=bool)
        expected[candidates] = (size > limits.force) | (moment > limits.torque)
        assert step.decision.used.tolist() == expected.tolist()
        assert not step.decision.force[~expected].any()
        dropped += int((candidates & ~expected).sum())
        # The second pass is an optimisation over those contacts alone.
        again = condensed.solve(stack.subset(expected[candidates]), make_solver("boxqp"))
        assert step.decision.torque == pytest.approx(again.torque, abs=1e-2)
    assert dropped > 0


@pytest.mark.parametrize("name", ["none", "modified"])
def test_other_supervisors(world, supported, name):
    chosen = Controller(world.model, world.settings)
    for step in supported[::15]:
        step = replace(step, command=step.command._replace(supervisor=name))
        state, decision = world.state(step), decide(world, chosen, step)
        candidates = ~world.model.excluded[state.contacts.body]
        closing = contact_jacobian(world.mj, state.data, state.contacts)[::3] @ state.velocity < 0
        if name == "none":
            assert decision.used.tolist() == candidates.tolist()
        else:
            assert decision.used[candidates & closing].all()


def head_stand(world):
    """A state on its head, in the pose of a recorded step, and that step."""
    data = mujoco.MjData(world.mj)
    on_its_head = Placement(np.array([0.0, 0.0, 1.0, 0.0]), np.zeros(world.mj.nu))
    place(world.model, data, Start(np.pi, np.zeros(3), np.zeros(3)), on_its_head, np.eye(3))
    data.qpos[2] -= 0.02
    step = replace(world.steps[0], position=data.qpos.copy(), velocity=data.qvel.copy())
    return world.state(step), step


def test_a_head_held_out_of_control_is_never_used(world, steps):
    head = world.mj.body("head").id
    state, step = head_stand(world)
    on_head = state.contacts.body == head
    assert on_head.any()
    decision = decide(world, Controller(world.model, world.settings), step)
    assert not decision.used[on_head].any()
    assert not decision.force[on_head].any()
    for step in steps:
        on_head = world.state(step).contacts.body == head
        assert not step.decision.used[on_head].any()


def test_what_lies_behind_is_held_out_alone(world, supported):
    """A line across the middle of a body's contacts: those behind it are not candidates."""
    split = 0
    for step in supported[:40]:
        state, command = world.state(step), step.command
        usual, contacts = command.candidates(state), state.contacts
        mj_data, first = state.data, contacts.body[0]
        places = contacts.position - mj_data.xpos[first]
        along = (mj_data.xmat[first].reshape(3, 3).T @ places.T)[0]
        behind = np.full(world.mj.nbody, -np.inf)
        behind[first] = line = np.mean(along[contacts.body == first]) - 1e-9
        ahead = (contacts.body != first) | (along >= line)
        changed = command._replace(behind=behind)
        assert (changed.candidates(state) == usual & ahead).all()
        decision = Controller(world.model, world.settings).decide(state, changed, step.blend)
        assert not decision.used[~ahead].any()
        split += not ahead.all()
    assert split > 3


def test_a_contact_held_out_of_control_changes_nothing(world):
    """Blind to it: the same torques as if it were not there."""
    state, step = head_stand(world)
    keep = state.contacts.body != world.mj.body("head").id
    contacts = state.contacts
    blind = state._replace(
        contacts=replace(
            contacts,
            body=contacts.body[keep],
            position=contacts.position[keep],
            frame=contacts.frame[keep],
            row=contacts.row[keep],
            friction=contacts.friction[keep],
            gap=contacts.gap[keep],
        ),
    )
    chosen = Controller(world.model, world.settings)
    seen = chosen.decide(state, step.command, 0.5)
    unseen = chosen.decide(blind, step.command, 0.5)
    assert seen.torque.tobytes() == unseen.torque.tobytes()


@pytest.mark.parametrize("name", ["boxqp", "osqp"])
def test_no_memory(world, supported, name):
    chosen = Controller(world.model, replace(world.settings, solver=name))
    first = decide(world, chosen, supported[0])
    for step in supported[1:30:7]:
        decide(world, chosen, step)
    again = decide(world, chosen, supported[0])
    assert first.torque.tobytes() == again.torque.tobytes()
    assert first.force.tobytes() == again.force.tobytes()
    assert first.iterations == again.iterations


def test_literal_form_decides_alike(world, supported):
    chosen = Controller(
        world.model, replace(world.settings, form="literal", solver="qpsolvers:daqp")
    )
    for step in supported[::15]:
        decision = decide(world, chosen, step)
        assert decision.status == 0
        assert decision.used.tolist() == step.decision.used.tolist()
        assert decision.torque == pytest.approx(step.decision.torque, abs=1e-2)


def test_in_the_air(world):
    position, velocity = world.in_the_air()
    step = replace(world.steps[5], position=position, velocity=velocity)
    decision = decide(world, Controller(world.model, world.settings), step)
    assert decision.used.shape == (0,)
    assert decision.force.shape == (0, 3)
    gravity = world.model.mass * world.model.gravity
    assert decision.rates_predicted == pytest.approx(np.r_[gravity, 0, 0, 0], abs=1e-9)


# ---------------------------------------------------------------- refusals and fallbacks


def test_literal_needs_a_solver_with_rows(world):
    with pytest.raises(InputError) as error:
        Controller(world.model, replace(world.settings, form="literal", solver="boxqp"))
    assert str(error.value) == (
        "controller.form=literal has equality rows, which boxqp cannot solve; choose "
        "controller.solver=osqp or controller.solver=qpsolvers:<name>"
    )


@pytest.mark.parametrize("solver", [Broken("osqp"), Poisoned("osqp")])
def test_boxqp_steps_in(world, supported, with_solvers, solver):
    chosen, usual = with_solvers(osqp=solver), Controller(world.model, world.settings)
    for step in supported[::25]:
        decision, expected = decide(world, chosen, step), decide(world, usual, step)
        assert (decision.status, decision.fallback) == (1, 1)
        assert len(decision.reasons) == 1
        assert decision.reasons[0].startswith("condensed osqp: ")
        assert decision.torque.tobytes() == expected.torque.tobytes()
        assert decision.used.tolist() == expected.used.tolist()


def test_the_reason_is_the_solver_s(world, supported, with_solvers):
    decision = decide(world, with_solvers(osqp=Broken("osqp")), supported[0])
    assert decision.reasons == ("condensed osqp: poisoned",)
    assert decision.iterations == 7
    decision = decide(world, with_solvers(osqp=Poisoned("osqp")), supported[0])
    assert decision.reasons == ("condensed osqp: torques are not finite",)


def test_a_failure_in_the_second_pass_falls_back_too(world, supported, with_solvers):
    partial = next(
        s
        for s in supported
        if 0 < s.decision.used.sum() < (~world.model.excluded[world.state(s).contacts.body]).sum()
        and (np.abs(s.decision.torque) < world.model.torque_limit).all()
    )
    solver = Broken("osqp", good_passes=1)
    decision = decide(world, with_solvers(osqp=solver), partial)
    assert solver.calls >= 2
    assert decision.status == 1
    assert decision.torque == pytest.approx(partial.decision.torque, abs=1e-9)


@pytest.mark.parametrize("kind", [Broken, Poisoned])
def test_when_all_fail_the_pose_is_tracked(world, supported, with_solvers, kind):
    last = kind("active_set", "bounds")
    chosen = with_solvers(0.2, last, osqp=kind("osqp"), boxqp=kind("boxqp", "bounds"))
    limit, clipped = 0.2 * world.model.torque_limit, 0
    for step in supported[::10]:
        decision = decide(world, chosen, step)
        a, b = pose_torques(world, step)
        expected = step.blend * a + (1 - step.blend) * b
        assert (decision.status, decision.fallback) == (2, 3)
        assert len(decision.reasons) == 3
        assert decision.torque == pytest.approx(np.clip(expected, -limit, limit), abs=1e-9)
        assert decision.blend == step.blend
        assert not decision.used.any()
        assert not decision.force.any()
        assert np.isnan(decision.residual)
        assert np.isfinite(decision.rates_predicted).all()
        clipped += int((np.abs(expected) > limit).any())
    assert clipped > 0


def test_the_active_set_steps_in_for_boxqp(world, supported, with_solvers):
    chosen = with_solvers(boxqp=Broken("boxqp", "bounds"))
    for step in supported[::10]:
        decision = decide(world, chosen, step)
        assert (decision.status, decision.fallback) == (1, 1)
        assert decision.reasons == ("condensed boxqp: poisoned",)
        assert decision.torque == pytest.approx(step.decision.torque, abs=1e-3)
        assert decision.used.tolist() == step.decision.used.tolist()


def test_iterations_count_every_pass(world, supported, with_solvers):
    """Also the one before torque limits turn out to bind."""

    class Counting(Broken):
        def solve(self, problem, start):
            self.calls += 1
            solution = make_solver("qpsolvers:daqp").solve(problem, start)
            return replace(solution, iterations=10)

    several = 0
    for step in supported[::5]:
        solver = Counting("osqp")
        decision = decide(world, with_solvers(0.2, osqp=solver), step)
        assert decision.iterations == 10 * solver.calls
        several = max(several, solver.calls)
    assert several >= 3


def test_reads_the_state_as_the_loop_does(world, steps):
    """A revived state and the loop's own give the same decision, bit for bit."""
    chosen = Controller(world.model, world.settings)
    for step in steps[::30]:
        state = read(world.model, world.data(step.position, step.velocity))
        decision = chosen.decide(state, step.command, step.blend)
        assert decision.torque.tobytes() == step.decision.torque.tobytes()
