"""Any solver that the qpsolvers package knows: `qpsolvers:daqp`, `qpsolvers:piqp`, ..."""

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotctl.errors import InputError
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array
from rotctl.qp.problem import Problem, Shape, Solution, failed, objection

TOLERANCE = 1e-5  # accepted relative residual [-]
LARGEST = 1e20  # a bound beyond this is none


class AnySolver:
    """One solver of qpsolvers, by name."""

    shape: Shape = "rows"

    def __init__(self, name: str) -> None:
        """Look the solver up.

        Raises:
            InputError: qpsolvers is not installed, or does not know `name` here.
        """
        try:
            import qpsolvers
        except ImportError:
            raise InputError(
                f"controller.solver=qpsolvers:{name} needs the optional package qpsolvers; "
                "install it with: pip install 'rotctl[solvers]'"
            ) from None
        if name not in qpsolvers.available_solvers:
            known = ", ".join(sorted(qpsolvers.available_solvers)) or "none"
            raise InputError(
                f"controller.solver: qpsolvers has no solver {name!r} here; installed: {known}"
            )
        self.name = f"qpsolvers:{name}"
        self._name = name
        self._qpsolvers = qpsolvers

    def solve(self, problem: Problem, start: Array | None) -> Solution:
        """Solve, cold; `start` is ignored. See `Solver`."""
        reason = objection(problem)
        if reason:
            return failed(problem, f"{self.name}: {reason}")
        rows, limits, equal = _one_sided(problem)
        fixed, value = problem.G[equal], problem.low[equal]
        stated = self._qpsolvers.Problem(
            problem.H,
            problem.f,
            rows if len(rows) else None,
            limits if len(rows) else None,
            fixed if len(fixed) else None,
            value if len(fixed) else None,
            problem.lower,
            problem.upper,
        )
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # dense-to-sparse conversions, told once per call
                answer = self._qpsolvers.solve_problem(stated, self._name)
        except Exception as error:  # a solver's own failure of whatever type is a failed row
            return failed(problem, f"{self.name}: {error}")
        if not answer.found or answer.x is None or not np.isfinite(answer.x).all():
            return failed(problem, f"{self.name} found no solution")
        residual = _residual(problem, answer)
        if not residual <= TOLERANCE:
            return failed(problem, f"{self.name}: residual {residual:.1e} exceeds {TOLERANCE:.0e}")
        return Solution(answer.x, True, 0, residual)


def _one_sided(problem: Problem) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Rows G and limits h with G x <= h, and which of the problem's rows (k,) are equalities."""
    equal = problem.low == problem.high
    above = ~equal & (problem.high < LARGEST)
    below = ~equal & (problem.low > -LARGEST)
    rows = np.concatenate((problem.G[above], -problem.G[below]))
    return rows, np.concatenate((problem.high[above], -problem.low[below])), equal


def _residual(problem: Problem, answer: Any) -> float:
    """Largest of the primal and dual residuals and the duality gap, all relative.

    qpsolvers could say them itself, by BLAS.
    """
    x, box = answer.x, answer.z_box
    rows, limits, equal = _one_sided(problem)
    sides = [(rows, limits, answer.z), (problem.G[equal], problem.low[equal], answer.y)]
    sides = [side for side in sides if len(side[1])]
    if box is None or any(pressure is None for *_, pressure in sides):
        return np.inf
    bound = np.where(box < 0, problem.lower, problem.upper)
    there = np.isfinite(bound)
    curve = product(problem.H, x)
    gradient = curve + problem.f + box
    gap = product(x, curve) + product(problem.f, x) + product(box[there], bound[there])
    for block, limit, pressure in sides:
        gradient = gradient + product(pressure, block)
        gap = gap + product(pressure, limit)
    primal = problem.violation(x) / (1.0 + float(np.abs(x).max(initial=0.0)))
    dual = float(np.abs(gradient).max()) / (1.0 + float(np.abs(problem.f).max(initial=0.0)))
    apart = abs(float(gap)) / (1.0 + abs(float(product(x, curve))))
    return float(np.max([primal, dual, apart]))
