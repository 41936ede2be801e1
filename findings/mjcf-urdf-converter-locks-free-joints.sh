#!/usr/bin/env bash
# A knee without limits is locked after mjcf-urdf-simple-converter, and a foot on three hinges hangs 8 cm below its ankle.
#
# Expected: a converter from MJCF to URDF makes a hinge without a range a continuous joint; with nothing turned, each link is where it was, as its
#   docstring promises for the kinematic structure, leaving out the rest.
# Happens: every hinge becomes a revolute joint with MuJoCo's range, which is 0 to 0 where there is none. Between joints of one body the converter sums up
#   their places, each of which counts from the body already: two are right, the third is shifted back by as much as they are off the body's origin,
#   and the link with it. Joints at the origin of their body show nothing. Nothing is said.
# Seen with: mjcf-urdf-simple-converter 0.7.3, pin 4.1.0 to read URDF, mujoco 4.0.0, which ignores such limits with a warning when it reads the result.
# Means: a picture of the standing model is right but for shoulders and ankles that are a bit too long. Inverse kinematics and planners that keep to
#   limits never bend the knee, and say that a pose can't be reached. Give each joint a range, one joint to a body.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mjcf-urdf-simple-converter==0.7.3 pin==4.1.0 mujoco==4.0.0 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version
from pathlib import Path

import mujoco
import numpy as np
import pinocchio
from mjcf_urdf_simple_converter import convert

HINGES = [f'<joint name="{name}" axis="{axis}" pos="0 0 .08" range="-.5 .5"/>' for name, axis in (("pitch", "0 1 0"), ("roll", "1 0 0"), ("yaw", "0 0 1"))]
LEG = """<mujoco><compiler angle="radian"/><worldbody><body name="shin" pos="0 0 1"><joint name="knee" axis="0 1 0"/>
<inertial pos="0 0 -.2" mass="4" diaginertia=".05 .05 .01"/><body name="foot" pos="0 0 -.4">{hinges}
<inertial pos=".05 0 -.03" mass="1" diaginertia=".002 .004 .005"/></body></body></worldbody></mujoco>"""

print("mjcf-urdf-simple-converter", version("mjcf-urdf-simple-converter"), "pin", pinocchio.__version__, "mujoco", mujoco.__version__)
off, ranges = {}, {}
for count in (1, 2, 3):
    Path("leg.xml").write_text(LEG.format(hinges="".join(HINGES[:count])))
    convert("leg.xml", "leg.urdf")
    model = mujoco.MjModel.from_xml_path("leg.xml")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    read = pinocchio.buildModelFromUrdf("leg.urdf")
    state = read.createData()
    pinocchio.framesForwardKinematics(read, state, pinocchio.neutral(read))
    place = state.oMf[read.getFrameId("foot")].translation
    off[count] = place - data.body("foot").xpos
    knee = read.joints[read.getJointId("knee")].idx_q
    ranges[count] = (float(read.lowerPositionLimit[knee]), float(read.upperPositionLimit[knee]))
    limits = f"knee limited in MuJoCo: {bool(model.joint('knee').limited[0])}, limits after conversion {ranges[count]}"
    print(f"{count} hinges in the ankle: foot {1000 * off[count][2] + 0.0:6.1f} mm from where it was; {limits}")
if any(bounds != (0, 0) for bounds in ranges.values()):
    raise SystemExit("CHANGED: a joint without limits is not locked")
if not np.allclose([off[1], off[2]], 0, atol=1e-9) or not np.allclose(off[3], [0, 0, -0.08], atol=1e-9):
    raise SystemExit("CHANGED: a third joint is where it was, or others are not")
PY
