"""A robot's motion as a capture: its bodies are the joints, where its angles put them."""

from dataclasses import replace

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.maths.rotations import Array
from rotctl.motion.capture import Capture, Joint


def captured(mj: mujoco.MjModel, positions: Array, time: Array) -> Capture:
    """Every body as a joint of a capture."""
    data = mujoco.MjData(mj)
    mujoco.mj_kinematics(mj, data)
    rest, upright = data.xpos.copy(), Rotation.from_quat(data.xquat, scalar_first=True)
    place, turned = np.empty((len(time), mj.nbody, 3)), np.empty((len(time), mj.nbody, 4))
    for i, position in enumerate(positions):
        data.qpos[:] = position
        mujoco.mj_kinematics(mj, data)
        place[i], turned[i] = data.xpos, data.xquat
    joints = {}
    for b in range(1, mj.nbody):
        parent = int(mj.body_parentid[b])
        joints[body_name(mj, b)] = Joint(
            parent=body_name(mj, parent) if parent else "",
            position=place[:, b],
            rotation=Rotation.from_quat(turned[:, b], scalar_first=True) * upright[b].inv(),
            rest=rest[b] - rest[1],
        )
    for b, end in _ends(mj).items():
        name, whole = body_name(mj, b), joints[body_name(mj, b)]
        joints[f"{name} end"] = replace(
            whole,
            parent=name,
            position=place[:, b] + Rotation.from_quat(turned[:, b], scalar_first=True).apply(end),
            rest=whole.rest + upright[b].apply(end),
        )
    return Capture(time, joints)


def _ends(mj: mujoco.MjModel) -> dict[int, Array]:
    """Bodies without children, and where in their frames the farthest solid geom is (3,) [m]."""
    found = {}
    for b in set(range(1, mj.nbody)) - set(mj.body_parentid.tolist()):
        geoms = np.flatnonzero(mj.geom_bodyid == b)
        solid = [g for g in geoms if mj.geom_contype[g] or mj.geom_conaffinity[g]] or geoms
        if len(solid):
            found[b] = max((mj.geom_pos[g] for g in solid), key=lambda at: float(np.abs(at).max()))
    return found


def body_name(mj: mujoco.MjModel, body: int) -> str:
    """Of a body, which may have none in the file."""
    return mj.body(body).name or f"body {body}"


def hinges_of(mj: mujoco.MjModel) -> list[str]:
    """Names of its hinges, in their order."""
    return [mj.joint(j).name for j in range(1, mj.njnt)]


def depth(mj: mujoco.MjModel, body: int) -> int:
    """How many bodies it hangs on, itself among them."""
    deep = 0
    while body:
        body, deep = int(mj.body_parentid[body]), deep + 1
    return deep
