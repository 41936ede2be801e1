#!/usr/bin/env bash
# Pinocchio shifts the limits of an MJCF joint that has a ref, and leaves its angles alone.
#
# Expected: q means the same in MuJoCo and in a Pinocchio model read from the same MJCF, and so do its limits.
# Happens: with ref="0.5" and range="-1 1" equal q gives equal positions of the body, but Pinocchio's limits are -1.5
#   and 0.5. Half a radian of allowed motion is refused there, and half a radian of forbidden motion is allowed.
# Seen with: pin 4.1.0, mujoco 4.0.0. MuJoCo counts range on the same scale as q, on which ref is the initial pose.
# Means: an inverse kinematics or QP that takes its limits from the Pinocchio model stops a knee too early on one side and
#   drives it into MuJoCo's limit on the other. Characters that are drawn bent, with ref to say by how much, have it.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import mujoco
import numpy as np
import pinocchio

TEXT = """<mujoco model="knee"><compiler angle="radian"/><worldbody><body name="shin" pos="0 0 1">
<joint name="knee" axis="0 1 0" ref="0.5" range="-1 1"/><geom type="capsule" fromto="0 0 0 0 0 -.4" size=".05"/></body>
</worldbody></mujoco>"""
with open("knee.xml", "w") as file:
    file.write(TEXT)
simulated = mujoco.MjModel.from_xml_string(TEXT)
data = mujoco.MjData(simulated)
analysed = pinocchio.buildModelFromMJCF("knee.xml")

gap = 0.0
for angle in (-0.9, 0.0, 0.5, 0.9):
    data.qpos[0] = angle
    mujoco.mj_forward(simulated, data)
    com = pinocchio.centerOfMass(analysed, analysed.createData(), np.array([angle]))
    gap = max(gap, float(np.abs(com - data.subtree_com[0]).max()))
limits = [float(analysed.lowerPositionLimit[0]), float(analysed.upperPositionLimit[0])]
print("pin", pinocchio.__version__, "mujoco", mujoco.__version__)
print(f"same q, centres of mass apart by at most {gap:.1e} m")
print("limits: MuJoCo", simulated.jnt_range[0].tolist(), "Pinocchio", limits)

data.qpos[0] = 0.9  # allowed by MuJoCo
mujoco.mj_forward(simulated, data)
print("q = 0.9: MuJoCo has", data.nefc, "active limits, Pinocchio's upper limit is exceeded by", round(0.9 - limits[1], 3))
if gap > 1e-9 or not np.allclose(limits, [-1.5, 0.5]):
    raise SystemExit("CHANGED: Pinocchio's limits are those of the file, or its angles have another zero")
PY
