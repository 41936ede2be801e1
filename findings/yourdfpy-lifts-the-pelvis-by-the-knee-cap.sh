#!/usr/bin/env bash
# Lift a character by its floating root in yourdfpy: the pelvis stays where it is, and the knee cap turns.
#
# Expected: a joint of type floating moves its link; or a library that doesn't have it refuses it, or any value for it. A joint that mimics
#   another has that one's angle times its factor, whatever else there is in the model.
# Happens: update_cfg() takes three numbers for the floating joint (seven are an error), keeps them in cfg, and leaves the pelvis at the origin. A mimicking
#   joint is looked up by the number of its joint among the joints, in a vector that has three places for the first of them: with a hip and a
#   knee behind the root, the knee cap goes by the height of the root. 1 m and a knee of 1.2 rad turn it by 0.5 rad in place of 0.6, and
#   bending the knee does nothing to it. Without the floating joint it is right.
# Seen with: yourdfpy 0.0.60, Pinocchio (pin 4.1.0) for comparison of the pelvis.
# Means: exporters write the root of a character as a floating joint. Pictures of such a model show it hanging at the origin, which is seen, and linked
#   joints that move oddly, which is hardly. Leave the root out of the file and place the scene by a transform.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check yourdfpy==0.0.60 pin==4.1.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
import pinocchio
import yourdfpy

ROOT = '<link name="world"/><joint name="root" type="floating"><parent link="world"/><child link="pelvis"/></joint>'
LEG = """<link name="pelvis"/><link name="thigh"/><link name="shin"/><link name="cap"/>
<joint name="hip" type="continuous"><parent link="pelvis"/><child link="thigh"/><axis xyz="0 1 0"/></joint>
<joint name="knee" type="continuous"><parent link="thigh"/><child link="shin"/><axis xyz="0 1 0"/></joint>
<joint name="cap" type="continuous"><parent link="thigh"/><child link="cap"/><axis xyz="0 1 0"/><mimic joint="knee" multiplier="0.5" offset="0"/></joint>"""


def model(root):
    """The leg, with or without the floating root, as text and as yourdfpy loads it."""
    text = f'<?xml version="1.0"?><robot name="leg">{root}{LEG}</robot>'
    with open("leg.urdf", "w") as file:
        file.write(text)
    return text, yourdfpy.URDF.load("leg.urdf", load_meshes=False)


def turned(leg, link):
    """Angle of a link on the thigh about y, rad."""
    pose = leg.get_transform(link, "thigh")
    return float(np.arctan2(pose[0, 2], pose[0, 0]))


print("yourdfpy", version("yourdfpy"), "pin", version("pin"))
_, alone = model("")
text, leg = model(ROOT)
seen = {}
for height, knee in ((0.0, 0.0), (0.0, 1.2), (1.0, 1.2), (1.0, 0.0)):
    alone.update_cfg({"hip": 0.3, "knee": knee})
    leg.update_cfg({"root": np.array([0.0, 0.0, height]), "hip": 0.3, "knee": knee})
    seen[height, knee] = float(leg.get_transform("pelvis", "world")[2, 3]), turned(leg, "cap"), turned(alone, "cap")
    print(f"root at {height:.0f} m, knee {knee:.1f} rad: pelvis at {seen[height, knee][0]:.1f} m, knee cap {seen[height, knee][1]:.2f} rad, "
          f"without a root {seen[height, knee][2]:.2f}, expected {0.5 * knee:.2f}")
    if abs(turned(leg, "shin") - knee) > 1e-9 or abs(seen[height, knee][2] - 0.5 * knee) > 1e-9:
        raise SystemExit("CHANGED: the knee, or the leg without a root, is no longer right")
other = pinocchio.buildModelFromXML(text)
data, pose = other.createData(), pinocchio.neutral(other)
pose[2] = 1.0
pinocchio.framesForwardKinematics(other, data, pose)
lifted = float(data.oMf[other.getFrameId("pelvis")].translation[2])
print(f"Pinocchio has {other.nq} numbers and the pelvis at {lifted:.1f} m")
if abs(lifted - 1.0) > 1e-9:
    raise SystemExit("CHANGED: Pinocchio no longer lifts the pelvis")
if any(pelvis != 0.0 or abs(cap - 0.5 * height) > 1e-9 for (height, _), (pelvis, cap, _) in seen.items()):
    raise SystemExit("CHANGED: the pelvis moves, or the knee cap no longer goes by its height")
PY
