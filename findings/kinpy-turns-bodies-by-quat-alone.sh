#!/usr/bin/env bash
# A body that an MJCF file turns by euler, axisangle, xyaxes or zaxis is not turned in kinpy's chain.
#
# Expected: build_chain_from_mjcf reads a body's frame in each of MJCF's five notations, or refuses those that it does not
#   know, as it refuses a joint whose type is left to the default.
# Happens: quat is read, the four others are passed over: the chain is that of the straight body, 0.1 to 0.5 m beside
#   MuJoCo's at the end of an arm of a metre, whatever compiler/eulerseq or angle says. Nor is a joint's ref known: 20
#   degrees of it are 20 degrees off. A joint's pos, several joints on a body and axes of any length are right.
# Seen with: kinpy 0.6.1 beside mujoco 4.0.0.
# Means: most humanoids of the field turn a body or two by euler or xyaxes. Compile a model with MuJoCo first and write it
#   from there, with every frame as a quat: mj_saveLastXML.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check kinpy==0.6.1 mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import kinpy
import mujoco
import numpy as np

ARM = """<mujoco><worldbody>
  <body name="upper" pos="0 0 1"><joint name="one" type="hinge" axis="0 1 0" {joint}/><geom type="sphere" size="0.1"/>
    <body name="lower" pos="0.1 0.2 -0.4" {turn}><joint name="two" type="hinge" axis="0 1 0"/><geom type="sphere" size="0.1"/>
      <body name="tip" pos="0 0.2 -0.5"><joint name="three" type="hinge" axis="1 0 0"/><geom type="sphere" size="0.05"/></body>
    </body>
  </body>
</worldbody></mujoco>"""
CASES = {
    "as it is": {},
    "quat": {"turn": 'quat="1 1 0 0"'},
    "joint pos": {"joint": 'pos="0 0 0.1"'},
    "euler": {"turn": 'euler="0 0 30"'},
    "axisangle": {"turn": 'axisangle="0 1 0 30"'},
    "xyaxes": {"turn": 'xyaxes="0 1 0 -1 0 0"'},
    "zaxis": {"turn": 'zaxis="1 0 1"'},
    "joint ref": {"joint": 'ref="20"'},
}
ANGLES = {"one": 0.3, "two": 0.6, "three": 0.0}  # rad
print("kinpy", version("kinpy"), "mujoco", mujoco.__version__, "- where the tip is [m]")
off = {}
for name, case in CASES.items():
    text = ARM.format(**{"turn": "", "joint": "", **case})
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for joint, angle in ANGLES.items():
        data.joint(joint).qpos[:] = angle
    mujoco.mj_kinematics(model, data)
    true, found = data.body("tip").xpos, kinpy.build_chain_from_mjcf(text).forward_kinematics(ANGLES)["tip"].pos
    off[name] = float(np.linalg.norm(found - true))
    print(f"{name:10} mujoco {true.round(3)}  kinpy {np.round(found, 3)}  apart {off[name]:.3f}")
right, wrong = list(CASES)[:3], list(CASES)[3:]
if max(off[name] for name in right) > 1e-6 or min(off[name] for name in wrong) < 0.1:
    raise SystemExit("CHANGED: kinpy reads other notations than quat, or not even that")
PY
