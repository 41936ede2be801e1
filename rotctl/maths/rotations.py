"""Quaternions (w, x, y, z) and rotation vectors, as plain numpy functions.

The arithmetic is on Python's numbers: for three or four of them that is several times
faster than numpy, and it needs no BLAS, which adds in another order on other processors.
What runs at every step and has several in a row uses the functions of plain numbers.
"""

from collections.abc import Sequence
from math import atan2, cos, sin, sqrt

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Numbers = Sequence[float]
Triple = tuple[float, float, float]

_CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])


def quaternion_from_rotation_vector(vector: Array) -> Array:
    """Unit quaternion (4,) of a rotation vector (3,) [rad]."""
    return np.array(_turn(*vector.tolist()))


def about_up(angle: float) -> Array:
    """Unit quaternion (4,) of a turn about world z [rad]."""
    return np.array([cos(0.5 * angle), 0.0, 0.0, sin(0.5 * angle)])


def multiply(left: Array, right: Array) -> Array:
    """Hamilton product of two quaternions (4,): first `right`, then `left`."""
    return np.array(_product(*left.tolist(), *right.tolist()))


def rotate(quaternion: Array, vector: Array) -> Array:
    """Rotate a vector (3,) by a unit quaternion (4,)."""
    return np.array(rotated(quaternion.tolist(), vector.tolist()))


def advance(quaternion: Array, rotation_vector: Array) -> Array:
    """Turn a unit quaternion (4,) by a world-frame rotation vector (3,) [rad]."""
    return np.array(advanced(quaternion.tolist(), rotation_vector.tolist()))


def rotation_to(start: Array, end: Array) -> Array:
    """Shortest rotation vector (3,) [rad], world, that turns one unit quaternion into another."""
    w, x, y, z = multiply(end, start * _CONJUGATE).tolist()
    sine = sqrt(x * x + y * y + z * z)
    if sine < 1e-12:
        return np.zeros(3)
    angle = 2.0 * atan2(sine, abs(w))  # a quaternion and its negative are one orientation
    scale = angle / sine if w >= 0.0 else -angle / sine
    return np.array([scale * x, scale * y, scale * z])


def dot(a: Array, b: Array) -> float:
    """Dot product of two short vectors, such as (3,), added from left to right."""
    return dotted(a.tolist(), b.tolist())


def length(a: Array) -> float:
    """Of a short vector, such as (3,)."""
    return sqrt(dot(a, a))


def cross(a: Array, b: Array) -> Array:
    """Cross product of two vectors (3,)."""
    return np.array(crossed(a.tolist(), b.tolist()))


def rotation_between(start: Numbers, end: Numbers) -> Triple:
    """Shortest rotation vector [rad] that turns unit vector `start` into `end`.

    For opposite vectors the axis is undetermined and zero is returned.
    """
    x, y, z = crossed(start, end)
    sine = sqrt(x * x + y * y + z * z)
    if sine < 1e-12:
        return 0.0, 0.0, 0.0
    scale = atan2(sine, start[0] * end[0] + start[1] * end[1] + start[2] * end[2]) / sine
    return x * scale, y * scale, z * scale


def rotated(quaternion: Numbers, vector: Numbers) -> Triple:
    """`rotate` of plain numbers."""
    w, x, y, z = quaternion
    a, b, c = vector
    # v + w t + q x t with t = 2 q x v
    ta, tb, tc = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return (
        a + w * ta + y * tc - z * tb,
        b + w * tb + z * ta - x * tc,
        c + w * tc + x * tb - y * ta,
    )


def advanced(quaternion: Numbers, rotation_vector: Numbers) -> tuple[float, float, float, float]:
    """`advance` of plain numbers."""
    w, x, y, z = _product(*_turn(*rotation_vector), *quaternion)
    length = sqrt(w * w + x * x + y * y + z * z)
    return w / length, x / length, y / length, z / length


def dotted(a: Numbers, b: Numbers) -> float:
    """`dot` of plain numbers."""
    total = 0.0  # not sum(), which some versions of Python add with compensation
    for x, y in zip(a, b, strict=True):
        total += x * y
    return total


def crossed(a: Numbers, b: Numbers) -> Triple:
    """`cross` of plain numbers."""
    ax, ay, az = a
    bx, by, bz = b
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


def scaled(vector: Numbers, factor: float) -> Triple:
    """Each of three numbers by a factor."""
    x, y, z = vector
    return x * factor, y * factor, z * factor


def _turn(x: float, y: float, z: float) -> tuple[float, float, float, float]:
    """Unit quaternion of a rotation vector."""
    angle = sqrt(x * x + y * y + z * z)
    if angle < 1e-12:
        return 1.0, 0.0, 0.0, 0.0
    scale = sin(0.5 * angle) / angle
    return cos(0.5 * angle), scale * x, scale * y, scale * z


def _product(
    w: float, x: float, y: float, z: float, a: float, b: float, c: float, d: float
) -> tuple[float, float, float, float]:
    """Hamilton product of two quaternions."""
    return (
        w * a - x * b - y * c - z * d,
        w * b + x * a + y * d - z * c,
        w * c - x * d + y * a + z * b,
        w * d + x * c - y * b + z * a,
    )
