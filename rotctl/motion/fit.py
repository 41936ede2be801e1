"""One posture of our character, fitted to directions of segments.

The angles minimise the weighted differences of directions, with weak pulls to the posture before
and to zero, by Levenberg and Marquardt's method.
"""

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.motion.landmarks import BALL
from rotctl.motion.limbs import Limb, limbs_of

UP, LEFT, FORWARD, DOWN = (0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0)

# Body, direction in its frame, landmarks from and to, weight [-]. The pelvis's lateral axis
# says most of where the body faces; head and feet are thin evidence in any capture.
SEGMENTS = (
    ("pelvis", UP, "hips", "spine", 1.0),
    ("pelvis", LEFT, "hip_r", "hip_l", 2.0),
    ("chest", UP, "chest", "neck", 1.0),
    ("chest", LEFT, "shoulder_r", "shoulder_l", 1.0),
    ("head", UP, "head", "crown", 0.5),
    ("head", FORWARD, "head", "nose", 0.5),
    *(
        (f"{body}_{side}", axis, f"{start}_{side}", f"{end}_{side}", weight)
        for side in "lr"
        for body, axis, start, end, weight in (
            ("upper_arm", DOWN, "shoulder", "elbow", 1.0),
            ("forearm", DOWN, "elbow", "wrist", 1.0),
            ("thigh", DOWN, "hip", "knee", 1.0),
            ("shin", DOWN, "knee", "ankle", 1.0),
            ("foot", BALL, "ankle", "ball", 0.5),
        )
    ),
)
TO_ZERO = 0.03  # [1/rad] weight of each angle: decides what the directions leave open
TO_PREVIOUS = 0.1  # [1/rad] weight of each angle's change since the last frame
DAMPING = 1e-3  # at first, of Levenberg and Marquardt
ITERATIONS = 40
START_ITERATIONS = 80  # where there is no frame before
LONGEST = 0.5  # [rad] of a step
ENOUGH = 1e-4  # [rad] a smaller step ends the iterations
GAIN = np.radians(0.5)  # that another start must bring


class Fit:
    """The character's side of the problem."""

    def __init__(self, model: Model) -> None:
        mj = self.mj = model.mj
        self.data = mujoco.MjData(mj)
        self.low, self.high = model.joint_range.T
        names = [mj.body(i).name for i in range(mj.nbody)]
        missing = sorted({body for body, *_ in SEGMENTS} - set(names))
        if missing:
            raise InputError(f"the character has no body {', '.join(missing)}; no human to fit")
        self.bodies = [names.index(body) for body, *_ in SEGMENTS]
        self.axes = np.array([unit(np.array(axis)) for _, axis, *_ in SEGMENTS])
        self.weights = np.array([weight for *_, weight in SEGMENTS])
        thigh = mj.body("thigh_l").id
        self.leg = float(sum(np.linalg.norm(mj.body(b).pos) for b in ("shin_l", "foot_l")))
        self.hips = mj.body_pos[thigh] * [1.0, 0.0, 1.0]  # between the hip joints
        self._rotations = np.empty((len(SEGMENTS), 3, mj.nv))
        self.limbs = limbs_of(mj, self.low, self.high)

    def limb_error(self, limb: Limb, position: Array, targets: Array) -> float:
        """The larger error of a limb's two segments [rad]."""
        return float(self.error(position, targets)[self._segments(limb)].max())

    def again(self, limb: Limb, position: Array, targets: Array) -> Array:
        """The position nearest to the targets from a limb's best starts, the rest as it is."""
        self._point(position)
        parent = self.data.xmat[limb.parent].reshape(3, 3)
        found, least = position, np.inf
        for angles in limb.starts(targets[self._segments(limb)] @ parent, TO_ZERO):
            start = position.copy()
            start[7 + limb.motors] = angles
            tried = self.solve(start, targets, 0.0)
            error = self.limb_error(limb, tried, targets)
            if error < least:
                found, least = tried, error
            if least < GAIN:
                break
        return found

    def afresh(self, targets: Array) -> Array:
        """The position nearest to the targets without any before: the trunk first."""
        trunk = np.ones(len(self.bodies))
        trunk[[i for limb in self.limbs for i in self._segments(limb)]] = 0.0
        position = self.solve(self.beginning(targets), targets, 0.0, trunk * self.weights)
        self._point(position)
        for limb in self.limbs:
            parent = self.data.xmat[limb.parent].reshape(3, 3)
            wanted = targets[self._segments(limb)] @ parent
            position[7 + limb.motors] = limb.starts(wanted, TO_ZERO)[0]
        return self.solve(position, targets, 0.0)

    def _segments(self, limb: Limb) -> list[int]:
        return [self.bodies.index(body) for body in limb.bodies]

    def beginning(self, targets: Array) -> Array:
        """Zero pose, the pelvis as the targets have it."""
        position = np.zeros(self.mj.nq)
        up, left = targets[0], targets[1]
        forward = np.cross(left, up)
        position[3] = 1.0
        if np.linalg.norm(forward) > 0.1:  # else the file is no human's, and anything will do
            forward = unit(forward)
            axes = np.stack([forward, left, np.cross(forward, left)], axis=1)
            position[3:7] = Rotation.from_matrix(axes).as_quat(scalar_first=True)
        position[7:] = np.clip(0.0, self.low, self.high)
        return position

    def solve(
        self, start: Array, targets: Array, to_previous: float, weights: Array | None = None
    ) -> Array:
        """The position nearest to the targets (k, 3), from `start`."""
        before = start[7:]
        weights = self.weights if weights is None else weights
        position, damping = start.copy(), DAMPING
        rows, misses = self._system(position, targets, before, to_previous, weights)
        for _ in range(ITERATIONS if to_previous else START_ITERATIONS):
            step = self._step(rows, misses, position[7:], damping)
            moved = position.copy()
            mujoco.mj_integratePos(self.mj, moved, np.append(np.zeros(3), step), 1.0)
            moved[7:] = np.clip(moved[7:], self.low, self.high)
            new_rows, new_misses = self._system(moved, targets, before, to_previous, weights)
            if new_misses @ new_misses <= misses @ misses:
                position, rows, misses, damping = moved, new_rows, new_misses, 0.3 * damping
                if np.abs(step).max() < ENOUGH:
                    break
            else:
                damping *= 10.0
                if damping > 1e6:
                    break
        return position

    def _step(self, rows: Array, misses: Array, angles: Array, damping: float) -> Array:
        """A damped step (nv - 3,) [rad]; joints that push against their limits rest."""
        slope = rows.T @ misses
        pushed = slope[3:]
        rests = ((angles <= self.low) & (pushed < 0)) | ((angles >= self.high) & (pushed > 0))
        free = np.append(np.ones(3, dtype=bool), ~rests)
        some = rows[:, free]
        step = np.zeros(len(free))
        step[free] = np.linalg.solve(some.T @ some + damping * np.eye(free.sum()), slope[free])
        return np.asarray(step * min(1.0, LONGEST / max(np.abs(step).max(), 1e-12)))

    def error(self, position: Array, targets: Array) -> Array:
        """Angle between each segment and its target (k,) [rad]."""
        return np.asarray(
            2.0 * np.arcsin(0.5 * np.linalg.norm(targets - self._point(position), axis=1))
        )

    def _point(self, position: Array) -> Array:
        """Where the segments point (k, 3)."""
        self.data.qpos[:] = position
        mujoco.mj_kinematics(self.mj, self.data)
        turned = self.data.xmat[self.bodies].reshape(-1, 3, 3)
        return np.asarray(np.einsum("kij,kj->ki", turned, self.axes))

    def _system(
        self, position: Array, targets: Array, before: Array, to_previous: float, weights: Array
    ) -> tuple[Array, Array]:
        """Rows (m, nv - 3) and what is missing (m,): rows @ step = misses."""
        pointing = self._point(position)
        mujoco.mj_comPos(self.mj, self.data)
        misses = weights[:, None] * (targets - pointing)
        for body, rotation in zip(self.bodies, self._rotations, strict=True):
            mujoco.mj_jacBody(self.mj, self.data, None, rotation, body)
        a, b, c = self._rotations[:, :, 3:].transpose(1, 0, 2)
        x, y, z = pointing.T[:, :, None]
        # np.cross would take most of the time of an import
        turned = np.stack([b * z - c * y, c * x - a * z, a * y - b * x], axis=1)
        angles = position[7:]
        own = np.hstack([np.zeros((len(angles), 3)), np.eye(len(angles))])
        rows = (weights[:, None, None] * turned).reshape(-1, self.mj.nv - 3)
        return (
            np.vstack([rows, TO_ZERO * own, to_previous * own]),
            np.concatenate([misses.ravel(), -TO_ZERO * angles, to_previous * (before - angles)]),
        )


def unit(vectors: Array) -> Array:
    """Of length one; nothing stays nothing."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.maximum(length, 1e-9))
