#!/usr/bin/env bash
# Make a rotation of yaw, pitch and roll about fixed axes with se3kit and ask for the same angles: roll comes back with the other sign.
#
# Expected: from_zyx and as_zyx of its Rotation take the same keyword extrinsic, and so do from_rpy and as_rpy; what goes in with one setting comes out with the same,
#   away from a pitch of 90 degrees.
# Happens: with from_zyx(..., extrinsic=True) and as_zyx(extrinsic=True), and with extrinsic=False for both of the rpy functions, (30, 20, 10) degrees come back as
#   (30, 20, -10). as_xyz, which both go by, takes the arc tangent of an element of the matrix that is minus the sine of that angle, and leaves the minus in. The other
#   two settings, which are the defaults, are right, and a rotation without roll is right in all four. as_xyz() on its own has the wrong sign as well.
# Seen with: se3kit 1.0.6, numpy-quaternion 2024.0.13, numpy 2.4.6, scipy 1.17.1, whose Rotation tells 10 for each of them. The docstrings tell one order
#   of angles for both directions.
# Means: the setting that is not the default is the one that is asked for by name, for joint angles of the order x, y', z''. Made from such angles and read again twice,
#   a pose is as before, so a test of two round trips passes; one of them leans a trunk to the other side by twice its roll. Ask scipy for "XYZ".
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check se3kit==1.0.6 numpy-quaternion==2024.0.13 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from scipy.spatial.transform import Rotation as Reference
from se3kit.rotation import Rotation

print("se3kit", version("se3kit"), "- angles [deg] that go in, come out, and are in the matrix by scipy")
for roll, pitch, yaw in ((10.0, 20.0, 30.0), (-75.0, -40.0, 160.0), (0.0, 20.0, 30.0)):
    for kind, angles in (("zyx", [yaw, pitch, roll]), ("rpy", [roll, pitch, yaw])):
        for extrinsic in (False, True):
            turn = getattr(Rotation, "from_" + kind)(angles, extrinsic=extrinsic, degrees=True)
            back = np.asarray(getattr(turn, "as_" + kind)(extrinsic=extrinsic, degrees=True), dtype=float)
            letters = {"zyx": "zyx", "rpy": "xyz"}[kind]
            true = Reference.from_matrix(turn.m).as_euler(letters if extrinsic else letters.upper(), degrees=True)
            print(f"{kind}, {'fixed' if extrinsic else 'moving'} axes: in {angles}, out {np.round(back, 6)}, by scipy {np.round(true, 6)}")
            if np.abs(true - angles).max() > 1e-9:
                raise SystemExit("CHANGED: another rotation is made of the angles")
            mirrored = extrinsic == (kind == "zyx")
            told = np.where(np.arange(3) == angles.index(roll), -1 if mirrored else 1, 1) * np.array(angles)
            if np.abs(back - told).max() > 1e-9:
                raise SystemExit("CHANGED: other angles come back")
    alone = np.asarray(Rotation(Reference.from_euler("XYZ", [roll, pitch, yaw], degrees=True).as_matrix()).as_xyz(degrees=True), dtype=float)
    print("   as_xyz of a matrix by scipy:", np.round(alone, 6))
    if np.abs(alone - [-roll, pitch, yaw]).max() > 1e-9:
        raise SystemExit("CHANGED: as_xyz tells other angles")
PY
