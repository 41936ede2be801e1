"""A convex quadratic program and its answer, as plain data."""

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from rotctl.maths.linear import product
from rotctl.maths.rotations import Array

Shape = Literal["bounds", "rows"]


@dataclass(frozen=True)
class Problem:
    """minimise 1/2 x'Hx + f'x subject to lower <= x <= upper, low <= Gx <= high.

    Attributes:
        H: (n, n) symmetric, positive semidefinite.
        f: (n,).
        lower, upper: (n,) bounds, may be infinite.
        G: (k, n) rows; k = 0 where bounds are all there is.
        low, high: (k,) limits of the rows; equal for an equality.
    """

    H: Array
    f: Array
    lower: Array
    upper: Array
    G: Array
    low: Array
    high: Array

    def objective(self, x: Array) -> float:
        """Value of the cost at x (n,)."""
        return float(0.5 * product(x, self.H, x) + product(self.f, x))

    def violation(self, x: Array) -> float:
        """Largest violation of a bound or row at x (n,), in the constraint's own unit."""
        rows = product(self.G, x)
        gaps = np.concatenate((self.lower - x, x - self.upper, self.low - rows, rows - self.high))
        return float(gaps.max(initial=0.0))  # nan, not 0, if anything is nan


@dataclass(frozen=True)
class Solution:
    """What a solver returned.

    Attributes:
        x: (n,) the best point found; meaningless unless `solved`.
        solved: the solver's own verdict, after its residuals were checked.
        iterations: as the solver counts them; 0 where it does not say.
        residual: relative residual of the optimality conditions [-], nan if unknown.
        reason: why it is not solved, for the log.
    """

    x: Array
    solved: bool
    iterations: int
    residual: float
    reason: str = ""


class Solver(Protocol):
    """One way to solve a Problem.

    Attributes:
        name: as in `controller.solver`.
        shape: `bounds` for a solver that knows no rows.
    """

    name: str
    shape: Shape

    def solve(self, problem: Problem, start: Array | None) -> Solution:
        """Solve; `start` (n,) is a guess of the solution, or None."""
        ...


def without_rows(H: Array, f: Array, lower: Array, upper: Array) -> Problem:
    """A problem whose only constraints are bounds."""
    none = np.empty(0)
    return Problem(H, f, lower, upper, np.empty((0, len(f))), none, none)


def objection(problem: Problem) -> str:
    """Why no solver can be asked; empty if the problem is well posed."""
    finite = problem.H.sum() + problem.f.sum() + problem.G.sum()
    if not np.isfinite(finite):
        return "the problem has numbers that are not finite"
    if not ((problem.lower <= problem.upper).all() and (problem.low <= problem.high).all()):
        return "the problem has limits that cross or are not numbers"
    return ""


def failed(problem: Problem, reason: str, iterations: int = 0) -> Solution:
    """The answer of a solver that has none."""
    return Solution(np.zeros(len(problem.f)), False, iterations, float("nan"), reason)
