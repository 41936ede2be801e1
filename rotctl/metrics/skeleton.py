"""Where a character's bodies are in every row of a log: forward kinematics over all rows at once.

MuJoCo's own takes one state after the other, which for a log costs as much as a tenth of its
simulation.
"""

import ctypes
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.caching import kept
from rotctl.maths.rotations import Array
from rotctl.metrics.capsules import Capsules
from rotctl.native import library

ROUND = int(mujoco.mjtGeom.mjGEOM_CAPSULE), int(mujoco.mjtGeom.mjGEOM_SPHERE)


class Hinges(NamedTuple):
    """One hinge each of some bodies: ids (k,), columns (k,) of `qpos`, axes (3, k, 1)."""

    bodies: NDArray[np.int64]
    columns: NDArray[np.int64]
    axes: Array


class Level(NamedTuple):
    """Bodies as far from the root: ids (k,), those of what they hang on, where (3, k, 1) [m].

    Their hinges follow each other: first ones, second ones.
    """

    bodies: NDArray[np.int64]
    parents: NDArray[np.int64]
    offsets: Array
    hinges: tuple[Hinges, ...]


class Skeleton:
    """A character over the rows of a log."""

    def __init__(self, mj: mujoco.MjModel, qpos: Array) -> None:
        """For `qpos` (n, nq) [m, quaternion, rad] of a model with joints at bodies' origins.

        Where C has been built it does the same, to the same bits.
        """
        self._mj = mj
        self._place, self._turn = (_compiled if library() else _reference)(mj, qpos)

    def origin(self, body: int) -> Array:
        """A body's origin (n, 3) [m]."""
        return self._place[:, body].T

    def capsules(self, geoms: Sequence[int], every: int = 1) -> Capsules:
        """Geoms by their ids, in every so-many-th row; each must be a capsule or a sphere."""
        mj = self._mj
        make = _compiled_ends if library() else _reference_ends
        ends = make(mj, self._place, self._turn, geoms, every)
        return Capsules(mj.geom_bodyid[geoms], ends, mj.geom_size[geoms, 0])


def _reference(mj: mujoco.MjModel, qpos: Array) -> tuple[Array, Array]:
    """Places (3, nbody, n) and quaternions (4, nbody, n) of all bodies."""
    angles = np.ascontiguousarray(qpos.T)
    place, turn = np.zeros((3, mj.nbody, len(qpos))), np.zeros((4, mj.nbody, len(qpos)))
    turn[0] = 1.0
    free, levels = _tree(mj)
    for body, at in free:
        place[:, body], turn[:, body] = angles[at : at + 3], angles[at + 3 : at + 7]
    for bodies, parents, offsets, hinges in levels:
        above = turn[:, parents]
        place[:, bodies], turn[:, bodies] = place[:, parents] + _rotated(above, offsets), above
        for some, columns, axes in hinges:
            turn[:, some] = _turned(turn[:, some], axes, angles[columns])
    return place, turn


def _compiled(mj: mujoco.MjModel, qpos: Array) -> tuple[Array, Array]:
    """As `_reference`; `library()` must be there."""
    rows = np.ascontiguousarray(qpos, dtype=float)
    place, turn = np.empty((3, mj.nbody, len(rows))), np.empty((4, mj.nbody, len(rows)))
    at = [array.ctypes.data for array in (rows, place, turn)]
    _functions().rotctl_skeleton(mj._address, len(rows), *at)
    return place, turn


def _reference_ends(
    mj: mujoco.MjModel, place: Array, turn: Array, geoms: Sequence[int], every: int
) -> Array:
    """Ends (k, 2, n, 3) of geoms in every so-many-th row, as `Capsules` has them."""
    bodies = mj.geom_bodyid[geoms]
    there, turned = (part[:, :, None, ::every][:, bodies] for part in (place, turn))
    moved = there + _rotated(turned, _ends(mj)[:, geoms, :, None])
    return np.ascontiguousarray(moved.transpose(1, 2, 3, 0))


def _compiled_ends(
    mj: mujoco.MjModel, place: Array, turn: Array, geoms: Sequence[int], every: int
) -> Array:
    """As `_reference_ends`; `library()` must be there."""
    steps, which = place.shape[2], np.array(geoms, dtype=np.int32)
    ends = np.empty((len(which), 2, -(-steps // every), 3))
    arrays = (place, turn, _ends(mj), which, ends)
    at = [array.ctypes.data for array in arrays]
    _functions().rotctl_capsules(mj._address, steps, every, *at[:3], len(which), *at[3:])
    return ends


@lru_cache(maxsize=1)
def _functions() -> ctypes.CDLL:
    """The library, which knows now what its functions here take."""
    found = library()
    assert found is not None
    pointer, whole = ctypes.c_void_p, ctypes.c_int
    found.rotctl_skeleton.argtypes = [pointer, whole, *[pointer] * 3]
    found.rotctl_capsules.argtypes = [pointer, *[whole] * 2, *[pointer] * 3, whole, *[pointer] * 2]
    return found


@kept(most=8)
def _tree(mj: mujoco.MjModel) -> tuple[list[tuple[int, int]], list[Level]]:
    """Bodies that are free, each with its first column of `qpos`; all others, level by level."""
    first = mj.body_jntadr
    loose = (first >= 0) & (mj.jnt_type[first] == mujoco.mjtJoint.mjJNT_FREE)
    free = [(body, int(mj.jnt_qposadr[first[body]])) for body in np.flatnonzero(loose).tolist()]
    depth = np.zeros(mj.nbody, dtype=int)  # of what hangs on nothing that moves: the world, too
    for body in range(1, mj.nbody):
        depth[body] = 0 if loose[body] else depth[mj.body_parentid[body]] + 1
    levels = []
    for far in range(1, depth.max() + 1):
        bodies = np.flatnonzero(depth == far)
        hinges = []
        for k in range(mj.body_jntnum[bodies].max()):
            some = bodies[mj.body_jntnum[bodies] > k]
            joints = first[some] + k
            hinges.append(
                Hinges(some, mj.jnt_qposadr[joints].copy(), mj.jnt_axis[joints].T[:, :, None])
            )
        parents, offsets = mj.body_parentid[bodies], mj.body_pos[bodies].T[:, :, None]
        levels.append(Level(bodies, parents, offsets, tuple(hinges)))
    return free, levels


@kept(most=8)
def _ends(mj: mujoco.MjModel) -> Array:
    """Of the middle lines of all geoms in their bodies' frames, (3, ngeom, 2) [m]."""
    ends, along = np.zeros((3, mj.ngeom, 2)), np.zeros(3)
    for geom in range(mj.ngeom):
        half = mj.geom_size[geom, 1] if mj.geom_type[geom] == ROUND[0] else 0.0
        mujoco.mju_rotVecQuat(along, np.array([0.0, 0.0, half]), mj.geom_quat[geom])
        ends[:, geom, 0], ends[:, geom, 1] = mj.geom_pos[geom] + along, mj.geom_pos[geom] - along
    return ends


def _rotated(turn: Array, point: Array) -> Array:
    """Points (3, ...) turned by unit quaternions (4, ...): v + 2 w (u x v) + 2 u x (u x v)."""
    (w, x, y, z), (a, b, c) = turn, 2.0 * point
    p, q, r = y * c - z * b, z * a - x * c, x * b - y * a
    moved = np.array((w * p + y * r - z * q, w * q + z * p - x * r, w * r + x * q - y * p))
    return np.asarray(moved + point)


def _turned(turn: Array, axis: Array, angle: Array) -> Array:
    """Quaternions (4, k, n), then turns by angles (k, n) [rad] about axes (3, k, 1) of theirs."""
    (w, x, y, z), half = turn, 0.5 * angle
    d, sine = np.cos(half), np.sin(half)
    a, b, c = (sine * along for along in axis)
    turned = (
        w * d - x * a - y * b - z * c,
        w * a + x * d + y * c - z * b,
        w * b + y * d + z * a - x * c,
        w * c + z * d + x * b - y * a,
    )
    return np.array(turned)
