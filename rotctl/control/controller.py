"""The whole-body controller: the compiled step, or its reference and a chain of fallbacks."""

from dataclasses import dataclass

import mujoco
import numpy as np

from rotctl.control.compiled import CompiledStep, serves
from rotctl.control.decision import POSE_ONLY, SOLVED_BY_FALLBACK, Decision
from rotctl.control.passes import Link, Rehearsal, pose_only
from rotctl.control.pose import PoseTracker
from rotctl.control.settings import BackendName, ControllerSettings
from rotctl.control.stack import Stack, collect
from rotctl.control.task import Command
from rotctl.errors import InputError
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State, read
from rotctl.native.library import NOT_BUILT, library
from rotctl.qp import Solver, make_solver
from rotctl.qp.active_set import ActiveSet

LOGGED_ROWS = 3  # of each task
LACKS = (
    "no function in C for tasks of kind {kinds}; steps that have one are decided by the numpy "
    "reference, several times slower"
)


class Controller:
    """Reads the state and decides torques; keeps workspaces, but no memory of the past.

    Attributes:
        chain: the ways to solve a step, each for where those before it fail.
        backend: `compiled` or `reference`, whichever really works here.
        notice: what a user should know about that; mostly empty.
        step: the compiled one; None where the reference does all.
    """

    def __init__(
        self, model: Model, settings: ControllerSettings, solver: Solver | None = None
    ) -> None:
        """Make the solvers, the pose tracker and the compiled step.

        Args:
            solver: in place of the one that `settings` name.

        Raises:
            InputError: the solver does not exist here, or cannot solve the chosen form.
        """
        solver = solver or make_solver(settings.solver)
        if settings.form == "literal" and solver.shape == "bounds":
            raise InputError(
                f"controller.form=literal has equality rows, which {solver.name} cannot "
                "solve; choose controller.solver=osqp or controller.solver=qpsolvers:<name>"
            )
        self.model = model
        self.settings = settings
        self._tracker = PoseTracker(model, 1.0 / settings.rate)
        rehearsal = Rehearsal(model)
        self.chain = [Link(settings.form, solver, rehearsal)]
        if (settings.form, solver.name) != ("condensed", "boxqp"):
            self.chain.append(Link("condensed", make_solver("boxqp"), rehearsal))
        self.chain.append(Link("condensed", ActiveSet(), rehearsal))
        wanted = settings.backend == "compiled" and serves(settings, model)
        self.step = CompiledStep(model, settings) if wanted and library() else None
        self.backend: BackendName = "compiled" if self.step else "reference"
        missing = "the compiled control step " + NOT_BUILT.format(slower="several times")
        self.notice = missing if wanted and not self.step else ""
        if self.step and self.step.lacks:
            self.notice = LACKS.format(kinds=", ".join(self.step.lacks))

    def read(self, data: mujoco.MjData) -> State:
        """The state in `data`, whose positions and contacts are up to date."""
        state = self.step.read(data) if self.step else None
        if state is None:
            state = read(self.model, data, self.settings.sees_disturbance, self.settings.merging)
        return state

    def decide(self, state: State, command: Command, blend: float) -> Decision:
        """Torques for one control period.

        Args:
            state: best the one that `read` returned last; any other takes the reference.
            blend: the previous step's gamma.
        """
        decision = self.step.decide(state, command, blend) if self.step else None
        return self._decide(state, command, blend) if decision is None else decision

    def _decide(self, state: State, command: Command, blend: float) -> Decision:
        """The reference."""
        poses = np.array((command.pose_a, command.pose_b))
        torques = self._tracker.torques(state, poses, command.pose)
        towards = None
        if self.settings.tracking == "acceleration":
            towards = self._tracker.accelerations(state, poses, command.pose)
        stack = collect(self.model, state, command, self.settings, torques, blend, towards)
        iterations = 0
        reasons: list[str] = []
        for link in self.chain:
            passes = link.passes(stack, self.model, state, command)
            iterations += passes.iterations
            if not passes.reason:
                break
            reasons.append(f"{link.form} {link.solver.name}: {passes.reason}")
        else:
            passes = pose_only(stack)
        candidates = command.candidates(state)
        used = np.zeros(len(candidates), dtype=bool)
        used[candidates] = passes.kept
        force = np.zeros((len(used), 3))
        answer = passes.answer
        force[used] = np.einsum("mij,mi->mj", passes.stack.frame, answer.force)
        failures = len(reasons)
        all_failed = failures == len(self.chain)
        torque = np.clip(answer.torque, -stack.torque_limit, stack.torque_limit)
        told = _told(passes.stack, torque, answer.force.ravel())
        return Decision(
            torque=torque,
            blend=min(max(answer.blend, 0.0), 1.0),
            used=used,
            force=force,
            rates_wanted=product(stack.rate_wanted, stack.rate_rows),
            rates_predicted=told.rates,
            error=np.array([task.rows.error for task in stack.tasks]).reshape(-1, LOGGED_ROWS),
            wanted=told.wanted,
            predicted=told.predicted,
            status=POSE_ONLY if all_failed else min(failures, SOLVED_BY_FALLBACK),
            fallback=failures,
            iterations=iterations,
            residual=answer.solution.residual,
            reasons=tuple(reasons),
        )


@dataclass(frozen=True)
class _Told:
    """Rates of momenta (6,), and each task's first rows (k, 3): what was wanted, what comes."""

    rates: Array
    wanted: Array
    predicted: Array


def _told(stack: Stack, torque: Array, force: Array) -> _Told:
    rates = product(stack.maps, force) + stack.free_rates
    over_rates = product(stack.rate_rows, rates)
    passive = stack.drift + stack.wanted
    over_motion = product(stack.actuation, torque) + product(stack.mobility, force) + passive
    wanted, predicted = np.zeros((2, len(stack.tasks), LOGGED_ROWS))
    for i, task in enumerate(stack.tasks):
        gives = over_rates if task.momentum else over_motion[3 * stack.contacts :]
        rows = min(len(task.rows.wanted), LOGGED_ROWS)
        wanted[i, :rows] = task.rows.wanted[:rows]
        predicted[i, :rows] = gives[task.first : task.first + rows]
    return _Told(rates, wanted, predicted)
