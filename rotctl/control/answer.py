"""What a solved form of the optimisation tells the controller."""

from dataclasses import dataclass

from rotctl.maths.rotations import Array
from rotctl.qp import Solution


@dataclass(frozen=True)
class Answer:
    """One pass over m contacts.

    Attributes:
        torque: (nu,) [N m].
        force: (m, 3) contact forces along N, T1, T2 [N].
        blend: gamma.
        solution: the solver's own account.
    """

    torque: Array
    force: Array
    blend: float
    solution: Solution
