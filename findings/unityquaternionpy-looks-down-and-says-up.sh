#!/usr/bin/env bash
# Turn a head down by 82 to 98 degrees: eulerAngles of UnityQuaternionPy says that it looks straight up.
#
# Expected: the package imitates Unity's Quaternion, whose eulerAngles are z, then x, then y, each from 0 to 360 degrees. Euler(*q.eulerAngles) is the rotation q. Only with x at 90 or
#   270 degrees exactly have y and z one angle between them, and there 0 is told for y.
# Happens: all attitudes whose x is within 8.1 degrees of straight up or down, a sine of more than 0.99, are taken for the exact case. Their x is not only rounded but has the wrong
#   sign: 82 degrees down are told as 270, which is straight up, and 82 up as 90. Put in again, Euler(85, 20, 30) comes back 176 degrees off. At 81 degrees all is right.
# Seen with: UnityQuaternionPy 0.1.2 (eulerAngles in its one class). Its documentation gives the order ZXY and no bound.
# Means: of a roll, a dive or a hand that is raised, x jumps from 81 to 270 and later back, and y and z jump with it; filters and differences make a fast twist of that, and a clip
#   that is written with these angles and read again looks the other way for some frames. Turn with quaternions, or take scipy's as_euler("YXZ") of (x, y, z, w), whose formulae
#   hold in left-handed axes, too.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check UnityQuaternionPy==0.1.2 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from scipy.spatial.transform import Rotation
from UnityQuaternion import Quaternion

print("UnityQuaternionPy", version("UnityQuaternionPy"), "- x, y, z that go in and come out [deg], and how far the attitude of the latter is off")
for y, z in ((20.0, 30.0), (-100.0, 5.0)):
    for x in (60.0, 81.0, 82.0, 85.0, 89.0, 95.0, -60.0, -81.0, -82.0, -85.0, -89.0):
        there = Quaternion.Euler(x, y, z)
        told = there.eulerAngles
        back = Quaternion.Euler(*told)
        one, other = (Rotation.from_quat([q.x, q.y, q.z, q.w]) for q in (there, back))
        off = float(np.degrees((one * other.inv()).magnitude()))
        print(f"in {x:5.0f} {y:5.0f} {z:3.0f}   out", *(f"{angle:7.2f}" for angle in told), f"  off by {off:.2f}")
        true = Rotation.from_euler("YXZ", [y, x, z], degrees=True)
        if (one * true.inv()).magnitude() > 1e-9:
            raise SystemExit("CHANGED: Euler makes another rotation")
        if abs(np.sin(np.radians(x))) < 0.99:
            if off > 1e-4 or np.abs((np.array(told) - [x, y, z] + 180) % 360 - 180).max() > 1e-6:
                raise SystemExit("CHANGED: angles away from straight up and down are others")
        elif abs(told[0] - (270 if x > 0 else 90)) > 1e-9 or told[1] != 0:
            raise SystemExit("CHANGED: near straight up and down other angles are told")
        elif off < 160:
            raise SystemExit("CHANGED: the attitude near straight up and down is less far off")
exact = [Quaternion.Euler(x, 0.0, 0.0).eulerAngles[0] for x in (90.0, -90.0)]
print("x of 90 and -90 alone:", np.round(exact, 9))
if np.abs(np.array(exact) - [270, 90]).max() > 1e-9:
    raise SystemExit("CHANGED: straight up and down are told otherwise")
PY
