"""Two passes of the optimisation with the supervisor between, by one form and one solver."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rotctl.control import condensed, literal
from rotctl.control.answer import Answer
from rotctl.control.settings import FormName
from rotctl.control.stack import Stack
from rotctl.control.supervisor import RULES, Evidence
from rotctl.control.task import Command
from rotctl.linear import product
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State
from rotctl.qp import Solution, Solver
from rotctl.rotations import Array


@dataclass(frozen=True)
class Passes:
    """The last pass that was made.

    Attributes:
        answer: of it, over `stack`.
        stack: of the contacts that it used.
        kept: (m,) which of the candidates these are.
        iterations: of all passes.
    """

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


@dataclass(frozen=True)
class Link:
    """One way to solve a step: a form of the optimisation and a solver for it."""

    form: FormName
    solver: Solver

    def passes(self, stack: Stack, model: Model, state: State, command: Command) -> Passes:
        """The optimisation over all candidate contacts, then over those that pass the test."""
        everything = np.ones(stack.contacts, dtype=bool)
        first = self._answer(stack, model, state, None)
        over_all = Passes(first, stack, everything, first.solution.iterations)
        rule = RULES.get(command.supervisor)
        if over_all.reason or rule is None:
            return over_all
        keep = rule(_evidence(first, stack, state), command.thresholds)
        if keep.all():
            return over_all
        subset = stack.subset(keep)
        condenses = self.form == "condensed"
        start = condensed.warm_start(first, keep, self.solver) if condenses else None
        second = self._answer(subset, model, state, start)
        iterations = over_all.iterations + second.solution.iterations
        return Passes(second, subset, keep, iterations)

    def _answer(self, stack: Stack, model: Model, state: State, start: Array | None) -> Answer:
        if self.form == "literal":
            return literal.solve(stack, model, state, self.solver)
        return condensed.solve(stack, self.solver, start)


def pose_only(stack: Stack) -> Passes:
    """Where nothing solves: track the previous blend of the two poses, plan with no contact."""
    nothing = np.zeros(stack.contacts, dtype=bool)
    torque = stack.blend * stack.pose_a + (1.0 - stack.blend) * stack.pose_b
    solution = Solution(np.empty(0), True, 0, float("nan"))
    answer = Answer(torque, np.empty((0, 3)), stack.blend, solution)
    return Passes(answer, stack.subset(nothing), nothing, 0)


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
