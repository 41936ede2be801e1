"""What is wanted now, and the momentum rates that follow from it, [Brown2013] eq. 3 and 4."""

from dataclasses import dataclass

import numpy as np

from rotctl.control.settings import Gains
from rotctl.linear import product
from rotctl.mechanics.momentum import Momentum
from rotctl.rotations import Array


@dataclass(frozen=True)
class Desired:
    """A behaviour's wishes at one instant, world axes.

    Attributes:
        com: (3,) c_hat [m]; ignored along an axis whose stiffness is zero.
        com_velocity: (3,) [m/s].
        excursion_error: (3,) D(phi_hat, phi) [rad].
        angular_velocity: (3,) omega_hat [rad/s].
        pose_a, pose_b: (nu,) the two poses r_a and r_b of eq. 7 [rad].
    """

    com: Array
    com_velocity: Array
    excursion_error: Array
    angular_velocity: Array
    pose_a: Array
    pose_b: Array


def momentum_rates(desired: Desired, momentum: Momentum, mass: float, gains: Gains) -> Array:
    """Ldot_d (eq. 3) and Hdot_d (eq. 4), stacked (6,) [N, N m]."""
    linear = mass * (
        np.array(gains.linear_stiffness) * (desired.com - momentum.com)
        + np.array(gains.linear_damping) * (desired.com_velocity - momentum.com_velocity)
    )
    angular = product(
        momentum.inertia,
        np.array(gains.angular_stiffness) * desired.excursion_error
        + np.array(gains.angular_damping) * (desired.angular_velocity - momentum.angular_velocity),
    )
    return np.concatenate((linear, angular))
