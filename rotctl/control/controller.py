"""The whole-body controller: two passes of the optimisation with the supervisor between."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.control import condensed, literal
from rotctl.control.answer import Answer
from rotctl.control.compiled import CompiledStep, library, serves
from rotctl.control.decision import POSE_ONLY, SOLVED_BY_FALLBACK, Decision
from rotctl.control.pose import PoseTracker
from rotctl.control.settings import BackendName, ControllerSettings
from rotctl.control.supervisor import RULES, Evidence
from rotctl.control.targets import Desired, momentum_rates
from rotctl.control.terms import Terms, collect
from rotctl.errors import InputError
from rotctl.linear import product
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State, read
from rotctl.qp import Solution, Solver, make_solver
from rotctl.qp.active_set import ActiveSet
from rotctl.rotations import Array

NOT_BUILT = (
    "the compiled control step is not built, using its numpy reference, which is slower; "
    "install a C compiler (Debian: apt-get install gcc libc6-dev), then rotctl again"
)


class Controller:
    """Reads the state and decides torques; keeps workspaces, but no memory of the past.

    Attributes:
        backend: `compiled` or `reference`, whichever really works here.
        notice: what a user should know about that; mostly empty.
    """

    def __init__(self, model: Model, settings: ControllerSettings) -> None:
        """Make the solvers, the pose tracker and the compiled step.

        Raises:
            InputError: the solver does not exist here, or cannot solve the chosen form.
        """
        solver = make_solver(settings.solver)
        if settings.form == "literal" and solver.shape == "bounds":
            raise InputError(
                f"controller.form=literal has equality rows, which {solver.name} cannot "
                "solve; choose controller.solver=osqp or controller.solver=qpsolvers:<name>"
            )
        self.model = model
        self.settings = settings
        self._tracker = PoseTracker(model, settings.gains, 1.0 / settings.rate)
        self.chain: list[tuple[str, Solver]] = [(settings.form, solver)]
        if (settings.form, solver.name) != ("condensed", "boxqp"):
            self.chain.append(("condensed", make_solver("boxqp")))
        self.chain.append(("condensed", ActiveSet()))
        wanted = settings.backend == "compiled" and serves(settings, model)
        self._step = CompiledStep(model, settings) if wanted and library() else None
        self.backend: BackendName = "compiled" if self._step else "reference"
        self.notice = NOT_BUILT if wanted and not self._step else ""

    def read(self, data: mujoco.MjData) -> State:
        """The state in `data`, whose positions and contacts are up to date."""
        state = self._step.read(data) if self._step else None
        return read(self.model, data) if state is None else state

    def decide(self, state: State, desired: Desired, blend: float) -> Decision:
        """Torques for one control period.

        Args:
            state: best the one that `read` returned last; any other takes the reference.
            blend: the previous step's gamma.
        """
        decision = self._step.decide(state, desired, blend) if self._step else None
        return self._decide(state, desired, blend) if decision is None else decision

    def _decide(self, state: State, desired: Desired, blend: float) -> Decision:
        """The reference."""
        rates = momentum_rates(desired, state.momentum, self.model.mass, self.settings.gains)
        torques = self._tracker.torques(state, np.array((desired.pose_a, desired.pose_b)))
        candidates = ~self.model.excluded[state.contacts.body]
        terms = collect(self.model, state, self.settings, rates, torques, blend, candidates)
        iterations = 0
        reasons: list[str] = []
        for form, solver in self.chain:
            outcome = self._two_passes(form, solver, terms, state)
            iterations += outcome.iterations
            if not outcome.reason:
                break
            reasons.append(f"{form} {solver.name}: {outcome.reason}")
        else:
            outcome = _pose_only(terms)
        used = np.zeros(len(candidates), dtype=bool)
        used[candidates] = outcome.kept
        force = np.zeros((len(used), 3))
        answer = outcome.answer
        force[used] = np.einsum("mij,mi->mj", state.contacts.frame[used], answer.force)
        failures = len(reasons)
        all_failed = failures == len(self.chain)
        return Decision(
            torque=np.clip(answer.torque, -terms.torque_limit, terms.torque_limit),
            blend=min(max(answer.blend, 0.0), 1.0),
            used=used,
            force=force,
            rates_wanted=rates,
            rates_predicted=product(outcome.terms.maps, answer.force.ravel()) + terms.weight,
            status=POSE_ONLY if all_failed else min(failures, SOLVED_BY_FALLBACK),
            fallback=failures,
            iterations=iterations,
            residual=answer.solution.residual,
            reasons=tuple(reasons),
        )

    def _two_passes(self, form: str, solver: Solver, terms: Terms, state: State) -> "_Outcome":
        """The optimisation over all candidate contacts, then over those that pass the test."""
        everything = np.ones(terms.contacts, dtype=bool)
        first = self._pass(form, solver, terms, state, None)
        outcome = _Outcome(first, terms, everything, first.solution.iterations)
        rule = RULES.get(self.settings.supervisor)
        if outcome.reason or rule is None:
            return outcome
        keep = rule(_evidence(first, terms, state), self.settings.thresholds)
        if keep.all():
            return outcome
        subset = terms.subset(keep)
        start = condensed.warm_start(first, keep, solver) if form == "condensed" else None
        second = self._pass(form, solver, subset, state, start)
        return _Outcome(second, subset, keep, outcome.iterations + second.solution.iterations)

    def _pass(
        self, form: str, solver: Solver, terms: Terms, state: State, start: Array | None
    ) -> Answer:
        if form == "literal":
            return literal.solve(terms, self.model, state, solver)
        return condensed.solve(terms, solver, start)


@dataclass(frozen=True)
class _Outcome:
    """The last pass of one link: its answer over `terms`, and which candidates were kept."""

    answer: Answer
    terms: Terms
    kept: NDArray[np.bool_]
    iterations: int

    @property
    def reason(self) -> str:
        """Why the answer cannot be used; empty if it can."""
        if not self.answer.solution.solved:
            return self.answer.solution.reason
        return "" if np.isfinite(self.answer.torque.sum()) else "torques are not finite"


def _evidence(first: Answer, terms: Terms, state: State) -> Evidence:
    m = terms.contacts
    per_contact = terms.maps[3:].reshape(3, m, 3)  # torque about the CM per force component
    torque = np.einsum("amc,mc->ma", per_contact, first.force)
    normal_rows = terms.jacobian[::3]
    return Evidence(
        force=np.sqrt((first.force**2).sum(axis=1)),
        torque=np.sqrt((torque**2).sum(axis=1)),
        separation=product(normal_rows, state.velocity),
    )


def _pose_only(terms: Terms) -> _Outcome:
    """Track the previous blend of the two poses, plan with no contact."""
    nothing = np.zeros(terms.contacts, dtype=bool)
    torque = terms.blend * terms.pose_a + (1.0 - terms.blend) * terms.pose_b
    solution = Solution(np.empty(0), True, 0, float("nan"))
    answer = Answer(torque, np.empty((0, 3)), terms.blend, solution)
    return _Outcome(answer, terms.subset(nothing), nothing, 0)
