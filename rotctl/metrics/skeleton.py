"""Where a character's bodies are in every row of a log: forward kinematics over all rows at once.

MuJoCo's own takes one state after the other, which for a log costs as much as a tenth of its
simulation.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.rotations import Array
from rotctl.same import kept

ROUND = int(mujoco.mjtGeom.mjGEOM_CAPSULE), int(mujoco.mjtGeom.mjGEOM_SPHERE)


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


class Skeleton:
    """A character over the rows of a log; each body is worked out when it is asked for."""

    def __init__(self, mj: mujoco.MjModel, qpos: Array) -> None:
        """For `qpos` (n, nq) [m, quaternion, rad] of a model with joints at bodies' origins."""
        self._mj, self._qpos = mj, np.ascontiguousarray(qpos.T)
        still = np.repeat([[1.0], [0.0], [0.0], [0.0]], len(qpos), axis=1)
        self._frames: dict[int, tuple[Array, Array]] = {0: (np.zeros((3, len(qpos))), still)}

    def origin(self, body: int) -> Array:
        """A body's origin (n, 3) [m]."""
        return self._frame(body)[0].T

    def capsules(self, geoms: Sequence[int], every: int = 1) -> Capsules:
        """Geoms by their ids, in every so-many-th row; each must be a capsule or a sphere."""
        mj, rows = self._mj, slice(None, None, every)
        bodies = mj.geom_bodyid[geoms]
        frames = [self._frame(body) for body in bodies.tolist()]
        place = np.stack([place[:, None, rows] for place, _ in frames], axis=1)
        turn = np.stack([turn[:, None, rows] for _, turn in frames], axis=1)
        moved = place + _rotated(turn, _ends(mj)[:, geoms, :, None])
        ends = np.ascontiguousarray(moved.transpose(1, 2, 3, 0))
        return Capsules(bodies, ends, mj.geom_size[geoms, 0])

    def _frame(self, body: int) -> tuple[Array, Array]:
        """Origin (3, n) [m] and orientation (4, n) of a body."""
        if body not in self._frames:
            mj = self._mj
            first = int(mj.body_jntadr[body])
            joints = range(first, first + int(mj.body_jntnum[body]))
            if joints and mj.jnt_type[first] == mujoco.mjtJoint.mjJNT_FREE:
                at = int(mj.jnt_qposadr[first])
                self._frames[body] = self._qpos[at : at + 3], self._qpos[at + 3 : at + 7]
            else:
                above, turn = self._frame(int(mj.body_parentid[body]))
                place = above + _rotated(turn, mj.body_pos[body][:, None])
                for joint in joints:
                    turn = _turned(turn, mj.jnt_axis[joint], self._qpos[mj.jnt_qposadr[joint]])
                self._frames[body] = place, turn
        return self._frames[body]


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
    """Quaternions (4, n), and then a turn by angles (n,) [rad] about an axis (3,) of theirs."""
    (w, x, y, z), half = turn, 0.5 * angle
    d, sine = np.cos(half), np.sin(half)
    a, b, c = (sine * along for along in axis.tolist())
    turned = (
        w * d - x * a - y * b - z * c,
        w * a + x * d + y * c - z * b,
        w * b + y * d + z * a - x * c,
        w * c + z * d + x * b - y * a,
    )
    return np.array(turned)


def overlap(one: Capsules, other: Capsules, pairs: Sequence[tuple[int, int]]) -> float:
    """The deepest overlap of pairs of capsules in any row [m]; 0 where none overlap.

    By the nearest points of two segments, [Ericson2005] section 5.1.9.
    """
    if not pairs:
        return 0.0
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
