"""Problem to solution; knows nothing of characters."""

from rotctl.errors import InputError
from rotctl.qp.problem import Problem, Shape, Solution, Solver, failed, without_rows

__all__ = ["Problem", "Shape", "Solution", "Solver", "failed", "make_solver", "without_rows"]


def make_solver(name: str) -> Solver:
    """The solver of that name: `boxqp`, `osqp` or `qpsolvers:<name>`.

    Raises:
        InputError: no such solver here; the message lists the valid names.
    """
    if name == "boxqp":
        from rotctl.qp.boxqp import BoxQP

        return BoxQP()
    if name == "osqp":
        from rotctl.qp.osqp import Osqp

        return Osqp()
    if name.startswith("qpsolvers:"):
        from rotctl.qp.any_solver import AnySolver

        return AnySolver(name.removeprefix("qpsolvers:"))
    raise InputError(
        f"controller.solver={name!r} is unknown; valid: boxqp, osqp, qpsolvers:<name> "
        "(for example qpsolvers:daqp)"
    )
