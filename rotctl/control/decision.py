"""What the controller decides at one instant, and how surely."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rotctl.maths.rotations import Array

SOLVED_BY_FALLBACK, POSE_ONLY = 1, 2  # status; 0 is solved by the chosen solver


class Decision(NamedTuple):
    """What the controller does at one instant.

    Attributes:
        torque: (nu,) within the limits [N m].
        blend: gamma.
        used: (m,) True for contacts of the second pass.
        force: (m, 3) predicted contact forces, world axes [N]; zero where unused.
        rates_wanted: (6,) Ldot and Hdot that the tasks of momenta ask for, 0 where none does.
        rates_predicted: (6,) that the solution gives [N, N m].
        error, wanted, predicted: (k, 3) of each task along its axes: how far it is from its
            target, what its rows should give, and what they give.
        status: 0, SOLVED_BY_FALLBACK or POSE_ONLY.
        fallback: which link of the chain gave the torque, 0 = the chosen solver.
        iterations: of all passes.
        residual: of the last pass.
        reasons: why solvers before the last link failed.
    """

    torque: Array
    blend: float
    used: NDArray[np.bool_]
    force: Array
    rates_wanted: Array
    rates_predicted: Array
    error: Array
    wanted: Array
    predicted: Array
    status: int
    fallback: int
    iterations: int
    residual: float
    reasons: tuple[str, ...]
