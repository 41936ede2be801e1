"""Limbs as capsules over the rows of a log, and how deep they overlap."""

import ctypes
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from rotctl.maths.rotations import Array
from rotctl.native import library


@dataclass(frozen=True)
class Capsules:
    """k capsules over n rows; a sphere is one without length.

    Attributes:
        body: (k,) MuJoCo ids.
        ends: (k, 2, n, 3) of their middle lines [m].
        radius: (k,) [m].
    """

    body: NDArray[np.int32]
    ends: Array
    radius: Array


def overlap(one: Capsules, other: Capsules, pairs: Sequence[tuple[int, int]]) -> float:
    """The deepest overlap of pairs of capsules in any row [m]; 0 where none overlap.

    By the nearest points of two segments, [Ericson2005] section 5.1.9.
    """
    if not pairs:
        return 0.0
    return (_compiled_overlap if library() else _reference_overlap)(one, other, pairs)


def _compiled_overlap(one: Capsules, other: Capsules, pairs: Sequence[tuple[int, int]]) -> float:
    """As `_reference_overlap`; C leaves out who is seen to be far apart."""
    which = np.array(pairs, dtype=np.int32)
    reach = one.radius[which[:, 0]] + other.radius[which[:, 1]]
    ends = [np.ascontiguousarray(each.ends, dtype=float) for each in (one, other)]
    at = [array.ctypes.data for array in (*ends, which, reach)]
    steps = ends[0].shape[2]
    return float(_function()(steps, *at[:2], len(which), *at[2:]))


@lru_cache(maxsize=1)
def _function() -> Callable[..., float]:
    """That of the library, which knows now what it takes."""
    found = library()
    assert found is not None
    pointer, whole = ctypes.c_void_p, ctypes.c_int
    found.rotctl_overlap.argtypes = [whole, pointer, pointer, whole, pointer, pointer]
    found.rotctl_overlap.restype = ctypes.c_double
    return found.rotctl_overlap


def _reference_overlap(one: Capsules, other: Capsules, pairs: Sequence[tuple[int, int]]) -> float:
    first, second = np.array(pairs).T
    p, q = one.ends[first], other.ends[second]
    d, e, r = p[:, 1] - p[:, 0], q[:, 1] - q[:, 0], p[:, 0] - q[:, 0]
    a, b, c, f, g = _dot(d, d), _dot(d, e), _dot(e, e), _dot(d, r), _dot(e, r)
    s = _share(b * g - c * f, a * c - b * b)
    t = _share(b * s + g, c)
    s = _share(b * t - f, a)
    apart = r + s[..., None] * d - t[..., None] * e
    reach = (one.radius[first] + other.radius[second])[:, None]
    return float((reach - np.sqrt(_dot(apart, apart))).max(initial=0.0))


def _share(part: Array, whole: Array) -> Array:
    """Part / whole, from 0 to 1; 0 where there is no whole."""
    return np.asarray((part / np.where(whole > 1e-12, whole, np.inf)).clip(0.0, 1.0))


def _dot(one: Array, other: Array) -> Array:
    return np.asarray(
        one[..., 0] * other[..., 0] + one[..., 1] * other[..., 1] + one[..., 2] * other[..., 2]
    )
