"""Angular excursion AE: how far the whole body has turned, [Brown2013] eq. 1, two ways, and ROOT.

`integral` is eq. 1 as printed: phi = int omega dt + phi_0, component by component. A vector
integral cannot see *coning*: a body tilted away from its spin axis that keeps spinning
about world y has omega_x = omega_z = 0, so phi_x and phi_z stay constant while the body
rolls off its axis.

`oriented` repairs this. It integrates omega as an orientation, and compares where that
orientation has carried the rolling axis with where the axis should be. As omega is not
the velocity of any one body, the integral drifts from the body slowly; it is pulled to
the trunk's mean axis with a time constant.

`root` is what the paper holds against AE: the orientation of the root body stands for that
of the whole body. In-plane, all three are the plain integral.
"""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from rotctl.rotations import Array, advance, cross, multiply, rotate, rotation_between

ExcursionName = Literal["oriented", "integral", "root"]


@dataclass(frozen=True)
class Excursion:
    """AE at one instant.

    Attributes:
        angle: (3,) phi, the component-wise integral of omega [rad].
        orientation: (4,) the integral of omega as an orientation, unit quaternion; under
            `root` how far the root has turned away from phase 0.
    """

    angle: Array
    orientation: Array


def start(angle: Array) -> Excursion:
    """Excursion at the start of a run, phi_0 = `angle` (3,) [rad]."""
    return Excursion(angle=np.asarray(angle, dtype=float), orientation=np.array([1.0, 0, 0, 0]))


def integrate(
    excursion: Excursion,
    angular_velocity: Array,
    trunk_axis: Array,
    rolling_axis: Array,
    period: float,
    correction_time: float,
) -> Excursion:
    """Advance AE by one control period.

    Args:
        angular_velocity: (3,) AV [rad/s].
        trunk_axis: (3,) the trunk's axis that should stay on the rolling axis, unit.
        rolling_axis: (3,) the axis the body should roll about, unit.
        period: [s].
        correction_time: time constant of the pull towards the trunk [s].
    """
    turn = angular_velocity * period
    orientation = advance(excursion.orientation, turn)
    drift = cross(rotate(orientation, rolling_axis), trunk_axis)
    pulled = advance(orientation, drift * min(1.0, period / correction_time))
    return Excursion(angle=excursion.angle + turn, orientation=pulled)


def on_root(excursion: Excursion, root: Array, at_phase_0: Array) -> Excursion:
    """The same angle, with the root body's orientation (4,) in place of the integrated one.

    Args:
        at_phase_0: (4,) the root's orientation there, unit quaternion.
    """
    back = at_phase_0 * [1.0, -1.0, -1.0, -1.0]
    return replace(excursion, orientation=multiply(root, back))


def error(excursion: Excursion, target: Array, rolling_axis: Array, name: ExcursionName) -> Array:
    """D(phi_hat, phi) of [Brown2013] eq. 4: what is missing to the target, (3,) [rad].

    With `oriented` and `root` the part across the rolling axis is the rotation that brings the
    carried rolling axis back to the wanted one; the part along it is the plain difference.
    """
    difference = target - excursion.angle
    if name == "integral":
        return difference
    carried = rotate(excursion.orientation, rolling_axis)
    along = rolling_axis * (rolling_axis @ difference)
    return np.asarray(rotation_between(carried, rolling_axis) + along)
