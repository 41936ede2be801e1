"""A primal active-set method for bounds: slow in Python, but it ends at the solution.

mju_boxQP stops short on about one in a thousand of a roll's problems, and more often on uneven
ground with its many contacts: four edges span three force components, so the Hessian is nearly
singular. This one takes over there. Each step solves the free variables exactly and goes as far
as the first bound; where none is met, the variable whose multiplier is most wrong is set free.
The compiled step has it in C, with a factor that it keeps: there it is the quicker one.
"""

from dataclasses import replace

import numpy as np

from rotctl.maths.linear import NotPositiveDefiniteError, product, solve
from rotctl.maths.rotations import Array
from rotctl.qp.problem import Problem, Shape, Solution, failed, objection
from rotctl.qp.scaling import DIAGONAL, Scaled, scale

STEPS = 30  # allowed, per variable
WRONG = 1e-9  # a multiplier this far on the wrong side is rounding, relative to the largest |f|


class ActiveSet:
    """See the module."""

    name = "active_set"
    shape: Shape = "bounds"

    def solve(self, problem: Problem, start: Array | None) -> Solution:
        """Solve a problem without rows; see `Solver`."""
        reason = objection(problem)
        if reason:
            return failed(problem, reason)
        scaled = scale(problem)
        H = scaled.regularised()
        try:
            found = _descend(scaled, H, scaled.start(start))
            # One proximal step: the addition now holds z near the solution, not near zero.
            found = _descend(replace(scaled, f=scaled.f - DIAGONAL * found), H, found)
        except NotPositiveDefiniteError as error:
            return failed(problem, str(error))
        return scaled.solution(found)


def _descend(scaled: Scaled, H: Array, z: Array) -> Array:
    """From z (n,) inside the bounds to the minimum, or as far as the steps go."""
    f, lower, upper = scaled.f, scaled.lower, scaled.upper
    free = (z > lower) & (z < upper)
    slack = WRONG * (1.0 + float(np.abs(f).max()))
    for _ in range(STEPS * len(z)):
        gradient = product(H, z) + f
        direction = np.zeros(len(z))
        if free.any():
            direction[free] = solve(H[np.ix_(free, free)], -gradient[free])
        ahead = np.where(direction < 0, lower, upper) - z
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = np.where(direction != 0, ahead / direction, np.inf)
        first = int(np.argmin(reach))
        if reach[first] < 1.0:
            z = np.clip(z + reach[first] * direction, lower, upper)
            z[first] = lower[first] if direction[first] < 0 else upper[first]
            free[first] = False
            continue
        z = z + direction
        gradient = product(H, z) + f
        pull = np.where(z <= lower, -gradient, np.where(z >= upper, gradient, 0.0))
        pull[free] = 0.0
        worst = int(np.argmax(pull))
        if pull[worst] <= slack:
            return z
        free[worst] = True
    return z
