"""Captures to import: our own character in a known motion, written as others would."""

from functools import cache

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.config.loading import load
from rotctl.motion import load_clip
from rotctl.motion.cycle import at_places
from rotctl.motion.ground import rolled
from rotctl.motion.preview import motion_of
from rotctl.runs.scenario import model_of

# Our bodies by the names that MotionBuilder gives them.
NAMES = {
    "pelvis": "Hips",
    "waist": "Spine",
    "chest": "Spine1",
    "head": "Head",
    **{
        f"{body}_{side}": word + name
        for side, word in (("l", "Left"), ("r", "Right"))
        for body, name in (
            ("upper_arm", "Arm"),
            ("forearm", "ForeArm"),
            ("thigh", "UpLeg"),
            ("shin", "Leg"),
            ("foot", "Foot"),
        )
    },
}
TO_BVH = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])  # x left, y up, z forward


@cache
def adult():
    return model_of(load([]))


def in_order(name, turns, heading=0.0, offset=0.0, frames=100):
    """Generalised positions of a shipped clip that rolls for so many turns, evenly."""
    places = offset + np.linspace(0.0, turns, frames)
    return rolled(adult(), at_places(motion_of(adult(), load_clip(name)), places), heading)


def bvh_text(positions, rate=60.0, unit=100.0, order="YZX"):
    """Our character as a BVH file; its end sites are garbage, as they often are."""
    mj = adult().mj
    data = mujoco.MjData(mj)
    columns, lines, depth = [], ["HIERARCHY"], 0

    def write(text):
        lines.append("  " * depth + text)

    def add(body):
        nonlocal depth
        name = mj.body(body).name
        root = name == "pelvis"
        write(f"{'ROOT' if root else 'JOINT'} Actor_{NAMES[name]}")
        write("{")
        depth += 1
        offset = [9.0, 9.0, 9.0] if root else TO_BVH @ mj.body_pos[body] * unit
        write("OFFSET " + " ".join(f"{x:.6f}" for x in offset))
        moves = ["Xposition", "Yposition", "Zposition"] if root else []
        channels = moves + [f"{axis}rotation" for axis in order]
        write(f"CHANNELS {len(channels)} {' '.join(channels)}")
        columns.append(body)
        children = [b for b in range(1, mj.nbody) if mj.body_parentid[b] == body]
        for child in children:
            add(child)
        if name.startswith("forearm"):  # nothing but where it ends
            hand = NAMES[name].replace("ForeArm", "Hand")
            write(f"JOINT Actor_{hand} {{ OFFSET 0 {-0.25 * unit} 0 CHANNELS 0 End Site")
            write("{ OFFSET 0 -99 -99 } }")
        elif not children:
            write("End Site { OFFSET 99 99 99 }")
        depth -= 1
        write("}")

    add(1)
    lines += ["MOTION", f"Frames: {len(positions)}", f"Frame Time: {1.0 / rate:.9f}"]
    place, axes = np.empty((len(positions), 3)), np.empty((len(positions), mj.nbody, 3, 3))
    for i, position in enumerate(positions):
        data.qpos[:] = position
        mujoco.mj_kinematics(mj, data)
        place[i], axes[i] = data.xpos[1], data.xmat.reshape(-1, 3, 3)
    table = [place @ TO_BVH.T * unit]
    for body in columns:
        above = axes[:, mj.body_parentid[body]]
        turned = TO_BVH @ above.transpose(0, 2, 1) @ axes[:, body] @ TO_BVH.T
        table.append(Rotation.from_matrix(turned).as_euler(order, degrees=True))
    lines += [" ".join(f"{x:.6f}" for x in row) for row in np.hstack(table)]
    return "\n".join(lines) + "\n"
