"""Both forms of the optimisation: against the paper's cost, each other and the dynamics."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
import qpsolvers

from rotctl.control import condensed, literal
from rotctl.control.answer import Answer
from rotctl.control.settings import ControllerSettings
from rotctl.mechanics.contacts import contact_jacobian
from rotctl.qp import Problem, make_solver
from rotctl.qp.active_set import ActiveSet
from rotctl.qp.boxqp import BoxQP

# [N m] how far two forms of the same problem may differ, solved by an active-set method and
# by boxqp (which regularises; test_boxqp.py is stricter where it matters).
EXACT, TORQUE = 1e-4, 1e-2


def reference(problem: Problem):
    """A tight solution of a problem with rows, by an active-set method; none of our code."""
    equal = problem.low == problem.high
    answer = qpsolvers.solve_problem(
        qpsolvers.Problem(
            problem.H,
            problem.f,
            problem.G[~equal] if (~equal).any() else None,
            problem.high[~equal] if (~equal).any() else None,
            problem.G[equal] if equal.any() else None,
            problem.low[equal] if equal.any() else None,
            problem.lower,
            problem.upper,
        ),
        "daqp",
        primal_tol=1e-11,
        dual_tol=1e-11,
    )
    assert answer.found
    return answer.x


def literal_answer(world, stack, state, problem=None):
    x = reference(problem or literal.assemble(stack, world.model, state))
    nv, nu, m = world.mj.nv, world.mj.nu, stack.contacts
    return Answer(x[nv : nv + nu], x[nv + nu : -1].reshape(m, 3), float(x[-1]), None)


def assert_same(stack, found, expected, tolerance=TORQUE):
    assert found.solution.solved, found.solution.reason
    assert np.abs(found.torque - expected.torque).max() <= tolerance
    assert found.blend == pytest.approx(expected.blend, abs=1e-4)
    rates = stack.maps @ (found.force - expected.force).ravel()
    scale = 1 + np.abs(stack.maps @ expected.force.ravel()).max()
    assert np.abs(rates).max() <= 1e-4 * scale


def weighed(command, linear=None, spin=None, contact=None, pose=None, force=None):
    """A roll's command with other weights where they are given."""
    command = command.copy()
    for task, weight in zip(command.tasks, (linear, spin), strict=True):
        if weight is not None:
            task["weight"] = weight
    held = {"weight": contact, "force": force}
    held = {name: value for name, value in held.items() if value is not None}
    tracked = {} if pose is None else {"weight": pose}
    return command._replace(
        contact=replace(command.contact, **held),
        pose=replace(command.pose, **tracked),
    )


def within_cone(force, mu, slack):
    normal = force[:, 0]
    return (normal >= -slack).all() and (np.abs(force[:, 1:]) <= mu * normal[:, None] + slack).all()


# ---------------------------------------------------------------- the literal form is eq. 2


def dynamics(world, stack, state, torque, force):
    """qddot (nv,) from M qddot + C = S' tau + J' lambda, densely."""
    M = np.zeros((world.mj.nv, world.mj.nv))
    mujoco.mj_fullM(world.mj, state.data, M)
    pushed = stack.jacobian.T @ force.ravel()
    pushed[6:] += torque
    return np.linalg.solve(M, pushed - state.bias)


def paper_cost(world, stack, state, torque, force, blend):
    """Eq. 2 with its objectives written out; rates of L and H by differences, not by matrices."""
    acceleration = dynamics(world, stack, state, torque, force)
    rates = world.rates_by_difference(state.position, state.velocity, acceleration)
    after = stack.jacobian @ (state.velocity + stack.period * acceleration)
    wanted = blend * stack.pose_a + (1 - blend) * stack.pose_b
    miss, weight = stack.rate_wanted - rates, stack.rate_weight  # their axes are the world's
    return 0.5 * (
        weight @ miss**2
        + stack.pose.weight * (wanted - torque) @ (wanted - torque)
        + stack.contact.weight / stack.period**2 * after @ after
        + stack.contact.force * (force**2).sum()
        + stack.blend_weight * (blend - stack.blend) ** 2
    )


def test_literal_cost_is_the_paper_s(world, supported):
    rng = np.random.default_rng(0)
    for step in supported[::8]:
        state, stack = world.stack(step)
        problem = literal.assemble(stack, world.model, state)
        constant, costs, papers = None, [], []
        for _ in range(3):
            torque = 50 * rng.normal(size=world.mj.nu)
            force = 100 * rng.normal(size=(stack.contacts, 3))
            blend = rng.uniform()
            acceleration = dynamics(world, stack, state, torque, force)
            x = np.concatenate((acceleration, torque, force.ravel(), [blend]))
            costs.append(problem.objective(x))
            papers.append(paper_cost(world, stack, state, torque, force, blend))
            rows = problem.G[: world.mj.nv] @ x - problem.low[: world.mj.nv]
            assert np.abs(rows).max() < 1e-6  # the equality is the dynamics
        constant = np.subtract(papers, costs)  # 1/2 b'Wb, the same for every x
        assert np.ptp(constant) < 1e-5 * np.abs(papers).max()


def test_literal_momentum_matrix(world, steps):
    """Against MuJoCo's own momentum matrices."""
    for step in steps[::25]:
        state = world.state(step)
        M = np.zeros((world.mj.nv, world.mj.nv))
        mujoco.mj_fullM(world.mj, state.data, M)
        _, stack = world.stack(step)
        (momentum, *_) = literal.objectives(stack, world.model, state, M)
        linear, angular = np.zeros((2, 3, world.mj.nv))
        mujoco.mj_jacSubtreeCom(world.mj, state.data, linear, 1)
        mujoco.mj_angmomMat(world.mj, state.data, angular, 1)
        found = momentum.A[:, : world.mj.nv]
        assert np.abs(found[:3] - world.model.mass * linear).max() < 1e-10
        assert np.abs(found[3:] - angular).max() < 1e-10


def test_contacts_keep_still_though_limbs_turn(world, supported):
    """With `centripetal` they get the accelerations that are wanted, by differences of velocity."""
    rng, tiny, most = np.random.default_rng(1), 1e-5, 0.0
    for step in supported[::8]:
        command = weighed(step.command)
        counting = replace(command.contact, centripetal=True)
        state, stack = world.stack(step, command._replace(contact=counting))
        _, plain = world.stack(step, command)
        bodies = state.contacts.body[command.candidates(state)]
        places = state.contacts.position[command.candidates(state)]
        rates = 10 * rng.normal(size=world.mj.nv)
        gained = np.zeros((len(bodies), 3))
        for h in (-tiny, tiny):
            moved = step.position.copy()
            change = step.velocity * h + 0.5 * rates * h**2
            mujoco.mj_integratePos(world.mj, moved, change, 1.0)
            data = world.data(moved, step.velocity + h * rates)
            for i, (body, place) in enumerate(zip(bodies, places, strict=True)):
                turn = state.data.xmat[body].reshape(3, 3)
                own = turn.T @ (place - state.data.xpos[body])  # the body's point that touches
                now = data.xpos[body] + data.xmat[body].reshape(3, 3) @ own
                jacobian = np.zeros((3, world.mj.nv))
                mujoco.mj_jac(world.mj, data, jacobian, None, now, body)
                gained[i] += np.sign(h) * (jacobian @ data.qvel) / (2 * tiny)
        along = np.einsum("mij,mj->mi", stack.frame, gained).ravel()
        assert stack.jacobian @ rates - stack.wanted[: len(along)] == pytest.approx(
            along - plain.wanted[: len(along)], abs=1e-4
        )
        most = max(most, np.abs(stack.wanted - plain.wanted).max())
    assert most > 1.0  # [m/s2]


# ---------------------------------------------------------------- the condensed form equals it


@pytest.mark.parametrize(("solver", "tolerance"), [("boxqp", TORQUE), ("qpsolvers:daqp", EXACT)])
def test_condensed_equals_literal(world, steps, solver, tolerance):
    """All recorded steps, first pass."""
    chosen = make_solver(solver)
    for step in steps:
        state, stack = world.stack(step)
        expected = literal_answer(world, stack, state)
        assert_same(stack, condensed.solve(stack, chosen), expected, tolerance)


def test_condensed_equals_literal_over_kept_contacts(world, supported):
    """The second pass; `subset` must give what a fresh collection over those contacts gives."""
    rng = np.random.default_rng(0)
    for step in supported[::2]:
        state, stack = world.stack(step)
        stack.mobility, stack.actuation_square, stack.momentum_square, stack.momentum_pull  # noqa: B018
        keep = rng.uniform(size=stack.contacts) < 0.6
        part = stack.subset(keep)
        assert part.contacts == keep.sum()
        expected = literal_answer(world, part, state)
        assert_same(part, condensed.solve(part, BoxQP()), expected)


@pytest.mark.parametrize("share", [1.0, 0.3])
def test_poses_by_acceleration_are_the_same_in_both_forms(world, supported, share):
    """With and without binding limits."""
    settings, blends = replace(world.settings, tracking="acceleration"), []
    for step in supported[::6]:
        command = weighed(step.command, pose=1e-3)
        state, stack = world.stack(step, command, settings)
        stack = replace(stack, torque_limit=share * stack.torque_limit)
        found = condensed.solve(stack, make_solver("qpsolvers:daqp"))
        assert_same(stack, found, literal_answer(world, stack, state))
        blends.append(found.blend)
    assert np.ptp(blends) > 0.1


def test_heavy_poses_by_acceleration_are_what_the_joints_do(world, supported):
    """The blend of both springs, each solved for the end of the period, whatever the contacts."""
    settings = replace(world.settings, tracking="acceleration")
    for step in supported[::12]:
        command = weighed(step.command, 1e-9, 1e-9, 1e-9, pose=1e3)
        state, stack = world.stack(step, command, settings)
        stack = replace(stack, torque_limit=1e6 * stack.torque_limit)
        found = condensed.solve(stack, make_solver("qpsolvers:daqp"))
        joints, h = world.model.joints, max(command.pose.horizon, stack.period)
        moves = dynamics(world, stack, state, found.torque, found.force)[joints]
        blended = found.blend * command.pose_a + (1 - found.blend) * command.pose_b
        velocity = state.velocity[joints]
        away = blended - state.position[7:] - h * velocity
        expected = command.pose.stiffness * away - command.pose.damping * (velocity + h * moves)
        assert moves == pytest.approx(expected, abs=1e-3 * np.abs(moves).max())


@pytest.mark.parametrize("share", [0.5, 0.15])
@pytest.mark.parametrize(("solver", "tolerance"), [("boxqp", TORQUE), ("qpsolvers:daqp", EXACT)])
def test_binding_torque_limits(world, supported, share, solver, tolerance):
    binding, chosen = 0, make_solver(solver)
    for step in supported[::4]:
        state, stack = world.stack(step)
        stack = replace(stack, torque_limit=share * stack.torque_limit)
        found = condensed.solve(stack, chosen)
        if solver == "boxqp" and not found.solution.solved:  # it stops short now and then
            found = condensed.solve(stack, ActiveSet())  # takes over in a run, too
        assert (np.abs(found.torque) <= stack.torque_limit + 1e-5).all()
        assert_same(stack, found, literal_answer(world, stack, state), tolerance)
        binding += int((np.abs(found.torque) >= stack.torque_limit - 1e-6).any())
    assert binding >= 10


def test_literal_solve_reads_the_solution_in_order(world, supported):
    solver = make_solver("qpsolvers:daqp")
    for step in supported[::10]:
        state, stack = world.stack(step)
        found = literal.solve(stack, world.model, state, solver)
        assert_same(stack, found, literal_answer(world, stack, state))


def test_forces_stay_in_the_friction_pyramid(world, supported):
    """With a slippery ground in mind the pyramid binds, and its four sides all occur."""
    sides = np.zeros((2, 2), dtype=bool)
    for step in supported:
        _, stack = world.stack(step)
        stack = replace(stack, friction=0.2)
        force = condensed.solve(stack, BoxQP()).force
        assert within_cone(force, 0.2, 1e-6 * (1 + np.abs(force).max()))
        pressed = force[force[:, 0] > 10.0]
        limit = 0.2 * pressed[:, :1] * (1 - 1e-6)
        sides |= np.array([(pressed[:, 1:] >= limit).any(0), (pressed[:, 1:] <= -limit).any(0)])
    assert sides.all()


# ---------------------------------------------------------------- no contacts


def test_without_contacts_the_blend_is_tracked(world):
    position, velocity = world.in_the_air(1)
    step = replace(world.steps[10], position=position, velocity=velocity, blend=0.3)
    state, stack = world.stack(step)
    found = condensed.solve(stack, BoxQP())
    assert stack.contacts == 0
    assert found.force.shape == (0, 3)
    wide = replace(stack, torque_limit=np.full(world.mj.nu, 1e6))
    free = condensed.solve(wide, BoxQP())
    assert free.blend == pytest.approx(0.3, abs=1e-6)
    assert free.torque == pytest.approx(0.3 * stack.pose_a + 0.7 * stack.pose_b, abs=1e-3)
    tight = replace(stack, torque_limit=np.full(world.mj.nu, 1.0))
    assert_same(tight, condensed.solve(tight, BoxQP()), literal_answer(world, tight, state))


# ---------------------------------------------------------------- weights


def without(world, stack, state, index, rows=slice(None)):
    """The literal problem with objective `index` (or some of its rows) left out."""
    M = np.zeros((world.mj.nv, world.mj.nv))
    mujoco.mj_fullM(world.mj, state.data, M)
    problem = literal.assemble(stack, world.model, state)
    H, f = np.zeros_like(problem.H), np.zeros_like(problem.f)
    for i, objective in enumerate(literal.objectives(stack, world.model, state, M)):
        keep = np.ones(len(objective.b), dtype=bool)
        if i == index:
            keep[rows] = False
        A, b, W = objective.A[keep], objective.b[keep], objective.W[keep]
        H += A.T @ (W[:, None] * A)
        f -= A.T @ (W * b)
    return replace(problem, H=H, f=f)


@pytest.mark.parametrize(
    ("weights", "index", "rows"),
    [
        ({"linear": 0.0}, 0, [0, 1, 2]),
        ({"spin": 0.0}, 0, [3, 4, 5]),
        ({"spin": [0.0, 3.3, 0.0]}, 0, [3, 5]),
        ({"contact": 0.0}, 1, slice(None)),
    ],
)
def test_zero_weight_equals_absent(world, supported, weights, index, rows):
    for step in supported[::12]:
        state, full = world.stack(step)
        _, stack = world.stack(step, weighed(step.command, **weights))
        absent = without(world, full, state, index, rows)
        found = condensed.solve(stack, BoxQP())
        assert_same(stack, found, literal_answer(world, stack, state, absent))


def test_zero_contact_weight_leaves_the_pose_torques(world, supported):
    """Nothing then ties the torques to the contact forces."""
    for step in supported[::12]:
        _, stack = world.stack(step, weighed(step.command, contact=0.0))
        stack = replace(stack, torque_limit=np.full(world.mj.nu, 1e6))
        found = condensed.solve(stack, BoxQP())
        expected = found.blend * stack.pose_a + (1 - found.blend) * stack.pose_b
        assert found.torque == pytest.approx(expected, abs=1e-6)


def test_zero_pose_weight_ignores_the_poses(world, supported):
    """Torques are then not unique, and boxqp may say so; it must not fail often."""
    solved, tried = 0, supported[::6]
    for step in tried:
        _, stack = world.stack(step, weighed(step.command, pose=0.0))
        other = replace(stack, pose_a=stack.pose_b + 50.0, pose_b=stack.pose_a)
        found, again = condensed.solve(stack, BoxQP()), condensed.solve(other, BoxQP())
        assert found.torque.tolist() == again.torque.tolist()
        assert (np.abs(found.torque) <= stack.torque_limit + 1e-6).all()
        if found.solution.solved:
            solved += 1
            assert found.blend == pytest.approx(stack.blend, abs=1e-4)
    assert solved >= 0.8 * len(tried)


def test_zero_pose_weight_without_contacts(world):
    position, velocity = world.in_the_air(2)
    command = weighed(world.steps[0].command, pose=0.0)
    step = replace(world.steps[0], position=position, velocity=velocity, command=command)
    _, stack = world.stack(step)
    found = condensed.solve(stack, BoxQP())
    assert found.solution.solved
    assert np.abs(found.torque).max() < 1e-6


def test_everything_off_but_the_pose(world, supported):
    step = supported[3]
    _, stack = world.stack(step, weighed(step.command, linear=0.0, spin=0.0, contact=0.0))
    stack = replace(stack, torque_limit=np.full(world.mj.nu, 1e6))
    found = condensed.solve(stack, BoxQP())
    assert np.abs(found.force).max() < 1e-6
    expected = stack.blend * stack.pose_a + (1 - stack.blend) * stack.pose_b
    assert found.torque == pytest.approx(expected, abs=1e-3)


# ---------------------------------------------------------------- targets


def test_a_target_that_is_met_is_kept(world, supported):
    """Poses, momentum rates and still contacts that fit together cost nothing at all."""
    tried = 0
    for step in supported[::6]:
        state, stack = world.stack(step, weighed(step.command, force=1e-9))
        m = stack.contacts
        if m > 4:
            continue  # more contact rows than torques can serve
        force = np.tile([150.0, 20.0, -10.0], (m, 1))
        still = -(stack.mobility @ force.ravel() + stack.drift)
        torque = np.linalg.lstsq(stack.actuation, still, rcond=None)[0]
        if np.abs(stack.actuation @ torque - still).max() > 1e-6:
            continue
        tried += 1
        stack = replace(
            stack,
            rate_wanted=stack.maps @ force.ravel() + stack.free_rates,
            pose_a=torque,
            pose_b=torque,
            torque_limit=np.full(world.mj.nu, 2 * np.abs(torque).max()),
        )
        found = condensed.solve(stack, BoxQP())
        scale = 1 + np.abs(torque).max()
        assert found.torque == pytest.approx(torque, abs=1e-4 * scale)
        predicted = stack.maps @ found.force.ravel() + stack.free_rates
        wanted = stack.rate_wanted
        assert predicted == pytest.approx(wanted, abs=1e-3 * (1 + np.abs(wanted).max()))
        assert found.blend == pytest.approx(stack.blend, abs=1e-4)
        cost = paper_cost(world, stack, state, found.torque, found.force, found.blend)
        assert cost < 1e-4 * stack.pose.weight * torque @ torque
    assert tried >= 3


def test_predicted_rates_come_true(world, supported):
    """Obey the torques and forces: L and H then change as the controller said."""
    for step in supported[::6]:
        state, _ = world.stack(step)
        force = step.decision.force.ravel()
        frames = state.contacts.frame
        along = np.einsum("mij,mj->mi", frames, force.reshape(-1, 3))
        M = np.zeros((world.mj.nv, world.mj.nv))
        mujoco.mj_fullM(world.mj, state.data, M)
        pushed = contact_jacobian(world.mj, state.data, state.contacts).T @ along.ravel()
        pushed[6:] += step.decision.torque
        acceleration = np.linalg.solve(M, pushed - state.bias)
        measured = world.rates_by_difference(step.position, step.velocity, acceleration)
        expected = step.decision.rates_predicted
        assert measured == pytest.approx(expected, abs=1e-4 * (1 + np.abs(expected).max()))


def test_mu_of_the_controller_is_used(world, supported):
    settings: ControllerSettings = replace(world.settings, friction=0.05)
    _, stack = world.stack(supported[0], settings=settings)
    assert stack.friction == 0.05
    force = condensed.solve(stack, BoxQP()).force
    assert within_cone(force, 0.05, 1e-6 * (1 + np.abs(force).max()))
