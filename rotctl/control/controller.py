"""The whole-body controller: two passes of the optimisation with the supervisor between."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.control import condensed, literal
from rotctl.control.answer import Answer
from rotctl.control.compiled import CompiledStep, serves
from rotctl.control.decision import POSE_ONLY, SOLVED_BY_FALLBACK, Decision
from rotctl.control.pose import PoseTracker
from rotctl.control.settings import BackendName, ControllerSettings
from rotctl.control.stack import Stack, collect
from rotctl.control.supervisor import RULES, Evidence
from rotctl.control.task import Command
from rotctl.errors import InputError
from rotctl.linear import product
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State, read
from rotctl.native.library import NOT_BUILT, library
from rotctl.qp import Solution, Solver, make_solver
from rotctl.qp.active_set import ActiveSet
from rotctl.rotations import Array

LOGGED_ROWS = 3  # of each task


class Controller:
    """Reads the state and decides torques; keeps workspaces, but no memory of the past.

    Attributes:
        backend: `compiled` or `reference`, whichever really works here.
        notice: what a user should know about that; mostly empty.
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
        self.chain: list[tuple[str, Solver]] = [(settings.form, solver)]
        if (settings.form, solver.name) != ("condensed", "boxqp"):
            self.chain.append(("condensed", make_solver("boxqp")))
        self.chain.append(("condensed", ActiveSet()))
        wanted = settings.backend == "compiled" and serves(settings, model)
        self._step = CompiledStep(model, settings) if wanted and library() else None
        self.backend: BackendName = "compiled" if self._step else "reference"
        missing = "the compiled control step " + NOT_BUILT.format(slower="several times")
        self.notice = missing if wanted and not self._step else ""

    def read(self, data: mujoco.MjData) -> State:
        """The state in `data`, whose positions and contacts are up to date."""
        state = self._step.read(data) if self._step else None
        if state is None:
            state = read(self.model, data, self.settings.sees_disturbance, self.settings.merging)
        return state

    def decide(self, state: State, command: Command, blend: float) -> Decision:
        """Torques for one control period.

        Args:
            state: best the one that `read` returned last; any other takes the reference.
            blend: the previous step's gamma.
        """
        decision = self._step.decide(state, command, blend) if self._step else None
        return self._decide(state, command, blend) if decision is None else decision

    def _decide(self, state: State, command: Command, blend: float) -> Decision:
        """The reference."""
        poses = np.array((command.pose_a, command.pose_b))
        torques = self._tracker.torques(state, poses, command.pose)
        stack = collect(self.model, state, command, self.settings, torques, blend)
        iterations = 0
        reasons: list[str] = []
        for form, solver in self.chain:
            outcome = self._two_passes(form, solver, stack, state, command)
            iterations += outcome.iterations
            if not outcome.reason:
                break
            reasons.append(f"{form} {solver.name}: {outcome.reason}")
        else:
            outcome = _pose_only(stack)
        candidates = ~command.held_out[state.contacts.body]
        used = np.zeros(len(candidates), dtype=bool)
        used[candidates] = outcome.kept
        force = np.zeros((len(used), 3))
        answer = outcome.answer
        force[used] = np.einsum("mij,mi->mj", outcome.stack.frame, answer.force)
        failures = len(reasons)
        all_failed = failures == len(self.chain)
        torque = np.clip(answer.torque, -stack.torque_limit, stack.torque_limit)
        told = _told(outcome.stack, torque, answer.force.ravel())
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

    def _two_passes(
        self, form: str, solver: Solver, stack: Stack, state: State, command: Command
    ) -> "_Outcome":
        """The optimisation over all candidate contacts, then over those that pass the test."""
        everything = np.ones(stack.contacts, dtype=bool)
        first = self._pass(form, solver, stack, state, None)
        outcome = _Outcome(first, stack, everything, first.solution.iterations)
        rule = RULES.get(command.supervisor)
        if outcome.reason or rule is None:
            return outcome
        keep = rule(_evidence(first, stack, state), command.thresholds)
        if keep.all():
            return outcome
        subset = stack.subset(keep)
        start = condensed.warm_start(first, keep, solver) if form == "condensed" else None
        second = self._pass(form, solver, subset, state, start)
        return _Outcome(second, subset, keep, outcome.iterations + second.solution.iterations)

    def _pass(
        self, form: str, solver: Solver, stack: Stack, state: State, start: Array | None
    ) -> Answer:
        if form == "literal":
            return literal.solve(stack, self.model, state, solver)
        return condensed.solve(stack, solver, start)


@dataclass(frozen=True)
class _Outcome:
    """The last pass of one link: its answer over `stack`, and which candidates were kept."""

    answer: Answer
    stack: Stack
    kept: NDArray[np.bool_]
    iterations: int

    @property
    def reason(self) -> str:
        """Why the answer cannot be used; empty if it can."""
        if not self.answer.solution.solved:
            return self.answer.solution.reason
        return "" if np.isfinite(self.answer.torque.sum()) else "torques are not finite"


def _evidence(first: Answer, stack: Stack, state: State) -> Evidence:
    m = stack.contacts
    per_contact = stack.maps[3:].reshape(3, m, 3)  # torque about the CM per force component
    torque = np.einsum("amc,mc->ma", per_contact, first.force)
    normal_rows = stack.jacobian[::3]
    return Evidence(
        force=np.sqrt((first.force**2).sum(axis=1)),
        torque=np.sqrt((torque**2).sum(axis=1)),
        separation=product(normal_rows, state.velocity),
    )


def _pose_only(stack: Stack) -> _Outcome:
    """Track the previous blend of the two poses, plan with no contact."""
    nothing = np.zeros(stack.contacts, dtype=bool)
    torque = stack.blend * stack.pose_a + (1.0 - stack.blend) * stack.pose_b
    solution = Solution(np.empty(0), True, 0, float("nan"))
    answer = Answer(torque, np.empty((0, 3)), stack.blend, solution)
    return _Outcome(answer, stack.subset(nothing), nothing, 0)


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
