"""The kinds of objective: what each asks of the acceleration.

An objective is k weighted rows, 1/2 |R qddot - wanted|^2_W. A kind of *motion* gives R (k, nv)
itself. A kind of *momentum* gives rows over [Ldot, Hdot] instead: with A the momentum matrix,
R = rows A, and as joint torques do not move a momentum, contact forces alone meet it.

Each kind is one function here, and one of the same name in `native/kinds.c`; a behaviour asks
for it by that name. Errors, velocities and gains are along the task's axes.
"""

from collections.abc import Callable
from dataclasses import dataclass

import mujoco
import numpy as np

from rotctl.control.task import Tasks
from rotctl.errors import InputError
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array, rotation_to
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State
from rotctl.suggestion import instead


@dataclass(frozen=True)
class Rows:
    """One task's rows.

    Attributes:
        matrix: (k, nv) over qddot, or (k, 6) over [Ldot, Hdot].
        wanted: (k,) what they should give.
        weight: (k,).
        error: (3,) how far the task is from its target, for the log [m, rad].
    """

    matrix: Array
    wanted: Array
    weight: Array
    error: Array


@dataclass(frozen=True)
class Kind:
    """A kind of objective.

    Attributes:
        number: as tasks carry it.
        momentum: whether its rows are over [Ldot, Hdot], or over qddot.
        rows: of a task at a state.
    """

    number: int
    momentum: bool
    rows: Callable[[Tasks, Model, State], Rows]


KINDS: dict[str, Kind] = {}


def _kind(momentum: bool) -> Callable[[Callable[[Tasks, Model, State], Rows]], Kind]:
    def register(rows: Callable[[Tasks, Model, State], Rows]) -> Kind:
        KINDS[rows.__name__] = Kind(len(KINDS), momentum, rows)
        return KINDS[rows.__name__]

    return register


def kind(name: str) -> Kind:
    """A kind by its name.

    Raises:
        InputError: there is no such kind.
    """
    if name not in KINDS:
        raise InputError(f"no kind of task {name!r}; {instead(name, KINDS)}")
    return KINDS[name]


@_kind(momentum=True)
def linear(task: Tasks, model: Model, state: State) -> Rows:
    """The centre of mass, by the rate of L, [Brown2013] eq. 3. Target a place; weight 1/N2."""
    momentum = state.momentum
    wanted, error = _wish(task, task["target"][:3] - momentum.com, momentum.com_velocity)
    rows = np.concatenate((task["axes"], np.zeros((3, 3))), axis=1)
    return Rows(rows, model.mass * wanted, task["weight"], error)


@_kind(momentum=True)
def spin(task: Tasks, model: Model, state: State) -> Rows:
    """The whole body's spin, by the rate of H, eq. 4. Target the missing AE; weight 1/(N m)2."""
    momentum, axes = state.momentum, task["axes"]
    along, error = _wish(task, task["target"][:3], momentum.angular_velocity)
    rate = product(momentum.inertia, product(along, axes))
    rows = np.concatenate((np.zeros((3, 3)), axes), axis=1)
    return Rows(rows, product(axes, rate), task["weight"], error)


@_kind(momentum=True)
def angular_momentum(task: Tasks, model: Model, state: State) -> Rows:
    """The same by AM: velocity is H [kg m2/s] and its error acts as it is; weight 1/(N m)2."""
    momentum, axes = state.momentum, task["axes"]
    error = product(axes, task["target"][:3])
    turning = product(axes, task["acceleration"]) + task["stiffness"] * error
    slip = product(axes, task["velocity"] - momentum.angular)
    rate = product(axes, product(momentum.inertia, product(turning, axes)))
    rows = np.concatenate((np.zeros((3, 3)), axes), axis=1)
    return Rows(rows, rate + task["damping"] * slip, task["weight"], error)


@_kind(momentum=False)
def point(task: Tasks, model: Model, state: State) -> Rows:
    """A point of a body. Target a place; weight 1/(m/s2)2."""
    body = int(task["body"])
    rotation = state.data.xmat[body].reshape(3, 3)
    place = state.data.xpos[body] + product(rotation, task["point"])
    J, J_dot = np.zeros((2, 3, model.mj.nv))
    mujoco.mj_jac(model.mj, state.data, J, None, place, body)
    mujoco.mj_jacDot(model.mj, state.data, J_dot, None, place, body)
    return _motion(task, state, J, J_dot, task["target"][:3] - place)


@_kind(momentum=False)
def attitude(task: Tasks, model: Model, state: State) -> Rows:
    """A body's attitude. Target its orientation, a unit quaternion; weight 1/(rad/s2)2."""
    body = int(task["body"])
    J, J_dot = np.zeros((2, 3, model.mj.nv))
    mujoco.mj_jac(model.mj, state.data, None, J, state.data.xpos[body], body)
    mujoco.mj_jacDot(model.mj, state.data, None, J_dot, state.data.xpos[body], body)
    missing = rotation_to(state.data.xquat[body], task["target"])
    return _motion(task, state, J, J_dot, missing)


@_kind(momentum=False)
def limits(task: Tasks, model: Model, state: State) -> Rows:
    """Joints near their stops, which the optimisation cannot see otherwise.

    Within `point[0]` [rad] of a stop a joint is wanted back at that distance; the weight
    [1/(rad/s2)2] grows from 0 there to its full value at the stop. Gains are the first of each.
    The error is the number of such joints and the largest distance they are to go [rad].
    """
    margin = task["point"][0]
    low, high = model.joint_range.T
    angle, velocity = state.position[model.angles], state.velocity[model.joints]
    back = np.maximum(low + margin - angle, 0.0) - np.maximum(angle - high + margin, 0.0)
    near = np.flatnonzero(back)
    rows = np.zeros((len(near), model.mj.nv))
    rows[np.arange(len(near)), near + model.joints.start] = 1.0
    wanted = task["stiffness"][0] * back[near] - task["damping"][0] * velocity[near]
    weight = task["weight"][0] * np.minimum(np.abs(back[near]) / margin, 1.0)
    error = np.array([len(near), np.abs(back).max(initial=0.0), 0.0])
    return Rows(rows, wanted, weight, error)


@_kind(momentum=False)
def joints(task: Tasks, model: Model, state: State) -> Rows:
    """A body's own hinges, in their order. Target their angles [rad]; weight 1/(rad/s2)2.

    Nothing is asked of the root, which has none. Gains are in their order, too.
    """
    mj, (first, count) = model.mj, model.hinges(int(task["body"]))
    angle, dof = first + model.angles.start, first + model.joints.start
    rows = np.zeros((count, mj.nv))
    rows[np.arange(count), np.arange(dof, dof + count)] = 1.0
    error = np.zeros(3)
    error[:count] = task["target"][:count] - state.position[angle : angle + count]
    slip = task["velocity"][:count] - state.velocity[dof : dof + count]
    wanted = task["acceleration"][:count] + task["stiffness"][:count] * error[:count]
    return Rows(rows, wanted + task["damping"][:count] * slip, task["weight"][:count], error)


def _motion(task: Tasks, state: State, J: Array, J_dot: Array, missing: Array) -> Rows:
    """Rows of a Jacobian (3, nv) along the axes; `missing` (3,) to the target, world."""
    wanted, error = _wish(task, missing, product(J, state.velocity))
    rest = product(task["axes"], product(J_dot, state.velocity))
    return Rows(product(task["axes"], J), wanted - rest, task["weight"], error)


def _wish(task: Tasks, missing: Array, velocity: Array) -> tuple[Array, Array]:
    """What acceleration, stiffness and damping ask for, and the error, (3,) along the axes."""
    axes = task["axes"]
    error = product(axes, missing)
    slip = product(axes, task["velocity"] - velocity)
    along = product(axes, task["acceleration"])
    return along + task["stiffness"] * error + task["damping"] * slip, error
