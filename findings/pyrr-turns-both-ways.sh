#!/usr/bin/env bash
# In pyrr a quaternion turns a vector to the left, and the matrix made of that quaternion turns it to the right.
#
# Expected: quaternion and matrix of one turn do the same to a vector, whatever the library's order of multiplication, and a turn about the
#   axis (0, 0, 1) is one about z.
# Happens: Matrix33(q) * v, q.matrix33 * v and matrix33.apply_to_vector put the vector before the matrix, which is made for standing before
#   the vector: the turn is the inverse. matrix33.create_from_axis_rotation gives the transpose of create_from_z_rotation with the
#   same angle (matrix44 as well), and a quaternion read back from it has the other sense. Each by itself is a proper rotation.
# Seen with: pyrr 0.10.3, numpy 2.4.6.
# Means: a chain that is half quaternions and half matrices bends some joints backwards, and two such mistakes cancel. Make all
#   matrices by create_from_quaternion and multiply with @.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pyrr==0.10.3 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from pyrr import Matrix33, Quaternion, Vector3, matrix33, matrix44, quaternion

ANGLE = np.radians(30.0)
AHEAD, UP = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])


def heading(vector):
    """Of a level vector, in degrees to the left of ahead."""
    return round(float(np.degrees(np.arctan2(vector[1], vector[0]))), 6)


q = Quaternion.from_z_rotation(ANGLE)
seen = {
    "q * v": heading(q * Vector3(AHEAD)),
    "quaternion.apply_to_vector(q, v)": heading(quaternion.apply_to_vector(q, AHEAD)),
    "Matrix33(q) * v": heading(Matrix33(q) * Vector3(AHEAD)),
    "matrix33.apply_to_vector(of q, v)": heading(matrix33.apply_to_vector(matrix33.create_from_quaternion(q), AHEAD)),
    "matrix33 of q @ v": heading(matrix33.create_from_quaternion(q) @ AHEAD),
    "matrix33 about z @ v": heading(matrix33.create_from_z_rotation(ANGLE) @ AHEAD),
    "matrix33 about (0, 0, 1) @ v": heading(matrix33.create_from_axis_rotation(UP, ANGLE) @ AHEAD),
    "matrix44 about (0, 0, 1) @ v": heading(matrix44.create_from_axis_rotation(UP, ANGLE)[:3, :3] @ AHEAD),
}
print("pyrr", version("pyrr"))
for name, degrees in seen.items():
    print(f"{name:35s} {degrees:+.0f} degrees")
if sorted(seen.values()) != [-30.0] * 4 + [30.0] * 4:
    raise SystemExit("CHANGED: fewer ways to turn the other way")
PY
