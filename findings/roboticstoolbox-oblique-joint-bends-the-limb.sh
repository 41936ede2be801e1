#!/usr/bin/env bash
# Load a URDF with an oblique ankle into the Robotics Toolbox: with every joint at zero the foot is bent already.
#
# Expected: at zero a joint's axis, whichever way it points, leaves the limb behind it as it is, as URDF defines it; or an
#   axis that is none of x, y and z is refused.
# Happens: an axis that is none of them is taken for a rotation vector: the frame is turned by it, a unit axis thus by one
#   radian, and the joint turns about z there. All that hangs on it is 57.3 degrees off at zero already, hinge or slide.
#   x, y, z and their opposites are right. Nothing is said, and a plot shows a plausible robot of another build.
# Seen with: roboticstoolbox-python 1.4.4, Robot.URDF and fkine, beside yourdfpy 0.0.60; its issues 253 and
#   441 ask for such axes.
# Means: the ankle's and the thumb's axes of human models are oblique. Compare a loaded model's zero pose with a second
#   reader's, or turn the joint's origin so that its axis is z, and turn back in the next one's.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
python3 -m venv "$work/other"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check roboticstoolbox-python==1.4.4 "numpy<2"
"$work/other/bin/pip" install --quiet --disable-pip-version-check yourdfpy==0.0.60 numpy==2.4.6
cd "$work"
cat > shared.py <<'PY'
LEG = """<robot name="leg"><link name="shin"/><link name="foot"/><link name="toe"/>
  <joint name="ankle" type="{kind}"><parent link="shin"/><child link="foot"/><origin xyz="0 0 -0.4"/>
    <axis xyz="{axis}"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="ball" type="fixed"><parent link="foot"/><child link="toe"/><origin xyz="0.2 0 -0.1"/></joint>
</robot>"""
CASES = [("revolute", axis) for axis in ("1 0 0", "0 1 0", "0 0 -1", "0 0.6 0.8", "0.6 0 0.8")] + [
    ("prismatic", axis) for axis in ("0 0 1", "0 0.6 0.8")
]


def model(case):
    kind, axis = case
    with open("leg.urdf", "w") as file:
        file.write(LEG.format(kind=kind, axis=axis))
    return "leg.urdf"
PY
"$work/other/bin/python" - <<'PY'
import json

import yourdfpy
from shared import CASES, model

toes = []
for case in CASES:
    robot = yourdfpy.URDF.load(model(case), load_meshes=False)
    robot.update_cfg({"ankle": 0.0})
    toes.append(robot.get_transform("toe", "shin").tolist())
with open("toes.json", "w") as file:
    json.dump(toes, file)
PY
"$work/venv/bin/python" -W ignore - <<'PY'
import json
import os
from importlib.metadata import version

import numpy as np
import roboticstoolbox
from shared import CASES, model

print("roboticstoolbox-python", version("roboticstoolbox-python"), "- an ankle at zero")
turned = {}
with open("toes.json") as file:
    toes = [np.array(each) for each in json.load(file)]
for case, toe in zip(CASES, toes):
    robot = roboticstoolbox.Robot.URDF(os.path.abspath(model(case)))
    found = robot.fkine([0.0], end="toe").A
    cosine = (np.trace(found[:3, :3].T @ toe[:3, :3]) - 1.0) / 2.0
    turned[case] = float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
    print(f"{case[0]:9} {case[1]:9} toe at {found[:3, 3].round(3) + 0.0}, by yourdfpy {toe[:3, 3]}, turned by {turned[case]:.1f} deg")
oblique = {case for case in CASES if "0.6" in case[1]}
if any(abs(turned[case] - (np.degrees(1.0) if case in oblique else 0.0)) > 0.01 for case in CASES):
    raise SystemExit("CHANGED: an oblique axis leaves the limb as it is, or bends it otherwise")
PY
