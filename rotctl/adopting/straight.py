"""A foreign humanoid in the pose that is zero for ours: limbs hang, left is +y."""

from collections.abc import Mapping

import mujoco
import numpy as np

from rotctl.adopting.squares import least_squares
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array, dot, length

HANGS = 0.9  # cosine of a limb's segment with down, from which it is left as it is
TO_ZERO = 0.03  # [1/rad] pull of straightened joints to where they were


def straighten(mj: mujoco.MjModel, data: mujoco.MjData, bodies: Mapping[str, int]) -> None:
    """Turn down the segments of limbs that do not hang, as far as their own joints go."""
    down = np.array([0.0, 0.0, -1.0])
    pairs = [("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle")]
    mujoco.mj_kinematics(mj, data)

    def along(upper: int, lower: int | None) -> Array:
        end = _far_end(mj, data, upper) if lower is None else anchor(mj, data, lower)
        whole = end - anchor(mj, data, upper)
        return np.asarray(whole / max(length(whole), 1e-9))

    bent: list[tuple[int, int | None]] = []
    moved: list[int] = []
    for side in ("left", "right"):
        for a, b in pairs:
            upper, lower = bodies[f"{side}_{a}"], bodies.get(f"{side}_{b}")
            if dot(along(upper, lower), down) < HANGS:
                bent.append((upper, lower))
                between = _between(mj, upper, lower)
                moved += [j for j in range(mj.njnt) if mj.jnt_bodyid[j] in between]
    if moved:
        at = mj.jnt_qposadr[moved]
        limited, ranges = mj.jnt_limited[moved].astype(bool), mj.jnt_range[moved]
        low = np.where(limited, ranges[:, 0], -np.pi)
        high = np.where(limited, ranges[:, 1], np.pi)

        def missed(angles: Array) -> Array:
            data.qpos[at] = angles
            mujoco.mj_kinematics(mj, data)
            found = [TO_ZERO * (angles - mj.qpos0[at])]
            return np.concatenate([*found, *(along(*pair) - down for pair in bent)])

        missed(least_squares(missed, mj.qpos0[at], low, high))
    mujoco.mj_comPos(mj, data)


def face_forward(data: mujoco.MjData, bodies: Mapping[str, int]) -> None:
    """Turn everything about the vertical so that left is +y."""
    x, y, _ = data.xpos[bodies["left_hip"]] - data.xpos[bodies["right_hip"]]
    if np.hypot(x, y) < 1e-6:
        return
    cosine, sine = y / np.hypot(x, y), x / np.hypot(x, y)
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    for places in (data.xpos, data.xipos, data.geom_xpos):
        places[:] = product(places, turn.T)
    for frames in (data.xmat, data.geom_xmat):
        for frame in frames:
            frame[:] = product(turn, frame.reshape(3, 3)).ravel()


def _between(mj: mujoco.MjModel, upper: int, lower: int | None) -> set[int]:
    """Bodies from one down to before another."""
    found, body = {upper}, int(mj.body_parentid[lower]) if lower is not None else upper
    while body not in (0, upper):
        found.add(body)
        body = int(mj.body_parentid[body])
    return found


def anchor(mj: mujoco.MjModel, data: mujoco.MjData, body: int) -> Array:
    """Where a body's first hinge is; its origin if it has none."""
    if not mj.body_jntnum[body] or mj.jnt_type[mj.body_jntadr[body]] == 0:
        return data.xpos[body].copy()
    joint = int(mj.body_jntadr[body])
    return np.asarray(data.xpos[body] + product(data.xmat[body].reshape(3, 3), mj.jnt_pos[joint]))


def _far_end(mj: mujoco.MjModel, data: mujoco.MjData, body: int) -> Array:
    """The end of what a body's shapes reach farthest from its joint."""
    places = [data.geom_xpos[g] for g in np.flatnonzero(mj.geom_bodyid == body)]
    places += [data.xpos[b] for b in range(1, mj.nbody) if mj.body_parentid[b] == body]
    origin = anchor(mj, data, body)
    return max(places, key=lambda at: length(at - origin), default=origin)
