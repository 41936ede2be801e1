#!/usr/bin/env bash
# Two attitudes that are a right angle apart are 127 degrees apart to ahrs' angular_distance, and 90 to its qad.
#
# Expected: the angular distance of two rotations is the angle of the turn between them, at most half a turn. Its documentation says so: the usual
#   norm of the vector that is the logarithm.
# Happens: the norm is taken of the logarithm as a matrix, in which each part of that vector stands twice: all distances are greater by the root of two,
#   and reach 255 degrees. The two examples in its documentation, 1.571 and 1.282, are 1.996 and 4.293 today. qad, for quaternions, is right;
#   so are the order of distances and which of two filters is better.
# Seen with: AHRS 0.4.0, SciPy 1.17.1 for comparison. Its issue 122 tells of a logarithm that was wrong in another way before.
# Means: an error of a filter or of a pose in degrees, held against one from a paper or from another module, is 41 % too large, which is within what
#   one believes of an IMU. A limit that is tuned on it is too wide where qad takes its place. Take qad, or SciPy's magnitude().
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check AHRS==0.4.0 scipy==1.17.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from ahrs import DCM
from ahrs.utils.metrics import angular_distance, qad
from scipy.spatial.transform import Rotation

print("AHRS", version("AHRS"), "scipy", version("scipy"))
start = Rotation.from_euler("xyz", [0.4, -0.3, 1.1])
for degrees in (1.0, 30.0, 90.0, 179.0):
    end = start * Rotation.from_rotvec(np.radians(degrees) * np.array([2.0, -1.0, 2.0]) / 3.0)
    truth = np.degrees((start.inv() * end).magnitude())
    by_matrix = np.degrees(angular_distance(start.as_matrix(), end.as_matrix()))
    by_quaternion = np.degrees(qad(start.as_quat(scalar_first=True), end.as_quat(scalar_first=True)))
    print(f"{truth:.1f} degrees apart: angular_distance {by_matrix:.2f}, qad {by_quaternion:.2f}")
    if abs(by_quaternion - truth) > 1e-6:
        raise SystemExit("CHANGED: qad is not the angle")
    if abs(by_matrix - np.sqrt(2) * truth) > 1e-3:
        raise SystemExit("CHANGED: angular_distance is not the angle times the root of two")
examples = [angular_distance(DCM(rpy=one), DCM(rpy=other)) for one, other in (([0.0] * 3, [90.0] * 3), ([10.0, -20.0, 30.0], [-10.0, 20.0, -30.0]))]
print(f"the examples of its documentation: {examples[0]:.3f} and {examples[1]:.3f}")
if abs(examples[0] - 1.9965) > 1e-3 or abs(examples[1] - 4.293) > 1e-3:
    raise SystemExit("CHANGED: the examples of the documentation have other values")
PY
