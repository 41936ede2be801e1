"""What the controller decides at one instant, and how surely."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rotctl.rotations import Array

SOLVED_BY_FALLBACK, POSE_ONLY = 1, 2  # status; 0 is solved by the chosen solver


@dataclass(frozen=True)
class Decision:
    """What the controller does at one instant.

    Attributes:
        torque: (nu,) within the limits [N m].
        blend: gamma.
        used: (m,) True for contacts of the second pass.
        force: (m, 3) predicted contact forces, world axes [N]; zero where unused.
        rates_wanted, rates_predicted: (6,) Ldot and Hdot [N, N m].
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
    status: int
    fallback: int
    iterations: int
    residual: float
    reasons: tuple[str, ...]
