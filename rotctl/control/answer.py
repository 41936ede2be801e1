"""What a solved form of the optimisation tells the controller."""

from dataclasses import dataclass

from rotctl.qp import Solution
from rotctl.rotations import Array


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
