#!/usr/bin/env bash
# Roll a body by 17 degrees with ahrs: the matrix that comes is one of yaw, and asked for its angles says a yaw of -17.
#
# Expected: DCM(rpy=a) and Quaternion(rpy=a), "roll-pitch-yaw angles" both, are one attitude in two forms, and to_rpy() of the first gives a again,
#   as to_angles() of the second does.
# Happens: Quaternion takes the three as turns about x, y and z, DCM the first about z and the last about x. With 0.1, 0.2 and 0.3 they are 18 degrees
#   apart; with a pitch alone they are the same. DCM.to_rpy() reads another order once more, of the transposed matrix: of the matrix by a roll of
#   0.3 it says 0, 0 and -0.3, of that by a pitch of 0.3 that it is -0.3. Of all that were tried only zero angles come back from it.
# Seen with: AHRS 0.4.0, SciPy 1.17.1 for comparison.
# Means: trunk angles of a filter, which come as quaternions, and those of a rig or a simulator, which come as matrices, are of unlike axes, and in
#   a comparison lean and turn are exchanged. Signs alone look like a matter of axes down or up, which north-east-down makes one expect. Make matrices
#   of quaternions, and read angles by Quaternion.to_angles() or SciPy.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check AHRS==0.4.0 scipy==1.17.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from ahrs import DCM, Quaternion
from scipy.spatial.transform import Rotation


def same(one, other):
    return np.abs(np.asarray(one) - np.asarray(other)).max() < 1e-9


print("AHRS", version("AHRS"), "scipy", version("scipy"))
for angles in ([0.0, 0.0, 0.0], [0.3, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 0.3], [0.1, 0.2, 0.3]):
    roll, pitch, yaw = angles
    turns = [Rotation.from_rotvec(angle * axis) for angle, axis in zip(angles, np.eye(3))]
    right, reversed_ = turns[2] * turns[1] * turns[0], Rotation.from_euler("ZYX", angles)
    quaternion, matrix = Quaternion(rpy=angles), DCM(rpy=angles)
    apart = np.degrees((Rotation.from_matrix(matrix) * right.inv()).magnitude())
    print(f"{angles}: matrix and quaternion are {apart:.1f} degrees apart; they tell {matrix.to_rpy().round(3) + 0.0} and {quaternion.to_angles().round(3) + 0.0}")
    if not same(quaternion.to_DCM(), right.as_matrix()) or not same(quaternion.to_angles(), angles):
        raise SystemExit("CHANGED: the quaternion is of other angles")
    if not same(matrix, reversed_.as_matrix()):
        raise SystemExit("CHANGED: the matrix is no longer yaw by the first angle and roll by the last")
    if not same(matrix.to_rpy(), Rotation.from_matrix(matrix).inv().as_euler("ZYX")[::-1]):
        raise SystemExit("CHANGED: to_rpy reads other angles")
    if any(angles) and same(matrix.to_rpy(), angles):
        raise SystemExit("CHANGED: the angles come back")
PY
