"""Every kind of objective: its rows against differences, its targets against other geometry.

What is parametrised over `KINDS` takes in a new kind by itself.
"""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from questions import any_task, with_tasks
from scipy.spatial.transform import Rotation

from rotctl.control import literal
from rotctl.control.kinds import KINDS, kind
from rotctl.errors import InputError
from rotctl.mechanics.state import read

TINY = 1e-5  # [s] of central differences


@pytest.fixture(scope="module")
def states(world, steps):
    """(position, velocity): of rolls on the ground, and of flights."""
    found = [(step.position, step.velocity) for step in steps[::24]]
    return found + [world.in_the_air(seed, speed=3.0) for seed in range(5)]


def task_of(name, world, rng, **changes):
    """One task, with whatever is given in place of random numbers."""
    task = any_task(name, world.model, rng)
    for field, value in changes.items():
        task[field] = value
    return task


def rows_at(world, position, velocity, task):
    state = read(world.model, world.data(position, velocity))
    return KINDS[list(KINDS)[task["kind"][0]]].rows(task[0], world.model, state)


def moved(world, position, velocity, acceleration, time):
    """Position and velocity a little later, or earlier."""
    after = position.copy()
    change = velocity * time + 0.5 * acceleration * time**2
    mujoco.mj_integratePos(world.mj, after, change, 1.0)
    return after, velocity + acceleration * time


def difference(world, position, velocity, acceleration, measure):
    """d/dt of measure(position, velocity) along an acceleration."""
    before, after = (
        measure(*moved(world, position, velocity, acceleration, time)) for time in (-TINY, TINY)
    )
    return (after - before) / (2 * TINY)


# ---------------------------------------------------------------- every kind


@pytest.mark.parametrize("name", KINDS)
def test_with_no_gains_the_rows_are_the_rate_of_what_they_measure(world, states, name):
    """d/dt (R qdot) = R qddot - wanted: dR/dt qdot is taken off what is wanted, and no more.

    Of momenta, R is the rows times the momentum matrix.
    """
    rng, seen = np.random.default_rng(0), 0
    nothing = dict.fromkeys(("velocity", "acceleration", "stiffness", "damping"), 0.0)
    for position, velocity in states:
        task = task_of(name, world, rng, **nothing)
        acceleration = 10 * rng.normal(size=world.mj.nv)
        rows = rows_at(world, position, velocity, task)
        if KINDS[name].momentum:
            step = replace(world.steps[0], position=position, velocity=velocity)
            state, stack = world.stack(step, step.command._replace(tasks=task))
            M = np.zeros((world.mj.nv, world.mj.nv))
            mujoco.mj_fullM(world.mj, state.data, M)
            (momenta, *_) = literal.objectives(stack, world.model, state, M)
            found = momenta.A[:, : world.mj.nv] @ acceleration - momenta.b
            rates = world.rates_by_difference(position, velocity, acceleration)
            expected = rows.matrix @ rates
        else:

            def measured(at, speed, task=task):
                return rows_at(world, at, speed, task).matrix @ speed

            found = rows.matrix @ acceleration - rows.wanted
            expected = difference(world, position, velocity, acceleration, measured)
        scale = 1 + np.abs(expected).max(initial=0.0)
        assert found == pytest.approx(expected, abs=1e-5 * scale)
        seen += len(found)
    assert seen >= 10


@pytest.mark.parametrize("name", KINDS)
def test_what_is_wanted_is_linear_in_the_gains(world, states, name):
    rng = np.random.default_rng(1)
    for position, velocity in states:
        task = task_of(name, world, rng)
        wanted = {}
        for stiffness in (0, 1, 3):
            for damping in (0, 1, 3):
                changed = task.copy()
                changed["stiffness"] *= stiffness
                changed["damping"] *= damping
                wanted[stiffness, damping] = rows_at(world, position, velocity, changed).wanted
        rest, pull, brake = wanted[0, 0], wanted[1, 0] - wanted[0, 0], wanted[0, 1] - wanted[0, 0]
        scale = 1 + np.abs(wanted[3, 3]).max(initial=0.0)
        expected = rest + 3 * pull + 3 * brake
        assert wanted[3, 3] == pytest.approx(expected, abs=1e-9 * scale)


@pytest.mark.parametrize("name", KINDS)
def test_weights_errors_and_shapes(world, states, name):
    rng = np.random.default_rng(3)
    for position, velocity in states:
        task = task_of(name, world, rng)
        rows = rows_at(world, position, velocity, task)
        k = len(rows.wanted)
        assert rows.matrix.shape == (k, 6 if KINDS[name].momentum else world.mj.nv)
        assert rows.weight.shape == (k,)
        assert rows.error.shape == (3,)
        assert (rows.weight >= 0).all()
        assert (rows.weight <= task["weight"].max()).all()
        task["weight"] = 0.0
        assert not rows_at(world, position, velocity, task).weight.any()


def test_numbers_are_places_and_unknown_names_are_told():
    assert [found.number for found in KINDS.values()] == list(range(len(KINDS)))
    with pytest.raises(InputError) as caught:
        kind("elbow")
    assert str(caught.value) == f"no kind of task 'elbow'; valid: {', '.join(KINDS)}"


# ---------------------------------------------------------------- geometry of its own


def body_frame(world, position, body):
    """Place and orientation of a body, by kinematics alone."""
    data = mujoco.MjData(world.mj)
    data.qpos[:] = position
    mujoco.mj_kinematics(world.mj, data)
    return data.xpos[body].copy(), Rotation.from_quat(data.xquat[body], scalar_first=True)


@pytest.mark.parametrize("name", ["point", "attitude"])
def test_error_speed_and_gains_along_the_axes(world, states, name):
    rng = np.random.default_rng(4)
    for position, velocity in states:
        task = task_of(name, world, rng)
        body, axes = int(task["body"][0]), task["axes"][0]
        origin, turn = body_frame(world, position, body)
        if name == "point":

            def place(at, speed, task=task, body=body):
                start, orientation = body_frame(world, at, body)
                return start + orientation.apply(task["point"][0])

            missing = task["target"][0, :3] - (origin + turn.apply(task["point"][0]))
            speed = difference(world, position, velocity, np.zeros(world.mj.nv), place)
        else:
            wanted = Rotation.from_quat(task["target"][0], scalar_first=True)
            missing = (wanted * turn.inv()).as_rotvec()
            found = np.empty(6)
            data = world.data(position, velocity)
            kind_of_object = mujoco.mjtObj.mjOBJ_XBODY
            mujoco.mj_objectVelocity(world.mj, data, kind_of_object, body, found, 0)
            speed = found[:3]
        rows = rows_at(world, position, velocity, task)
        assert rows.error == pytest.approx(axes @ missing, abs=1e-9)
        assert rows.matrix @ velocity == pytest.approx(axes @ speed, abs=1e-6)
        assert rows.weight.tolist() == task["weight"][0].tolist()
        free = task.copy()
        for field in ("stiffness", "damping", "velocity", "acceleration"):
            free[field] = 0.0
        wish = rows.wanted - rows_at(world, position, velocity, free).wanted
        expected = (
            axes @ task["acceleration"][0]
            + task["stiffness"][0] * (axes @ missing)
            + task["damping"][0] * (axes @ (task["velocity"][0] - speed))
        )
        assert wish == pytest.approx(expected, abs=1e-5)


def test_an_attitude_that_is_there_lacks_nothing_and_half_a_turn_is_the_shorter_way(world):
    position, velocity = world.in_the_air(3)
    body = world.mj.body("chest").id
    _, turn = body_frame(world, position, body)
    rng = np.random.default_rng(5)
    for axis in np.eye(3):
        for angle in (0.0, 1.0, np.pi - 0.01, np.pi + 0.01, 6.0):
            target = Rotation.from_rotvec(angle * axis) * turn
            for sign in (1.0, -1.0):  # one orientation has two quaternions
                quaternion = sign * target.as_quat(scalar_first=True)
                task = task_of("attitude", world, rng, body=body, axes=np.eye(3), target=quaternion)
                short = (angle + np.pi) % (2 * np.pi) - np.pi
                error = rows_at(world, position, velocity, task).error
                assert error == pytest.approx(short * axis, abs=1e-9)


def test_limits_are_rows_of_the_joints_near_a_stop_and_of_no_others(world):
    rng = np.random.default_rng(6)
    low, high = world.model.joint_range.T
    position, velocity = world.in_the_air(6)
    far = rows_at(world, position, velocity, task_of("limits", world, rng, point=0.02))
    assert len(far.wanted) == 0
    assert far.error.tolist() == [0.0, 0.0, 0.0]
    under, over = 3, 11  # joints: 0.05 rad before its lower stop, 0.02 rad beyond its upper one
    position[7 + under], position[7 + over] = low[under] + 0.05, high[over] + 0.02
    gains = {"stiffness": 100.0, "damping": 7.0, "weight": 2.0}
    task = task_of("limits", world, rng, point=0.08, **gains)
    rows = rows_at(world, position, velocity, task)
    assert np.flatnonzero(rows.matrix[0]).tolist() == [6 + under]
    assert np.flatnonzero(rows.matrix[1]).tolist() == [6 + over]
    assert rows.matrix.sum() == 2.0
    speed = velocity[[6 + under, 6 + over]]
    expected = 100.0 * np.array([0.03, -0.10]) - 7.0 * speed
    assert rows.wanted == pytest.approx(expected, abs=1e-12)
    assert rows.weight == pytest.approx([2.0 * 0.03 / 0.08, 2.0])  # full at the stop and beyond
    assert rows.error == pytest.approx([2.0, 0.10, 0.0], abs=1e-12)


def test_tasks_stand_in_the_order_of_the_command(world, supported):
    """Of motion past the contacts' rows, of momenta by themselves, each where it says."""
    rng = np.random.default_rng(7)
    more = [any_task(name, world.model, rng) for name in ("point", "spin", "attitude", "linear")]
    state, stack = world.stack(supported[3], with_tasks(supported[3].command, *more))
    for task, row in zip(with_tasks(supported[3].command, *more).tasks, stack.tasks, strict=True):
        found = KINDS[list(KINDS)[task["kind"]]]
        expected = found.rows(task, world.model, state)
        assert row.momentum == found.momentum
        at = slice(row.first, row.first + len(expected.wanted))
        if row.momentum:
            assert stack.rate_rows[at].tolist() == expected.matrix.tolist()
            assert stack.rate_wanted[at].tolist() == expected.wanted.tolist()
        else:
            rest = slice(3 * stack.contacts + at.start, 3 * stack.contacts + at.stop)
            assert stack.rows[rest].tolist() == expected.matrix.tolist()
            assert stack.wanted[rest].tolist() == expected.wanted.tolist()
