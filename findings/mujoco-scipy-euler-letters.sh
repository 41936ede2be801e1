#!/usr/bin/env bash
# "xyz" is one thing to MuJoCo and the opposite to scipy.
#
# Expected: two libraries that spell an Euler sequence by letters, and tell rotating from fixed axes by upper and
#   lower case, agree on which is which.
# Happens: MuJoCo's eulerseq="xyz" turns about axes that move with the body, its "XYZ" about fixed ones. To
#   scipy.spatial.transform.Rotation lower case is fixed (extrinsic), upper case moving (intrinsic). Three angles of 30,
#   40 and 50 degrees under the same three letters are 45 degrees apart.
# Seen with: mujoco 4.0.0, scipy 1.17.1. Both say so in their references; MuJoCo's default is "xyz".
# Means: swap the case when angles go from one to the other. Small angles hide the mistake: it grows with their
#   products, so a standing pose looks right and a roll does not.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math

import mujoco
import scipy
from scipy.spatial.transform import Rotation

ANGLES = [30.0, 40.0, 50.0]


def by_mujoco(letters, angles):
    text = f"""<mujoco><compiler eulerseq="{letters}"/><worldbody><body euler="{angles[0]} {angles[1]} {angles[2]}"/>
    </worldbody></mujoco>"""
    return Rotation.from_quat(mujoco.MjModel.from_xml_string(text).body_quat[1], scalar_first=True)


def apart(first, second):
    return math.degrees((first.inv() * second).magnitude())


print("mujoco", mujoco.__version__, "scipy", scipy.__version__)
gap = {}
for ours, theirs in (("xyz", "xyz"), ("XYZ", "XYZ"), ("xyz", "XYZ"), ("XYZ", "xyz")):
    gap[ours, theirs] = apart(by_mujoco(ours, ANGLES), Rotation.from_euler(theirs, ANGLES, degrees=True))
    print(f"MuJoCo {ours}, scipy {theirs}: {gap[ours, theirs]:6.3f} degrees apart")
small = [angle / 20 for angle in ANGLES]
print(f"angles a twentieth of these, both xyz: {apart(by_mujoco('xyz', small), Rotation.from_euler('xyz', small, degrees=True)):.3f}")
if min(gap["xyz", "xyz"], gap["XYZ", "XYZ"]) < 10 or max(gap["xyz", "XYZ"], gap["XYZ", "xyz"]) > 1e-4:
    raise SystemExit("CHANGED: the two libraries agree on what the case of the letters means")
PY
