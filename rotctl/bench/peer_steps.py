"""A control step as Pinocchio and placo make it; they are imported where they are made."""

from pathlib import Path
from typing import Any

import numpy as np

from rotctl.bench.peer_question import Question
from rotctl.control.cone import friction_rows
from rotctl.maths.rotations import Array


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
