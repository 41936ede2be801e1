"""Two passes of the optimisation with the supervisor between, by one form and one solver."""

from dataclasses import dataclass, replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.control import condensed, literal
from rotctl.control.answer import Answer
from rotctl.control.settings import FormName
from rotctl.control.stack import Stack
from rotctl.control.supervisor import FREE, RULES, Evidence
from rotctl.control.task import Command
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array
from rotctl.mechanics.contacts import realised_forces
from rotctl.mechanics.model import Model
from rotctl.mechanics.state import State
from rotctl.qp import Solution, Solver


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


class Rehearsal:
    """The physics, asked what it would do and undone; it has a memory of its own, made once."""

    def __init__(self, model: Model) -> None:
        """Of `model`."""
        self._model = model
        self._data: mujoco.MjData | None = None

    def realised(self, torque: Array, state: State) -> Array:
        """Force and torque about the centre of mass (k, 6) of every contact, [N, N m].

        In the physics step that begins at this state, with torques (nu,) [N m].
        """
        model = self._model
        if self._data is None:
            self._data = mujoco.MjData(model.mj)
        tried = self._data
        mujoco.mj_copyData(tried, model.mj, state.data)
        tried.ctrl[:] = np.clip(torque, -model.torque_limit, model.torque_limit)
        mujoco.mj_forward(model.mj, tried)
        force = realised_forces(model.mj, tried, state.contacts)
        lever = state.contacts.position - state.momentum.com
        return np.concatenate((force, np.cross(lever, force)), axis=1)


@dataclass(frozen=True)
class Link:
    """One way to solve a step: a form of the optimisation and a solver for it."""

    form: FormName
    solver: Solver
    rehearsal: Rehearsal

    def passes(self, stack: Stack, model: Model, state: State, command: Command) -> Passes:
        """The optimisation over all candidate contacts, then over those that pass the test."""
        everything = np.ones(stack.contacts, dtype=bool)
        free = command.supervisor in FREE
        asked = replace(stack, rate_weight=np.zeros_like(stack.rate_weight)) if free else stack
        first = self._answer(asked, model, state, None)
        over_all = Passes(first, stack, everything, first.solution.iterations)
        rule = RULES.get(command.supervisor)
        if over_all.reason or rule is None:
            return over_all
        keep = rule(self._evidence(first, stack, state, command), command.thresholds)
        if keep.all() and not free:
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

    def _evidence(self, first: Answer, stack: Stack, state: State, command: Command) -> Evidence:
        m, mu = stack.contacts, stack.friction
        maps = stack.maps.reshape(6, m, 3)
        edges = np.array([[1.0, mu, mu], [1.0, mu, -mu], [1.0, -mu, mu], [1.0, -mu, -mu]])
        candidates = command.candidates(state)
        return Evidence(
            push=np.einsum("amc,mc->ma", maps, first.force),
            separation=product(stack.jacobian[::3], state.velocity),
            place=state.contacts.position[candidates, :2],
            edges=np.einsum("amc,ec->mea", maps, edges),
            realised=lambda: self.rehearsal.realised(first.torque, state)[candidates],
        )


def pose_only(stack: Stack) -> Passes:
    """Where nothing solves: track the previous blend of the two poses, plan with no contact."""
    nothing = np.zeros(stack.contacts, dtype=bool)
    torque = stack.blend * stack.pose_a + (1.0 - stack.blend) * stack.pose_b
    solution = Solution(np.empty(0), True, 0, float("nan"))
    answer = Answer(torque, np.empty((0, 3)), stack.blend, solution)
    return Passes(answer, stack.subset(nothing), nothing, 0)
