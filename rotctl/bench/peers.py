"""A control step of rotctl beside those of its peers, on the same states of a forward roll.

`make peers` runs it in an environment of its own: the peers are no part of rotctl. Each time is of
one state from positions and velocities to torques, kinematics and dynamics included:

- rotctl: `mj_step1`, which finds the contacts too, then the compiled step: both passes.
- Pinocchio with DAQP or ProxQP: mass matrix, bias and Jacobians, the same objectives over
  [qddot, lambda, gamma] for the contacts that rotctl's second pass uses, one solve.
- placo: its own question on as many point contacts, as it has no gamma and no momenta: the centre
  of mass and each body's attitude, one solve; so its torques are compared with nobody's.
"""

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np

from rotctl.bench.states import Recorded, record_roll, restore
from rotctl.config.loading import load
from rotctl.control import Controller
from rotctl.control.cone import friction_rows
from rotctl.control.pose import PoseTracker
from rotctl.control.stack import Stack, collect
from rotctl.maths.rotations import Array
from rotctl.mechanics.contacts import Contacts
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State, read
from rotctl.runs.scenario import build

STATES, ROUNDS = 150, 3
TRUTH = ["controller.solver=qpsolvers:daqp"]  # exact, on the condensed form


class Question(NamedTuple):
    """What peers are given of a state: positions and velocities in their order, and the wishes."""

    position: Array
    velocity: Array
    passive: Array
    bodies: list[str]
    contacts: Contacts
    wishes: Stack
    answer: Array
    recorded: Recorded


Step = Callable[[Question], Array | None]


def compare() -> str:
    """A table over `STATES` states of a 20 s roll, one peer after the other, in rounds."""
    scenario = build(load(["duration=20"]))
    recorded = record_roll(scenario, 1200)[:: 1200 // STATES]
    model = scenario.model
    exact = Controller(model, load(TRUTH).controller)
    asked = [_question(model, exact, one) for one in recorded]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "model.xml")
        path.write_text(model.mjcf)
        peers: dict[str, Step] = {
            "Pinocchio, qpsolvers:daqp": Pinocchio(path, "daqp").step,
            "Pinocchio, qpsolvers:proxqp": Pinocchio(path, "proxqp").step,
            "placo (another question)": Placo(path).step,
        }
    ours = Ours(model)
    steps: dict[str, Step] = {"rotctl": ours.whole, "  without mj_step1": ours.decision, **peers}
    times = {name: np.full(len(asked), np.inf) for name in steps}
    errors: dict[str, list[float]] = {name: [] for name in steps}
    for turn in range(ROUNDS):
        for name, step in steps.items():
            for i, question in enumerate(asked):
                ours.restore(question.recorded)
                begin = time.perf_counter()
                torque = step(question)
                times[name][i] = min(times[name][i], time.perf_counter() - begin)
                if turn == 0 and torque is not None:
                    errors[name].append(float(np.abs(torque - question.answer).max()))
    return _table(times, errors, [len(question.bodies) for question in asked])


def _table(times: dict[str, Array], errors: dict[str, list[float]], contacts: list[int]) -> str:
    lines = [
        f"{STATES} states of a forward roll, {np.mean(contacts):.1f} contacts on average,"
        f" least of {ROUNDS} rounds",
        "",
        f"{'':30}{'time [us]':>16}{'x rotctl':>10}{'torque error [N m]':>24}",
        f"{'':30}{'median':>8}{'p95':>8}{'':10}{'median':>12}{'max':>12}",
    ]
    for name, taken in times.items():
        factor = np.median(taken) / np.median(times["rotctl"])
        error = errors[name]
        cells = f"{np.median(error):12.1e}{np.max(error):12.1e}" if error else f"{'-':>12}{'-':>12}"
        lines.append(
            f"{name:30}{1e6 * np.median(taken):8.0f}{1e6 * np.percentile(taken, 95):8.0f}"
            f"{factor:10.1f}{cells}"
        )
    return "\n".join(lines)


def _question(model: Model, exact: Controller, one: Recorded) -> Question:
    mj, data = model.mj, mujoco.MjData(model.mj)
    restore(model, data, one)
    state = read(model, data, merging=exact.settings.merging)
    poses = np.array((one.command.pose_a, one.command.pose_b))
    torques = PoseTracker(model, 1.0 / exact.settings.rate).torques(state, poses, one.command.pose)
    stack = collect(model, state, one.command, exact.settings, torques, one.blend)
    decision = exact.decide(state, one.command, one.blend)
    keep = decision.used
    contacts = Contacts(**{name: of[keep] for name, of in vars(state.contacts).items()})
    return Question(
        position=one.position[[0, 1, 2, 4, 5, 6, 3, *range(7, mj.nq)]],  # theirs are (x, y, z, w)
        velocity=_in_body(state, one.velocity),
        passive=_in_body(state, data.qfrc_passive.copy()),
        bodies=[mj.body(int(body)).name for body in contacts.body],
        contacts=contacts,
        wishes=stack.subset(keep[one.command.candidates(state)]),
        answer=decision.torque,
        recorded=one,
    )


def _in_body(state: State, along: Array) -> Array:
    """The root's first three in its own axes, as Pinocchio has them, not in the world's."""
    return np.concatenate((state.momentum.root_rotation.T @ along[:3], along[3:]))


class Ours:
    """rotctl, compiled."""

    def __init__(self, model: Model) -> None:
        """Of the model itself."""
        self._model, self._data = model, mujoco.MjData(model.mj)
        self._controller = Controller(model, load([]).controller)

    def restore(self, recorded: Recorded) -> None:
        """Put a state into MuJoCo's data, evaluated."""
        restore(self._model, self._data, recorded)

    def whole(self, asked: Question) -> Array:
        """Torques (nu,) from a state."""
        mujoco.mj_step1(self._model.mj, self._data)
        return self.decision(asked)

    def decision(self, asked: Question) -> Array:
        """Torques (nu,) from a state that is evaluated."""
        controller, one = self._controller, asked.recorded
        state = controller.read(self._data)
        return controller.decide(state, one.command, one.blend).torque


def _at_origin(model: Any) -> Any:
    """Its positions of the root are from where the file has drawn it; here from the origin."""
    model.jointPlacements[1] = type(model.jointPlacements[1]).Identity()
    return model


class Pinocchio:
    """The same objectives with Pinocchio's numbers."""

    def __init__(self, path: Path, solver: str) -> None:
        """Of the model in a file."""
        import pinocchio
        import qpsolvers

        self._pin, self._qp, self._solver = pinocchio, qpsolvers, solver
        self._model = _at_origin(pinocchio.buildModelFromMJCF(str(path)))
        self._data = self._model.createData()

    def step(self, asked: Question) -> Array | None:
        """Torques (nu,), or None where it does not solve."""
        pin, model, data, wishes = self._pin, self._model, self._data, asked.wishes
        nv, m, nu = model.nv, wishes.contacts, model.nv - 6
        mass = pin.crba(model, data, asked.position)
        mass = np.triu(mass) + np.triu(mass, 1).T
        bias = pin.nonLinearEffects(model, data, asked.position, asked.velocity) - asked.passive
        pin.computeJointJacobians(model, data, asked.position)
        pin.updateFramePlacements(model, data)
        com = pin.centerOfMass(model, data, asked.position)
        jacobian, maps = np.zeros((3 * m, nv)), np.zeros((6, 3 * m))
        for i, (body, place) in enumerate(zip(asked.bodies, asked.contacts.position, strict=True)):
            frame = model.getFrameId(body)
            whole = pin.getFrameJacobian(model, data, frame, pin.LOCAL_WORLD_ALIGNED)
            arm, axes = place - data.oMf[frame].translation, wishes.frame[i]
            jacobian[3 * i : 3 * i + 3] = axes @ (whole[:3] - pin.skew(arm) @ whole[3:])
            maps[:3, 3 * i : 3 * i + 3] = axes.T
            maps[3:, 3 * i : 3 * i + 3] = pin.skew(place - com) @ axes.T
        turning = np.zeros(nv)  # its accelerations of the root are in turning axes
        turning[:3] = -np.cross(asked.velocity[3:6], asked.velocity[:3])
        wanted = wishes.wanted[: 3 * m] + jacobian @ turning
        torque = np.concatenate((mass[6:], -jacobian[:, 6:].T, np.zeros((nu, 1))), axis=1)
        n = nv + 3 * m + 1
        H, f = np.zeros((n, n)), np.zeros(n)

        def want(rows: Array, goal: Array, weight: Array | float, first: int = 0) -> None:
            """1/2 |rows x - goal|^2, weighted, of the columns from `first` on."""
            part = slice(first, first + rows.shape[1])
            weighted = rows.T * weight
            H[part, part] += weighted @ rows
            f[part] -= weighted @ goal

        want(jacobian, wanted, wishes.weight[: 3 * m])
        rates = wishes.rate_wanted - wishes.rate_rows @ wishes.free_rates
        want(wishes.rate_rows @ maps, rates, wishes.rate_weight, nv)
        tracking = torque.copy()
        tracking[:, -1] -= wishes.pose_a - wishes.pose_b
        want(tracking, wishes.pose_b - bias[6:], wishes.pose.weight)
        want(np.eye(3 * m), np.zeros(3 * m), wishes.contact.force, nv)
        want(np.ones((1, 1)), np.array([wishes.blend]), wishes.blend_weight, n - 1)
        root = np.concatenate((mass[:6], -jacobian[:, :6].T, np.zeros((6, 1))), axis=1)
        low, high = np.full(n, -np.inf), np.full(n, np.inf)
        low[nv : n - 1 : 3], low[-1], high[-1] = 0.0, 0.0, 1.0
        rows = np.concatenate((torque, -torque, friction_rows(nv, m, 1, wishes.friction)))
        limit = wishes.torque_limit
        most = np.concatenate((limit - bias[6:], limit + bias[6:], np.zeros(4 * m)))
        found = self._qp.solve_qp(H, f, rows, most, root, -bias[:6], low, high, solver=self._solver)
        return None if found is None else np.asarray(torque @ found + bias[6:])


class Placo:
    """placo's dynamics solver, as its examples use it."""

    def __init__(self, path: Path) -> None:
        """Of the model in a file."""
        import placo

        self._placo = placo
        self._robot = placo.RobotWrapper(str(path), placo.Flags.mjcf)
        _at_origin(self._robot.model)
        self._solvers: dict[int, Any] = {}

    def step(self, asked: Question) -> None:
        """Solve; a solver with its tasks is made once a state, and not timed from then on."""
        robot = self._robot
        robot.state.q, robot.state.qd = asked.position, asked.velocity
        robot.update_kinematics()
        key = id(asked)
        if key not in self._solvers:
            self._solvers[key] = self._made(asked)
        self._solvers[key].solve()

    def _made(self, asked: Question) -> Any:
        robot, solver = self._robot, self._placo.DynamicsSolver(self._robot)
        for body in asked.bodies:
            place = robot.get_T_world_frame(body)[:3, 3]
            contact = solver.add_point_contact(solver.add_position_task(body, place))
            contact.mu = asked.wishes.friction
        solver.add_com_task(robot.com_world()).configure("com", "soft", 1.0)
        for body in dict.fromkeys(robot.frame_names()):
            if not body.startswith(("universe", "root", "Composite", "elbow", "knee")):
                attitude = robot.get_T_world_frame(body)[:3, :3]
                solver.add_orientation_task(body, attitude).configure(body, "soft", 1e-2)
        return solver
