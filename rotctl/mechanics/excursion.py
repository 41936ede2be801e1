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
of the whole body. `clock` is what it holds against the phase: AE as `oriented`, but a roll's poses
go by the time at the commanded rate. In-plane, all are the plain integral.

The *phase* by which poses are looked up is the in-plane excursion too. For the same reason it
drifts from the body, in 20 s by up to a fifth of a revolution, and then poses come too late or
too early: `keep_phase` pulls it to how far the trunk has turned, with a time constant of its own.
"""

from math import pi, tau
from typing import Literal, NamedTuple

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.maths.rotations import (
    Array,
    advanced,
    crossed,
    multiply,
    rotate,
    rotated,
    rotation_between,
)
from rotctl.settings.fields import STRICT, Positive

ExcursionName = Literal["oriented", "integral", "root", "clock"]


@validated(frozen=True, config=STRICT)
class ExcursionSettings:
    """How AE and the phase are measured.

    Attributes:
        measure: see above.
        correction_time: of the `oriented` excursion's pull towards the trunk [s].
        phase_time: of the phase's pull towards the trunk [s].
    """

    name: str
    measure: ExcursionName
    correction_time: Positive
    phase_time: Positive
    description: str = ""


class Excursion(NamedTuple):
    """AE at one instant.

    Attributes:
        angle: (3,) phi, the component-wise integral of omega [rad].
        orientation: (4,) the integral of omega as an orientation, unit quaternion; under
            `root` how far the root has turned away from phase 0.
        phase: the in-plane excursion by which poses are looked up [rad].
    """

    angle: Array
    orientation: Array
    phase: float


def start(phase: float, rolling_axis: Array) -> Excursion:
    """Excursion at the start of a run: phi_0 is the `phase` [rad] about the rolling axis (3,)."""
    return Excursion(
        angle=phase * rolling_axis, orientation=np.array([1.0, 0, 0, 0]), phase=float(phase)
    )


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
    x, y, z = angular_velocity.tolist()
    turn = x * period, y * period, z * period
    left = rolling_axis.tolist()
    orientation = advanced(excursion.orientation.tolist(), turn)
    dx, dy, dz = crossed(rotated(orientation, left), trunk_axis.tolist())
    pull = min(1.0, period / correction_time)
    pulled = advanced(orientation, (dx * pull, dy * pull, dz * pull))
    a, b, c = excursion.angle.tolist()
    along = left[0] * turn[0] + left[1] * turn[1] + left[2] * turn[2]
    return Excursion(
        np.array([a + turn[0], b + turn[1], c + turn[2]]), np.array(pulled), excursion.phase + along
    )


def turned(excursion: Excursion, turn: Array) -> Excursion:
    """The same, seen by who has turned: rolling axis and all by a unit quaternion (4,)."""
    back = turn * [1.0, -1.0, -1.0, -1.0]
    orientation = multiply(multiply(turn, excursion.orientation), back)
    return Excursion(rotate(turn, excursion.angle), orientation, excursion.phase)


def keep_phase(excursion: Excursion, turned: float, period: float, phase_time: float) -> Excursion:
    """The same with its phase pulled to the trunk.

    Args:
        turned: how far the trunk has turned from phase 0 [rad]; whole revolutions are ignored.
        period: [s].
        phase_time: time constant [s].
    """
    drift = (turned - excursion.phase + pi) % tau - pi
    phase = excursion.phase + drift * min(1.0, period / phase_time)
    return Excursion(excursion.angle, excursion.orientation, phase)


def on_root(excursion: Excursion, root: Array, at_phase_0: Array) -> Excursion:
    """The same angle, with the root body's orientation (4,) in place of the integrated one.

    Args:
        at_phase_0: (4,) the root's orientation there, unit quaternion.
    """
    back = at_phase_0 * [1.0, -1.0, -1.0, -1.0]
    return excursion._replace(orientation=multiply(root, back))


def error(excursion: Excursion, target: Array, rolling_axis: Array, name: ExcursionName) -> Array:
    """D(phi_hat, phi) of [Brown2013] eq. 4: what is missing to the target, (3,) [rad].

    Other than with `integral`, the part across the rolling axis is the rotation that brings the
    carried rolling axis back to the wanted one; the part along it is the plain difference.
    """
    difference = target - excursion.angle
    if name == "integral":
        return difference
    left, (x, y, z) = rolling_axis.tolist(), difference.tolist()
    carried = rotated(excursion.orientation.tolist(), left)
    across = rotation_between(carried, left)
    along = left[0] * x + left[1] * y + left[2] * z
    return np.array([a + b * along for a, b in zip(across, left, strict=True)])
