#!/usr/bin/env bash
# Pinocchio reads MJCF's eulerseq="XYZ" as "xyz": bodies come out turned, without a word.
#
# Expected: an MJCF reader that knows eulerseq at all knows that upper case means fixed axes; else it refuses.
# Happens: the letters are honoured, their case is not. Under XYZ and ZYX a body with euler angles of 0.3, 0.4 and 0.5 rad
#   is turned by 15 degrees against MuJoCo; under xyz and zyx the two agree to the last bits.
# Seen with: pin 4.1.0, mujoco 4.0.0. The reader multiplies the three turns in the order of the letters; for fixed axes
#   it would be the reverse order.
# Means: the roll, pitch and yaw of a URDF are eulerseq="XYZ" in MJCF. Most bodies of such a model have
#   single-axis angles, right either way; the few tilted shoulders and hips are wrong. Compare the
#   centre of mass of the two models once, in a pose that is not zero.
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

TEXT = """<mujoco model="m"><compiler angle="radian" eulerseq="{}"/><worldbody>
<body name="upper_arm" euler=".3 .4 .5"><joint name="shoulder" axis="0 1 0"/><geom type="box" size=".1 .2 .3"/></body>
</worldbody></mujoco>"""

print("pin", pinocchio.__version__, "mujoco", mujoco.__version__)
turned = {}
for letters in ("xyz", "zyx", "XYZ", "ZYX"):
    with open("arm.xml", "w") as file:
        file.write(TEXT.format(letters))
    simulated = mujoco.MjModel.from_xml_path("arm.xml")
    data = mujoco.MjData(simulated)
    mujoco.mj_forward(simulated, data)
    analysed = pinocchio.buildModelFromMJCF("arm.xml")
    placed = analysed.createData()
    pinocchio.forwardKinematics(analysed, placed, pinocchio.neutral(analysed))
    difference = data.body("upper_arm").xmat.reshape(3, 3).T @ placed.oMi[1].rotation
    turned[letters] = float(np.degrees(np.linalg.norm(pinocchio.log3(difference))))
    print(f'eulerseq="{letters}": {turned[letters]:6.3f} degrees between the two')
if max(turned["xyz"], turned["zyx"]) > 1e-6 or min(turned["XYZ"], turned["ZYX"]) < 5:
    raise SystemExit("CHANGED: Pinocchio heeds the case of eulerseq")
PY
