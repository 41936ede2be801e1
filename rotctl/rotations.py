"""Quaternions (w, x, y, z) and rotation vectors, as plain numpy functions."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def quaternion_from_rotation_vector(vector: Array) -> Array:
    """Unit quaternion (4,) of a rotation vector (3,) [rad]."""
    angle = float(np.sqrt(vector @ vector))
    if angle < 1e-12:
        return np.array([1.0, 0.0, 0.0, 0.0])
    half = 0.5 * angle
    return np.concatenate(([np.cos(half)], (np.sin(half) / angle) * vector))


def multiply(left: Array, right: Array) -> Array:
    """Hamilton product of two quaternions (4,): first `right`, then `left`."""
    w, x, y, z = left
    a, b, c, d = right
    return np.array(
        [
            w * a - x * b - y * c - z * d,
            w * b + x * a + y * d - z * c,
            w * c - x * d + y * a + z * b,
            w * d + x * c - y * b + z * a,
        ]
    )


def rotate(quaternion: Array, vector: Array) -> Array:
    """Rotate a vector (3,) by a unit quaternion (4,)."""
    w, axis = quaternion[0], quaternion[1:]
    twice = 2.0 * cross(axis, vector)
    return np.asarray(vector + w * twice + cross(axis, twice))


def advance(quaternion: Array, rotation_vector: Array) -> Array:
    """Turn a unit quaternion (4,) by a world-frame rotation vector (3,) [rad]."""
    turned = multiply(quaternion_from_rotation_vector(rotation_vector), quaternion)
    return np.asarray(turned / np.sqrt(turned @ turned))


def rotation_between(start: Array, end: Array) -> Array:
    """Shortest rotation vector (3,) [rad] that turns unit vector `start` into `end`.

    For opposite vectors the axis is undetermined and zero is returned.
    """
    axis = cross(start, end)
    sine = float(np.sqrt(axis @ axis))
    if sine < 1e-12:
        return np.zeros(3)
    return np.asarray(axis * (np.arctan2(sine, start @ end) / sine))


def cross(a: Array, b: Array) -> Array:
    """Cross product of two vectors (3,); numpy's own is ten times slower on three numbers."""
    ax, ay, az = a
    bx, by, bz = b
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
