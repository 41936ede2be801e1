"""The quantities both forms of the optimisation are written with, once per control step."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rotctl.control.settings import ControllerSettings, Weights
from rotctl.linear import product
from rotctl.mechanics.contacts import contact_jacobian
from rotctl.mechanics.model import Model
from rotctl.mechanics.momentum import contact_momentum_maps
from rotctl.mechanics.state import State
from rotctl.rotations import Array


@dataclass(frozen=True)
class Terms:
    """One control step's problem over m contacts, before it is given a form.

    Attributes:
        weights, friction: from the settings.
        period: look-ahead h of eq. 2 [s].
        torque_limit: (nu,) [N m].
        rates: (6,) wanted Ldot and Hdot [N, N m].
        momentum_weights: (6,) weights of their errors.
        joints: degrees of freedom that have motors.
        pose_a, pose_b: (nu,) torques tau_a, tau_b of eq. 7 [N m].
        blend: gamma of the previous step [-].
        jacobian: (3m, nv) contact rows N, T1, T2.
        solved: (3m, nv) J M^-1.
        maps: (6, 3m) contact forces to momentum rates.
        weight: (6,) momentum rates of gravity [N, N m].
        approach: (3m,) wanted contact velocity at t + h [m/s]: zero, but -gap / h along the
            normal of a contact that is still open.
        drift: (3m,) contact velocity at t + h over h, less `approach`, if all torques and
            forces were zero: J qdot / h - J M^-1 C - approach / h [m/s^2].
    """

    weights: Weights
    friction: float
    period: float
    torque_limit: Array
    rates: Array
    momentum_weights: Array
    joints: slice
    pose_a: Array
    pose_b: Array
    blend: float
    jacobian: Array
    solved: Array
    maps: Array
    weight: Array
    approach: Array
    drift: Array

    @property
    def contacts(self) -> int:
        """Number of contacts m."""
        return len(self.drift) // 3

    @cached_property
    def mobility(self) -> Array:
        """A = J M^-1 J' (3m, 3m) [1/kg]."""
        return product(self.solved, self.jacobian.T)

    @cached_property
    def actuation(self) -> Array:
        """B = J M^-1 S' (3m, nu)."""
        return self.solved[:, self.joints]

    @cached_property
    def actuation_square(self) -> Array:
        """B B' (3m, 3m)."""
        return product(self.actuation, self.actuation.T)

    @cached_property
    def momentum_square(self) -> Array:
        """Maps' W maps (3m, 3m)."""
        return product(self.maps.T * self.momentum_weights, self.maps)

    @cached_property
    def momentum_pull(self) -> Array:
        """Maps' W (wanted rates - gravity's) (3m,)."""
        return product(self.momentum_weights * (self.rates - self.weight), self.maps)

    @property
    def blend_weight(self) -> float:
        """Weight on the squared change of gamma."""
        difference = self.pose_a - self.pose_b
        return self.weights.blend * max(
            1.0, self.weights.pose * float(product(difference, difference))
        )

    def subset(self, keep: NDArray[np.bool_]) -> "Terms":
        """The same step over the contacts where `keep` (m,) is True."""
        rows = np.repeat(keep, 3)
        part = replace(
            self,
            jacobian=self.jacobian[rows],
            solved=self.solved[rows],
            maps=self.maps[:, rows],
            approach=self.approach[rows],
            drift=self.drift[rows],
        )
        both = np.ix_(rows, rows)
        part.__dict__.update(  # products over all contacts contain those over a subset
            mobility=self.mobility[both],
            actuation_square=self.actuation_square[both],
            momentum_square=self.momentum_square[both],
            momentum_pull=self.momentum_pull[rows],
        )
        return part


def collect(
    model: Model,
    state: State,
    settings: ControllerSettings,
    rates: Array,
    torques: Array,
    blend: float,
    keep: NDArray[np.bool_],
) -> Terms:
    """Terms over the contacts where `keep` (m,) is True.

    Args:
        rates: (6,) wanted momentum rates.
        torques: (2, nu) pose torques tau_a, tau_b.
        blend: gamma of the previous step.
    """
    jacobian = contact_jacobian(model.mj, state.data, state.contacts)[np.repeat(keep, 3)]
    solved = state.solve_mass(model.mj, np.concatenate((jacobian, state.bias[None])))
    h = 1.0 / settings.rate
    approach = np.zeros(len(jacobian))
    approach[::3] = -np.maximum(state.contacts.gap[keep], 0.0) / h
    weights = settings.weights
    across = weights.angular_momentum * weights.out_of_plane
    return Terms(
        weights=weights,
        friction=settings.friction,
        period=h,
        torque_limit=model.torque_limit,
        rates=rates,
        momentum_weights=np.array(
            [weights.linear_momentum] * 3 + [across, weights.angular_momentum, across]
        ),
        joints=model.joints,
        pose_a=torques[0],
        pose_b=torques[1],
        blend=blend,
        jacobian=jacobian,
        solved=solved[:-1],
        maps=contact_momentum_maps(state.momentum, jacobian),
        weight=np.concatenate((model.mass * model.gravity, np.zeros(3))),
        approach=approach,
        drift=product(jacobian, state.velocity / h - solved[-1]) - approach / h,
    )
