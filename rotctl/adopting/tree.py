"""A foreign humanoid's tree, hung on its pelvis; world axes, in the straightened pose."""

from dataclasses import dataclass, field

import mujoco
import numpy as np

from rotctl.maths.linear import product
from rotctl.maths.rotations import Array


@dataclass
class Hinge:
    """A joint between two bodies, at the straightened pose; world axes.

    Attributes:
        axis: of the body away from the pelvis against the one towards it.
        low, high: from there [rad].
        stiffness: of its spring [N m/rad], which gives nothing at the angle `rest` [rad].
    """

    source: str
    anchor: Array
    axis: Array
    low: float
    high: float
    torque: float | None
    damping: float
    armature: float
    stiffness: float
    rest: float
    name: str = ""


@dataclass
class Segment:
    """A body, hung on another; world axes at the straightened pose."""

    body: int
    name: str
    parent: int
    hinges: list[Hinge] = field(default_factory=list)
    origin: Array = field(default_factory=lambda: np.zeros(3))
    side: str = ""


def hung(mj: mujoco.MjModel, data: mujoco.MjData, hips: int) -> dict[int, Segment]:
    """The tree from the hips on, breadth first by the order of bodies."""
    found = {hips: Segment(hips, "", -1, origin=data.xpos[hips].copy())}
    waiting = [hips]
    while waiting:
        here = waiting.pop(0)
        near = [b for b in range(1, mj.nbody) if mj.body_parentid[b] == here]
        above = int(mj.body_parentid[here])
        for other in ([above] if above else []) + near:
            if other in found:
                continue
            away = other != above
            hinges = _hinges(mj, data, other if away else here, 1.0 if away else -1.0)
            segment = Segment(other, "", here, hinges if away else hinges[::-1])
            segment.origin = segment.hinges[0].anchor if segment.hinges else data.xpos[other].copy()
            found[other] = segment
            waiting.append(other)
    return found


def _hinges(mj: mujoco.MjModel, data: mujoco.MjData, body: int, sign: float) -> list[Hinge]:
    turned, found = data.xmat[body].reshape(3, 3), []
    first = int(mj.body_jntadr[body])
    for joint in range(first, first + int(mj.body_jntnum[body])):
        if mj.jnt_type[joint] != mujoco.mjtJoint.mjJNT_HINGE:
            continue
        now = float(data.qpos[mj.jnt_qposadr[joint]])
        low, high = mj.jnt_range[joint] if mj.jnt_limited[joint] else (now - np.pi, now + np.pi)
        dof = int(mj.jnt_dofadr[joint])
        found.append(
            Hinge(
                source=mj.joint(joint).name or f"joint_{joint}",
                anchor=data.xpos[body] + product(turned, mj.jnt_pos[joint]),
                axis=sign * product(turned, mj.jnt_axis[joint]),
                low=float(low) - now,
                high=float(high) - now,
                torque=_torque(mj, joint),
                damping=float(mj.dof_damping[dof]),
                armature=float(mj.dof_armature[dof]),
                stiffness=float(mj.jnt_stiffness[joint]),
                rest=float(mj.qpos_spring[mj.jnt_qposadr[joint]]) - now,
            )
        )
    return found


def _torque(mj: mujoco.MjModel, joint: int) -> float | None:
    """The largest torque that a joint's actuators give [N m]; None where the file does not say."""
    most = [float(np.abs(mj.jnt_actfrcrange[joint]).max())] if mj.jnt_actfrclimited[joint] else []
    for a in np.flatnonzero(mj.actuator_trnid[:, 0] == joint):
        gear = abs(float(mj.actuator_gear[a, 0]))
        if mj.actuator_forcelimited[a]:
            most.append(gear * float(np.abs(mj.actuator_forcerange[a]).max()))
        elif mj.actuator_ctrllimited[a] and mj.actuator_biastype[a] == 0:
            gain = abs(float(mj.actuator_gainprm[a, 0]))
            most.append(gear * gain * float(np.abs(mj.actuator_ctrlrange[a]).max()))
    return min(most) if most and min(most) > 0 else None
