#!/usr/bin/env bash
# Half a turn that has passed through single precision is a turn of 187 degrees to spatialmath.
#
# Expected: near half a turn the axis is hard to tell from a matrix, and libraries take care there; angles stay within 180 degrees, and are right to
#   many digits, as those of exact half turns are.
# Happens: the quaternion of pi in single precision, (-4.4e-8, 1, 0, 0), comes back from angvec() as 186.7 degrees, and one that was written with
#   eight digits is 0.7 degrees off. The angle is the arc cosine of a trace, in which 1e-16 is 1e-8 of the angle, and R - R' is divided by the sine of
#   that, which is as small as its own error. Exact half turns have a case of their own. log() and angdist() of SO3 and log() of SE3 do the same: by the
#   logarithm of such a pose one comes a degree beside it, and two attitudes are 181 degrees apart. UnitQuaternion.log() is right.
# Seen with: spatialmath-python 1.1.18, scipy 1.17.1 for comparison.
# Means: characters that lie face down, or face back, are turned by half a turn, and simulators and glTF keep quaternions in single precision. Errors
#   of an attitude then jump by degrees where nothing moves. Tests at 179, 179.99 or exactly 180 degrees show nothing. Take 2 * q.log(), or SciPy.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check spatialmath-python==1.1.18 scipy==1.17.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from scipy.spatial.transform import Rotation
from spatialmath import SE3, SO3, UnitQuaternion


def single(degrees, axis):
    """Quaternion, scalar first, of which all is computed and kept in single precision."""
    half = np.float32(np.radians(degrees)) / np.float32(2)
    return np.array([np.cos(half), *(np.sin(half) * np.float32(axis))], dtype=np.float64)


def off(vector, right):
    return np.degrees((Rotation.from_rotvec(vector) * right.inv()).magnitude())


print("spatialmath-python", version("spatialmath-python"), "scipy", version("scipy"))
oblique = np.array([1.0, 2.0, 2.0]) / 3.0
far = {}
for name, quaternion in {
    "179 degrees": single(179.0, oblique),
    "179.99 degrees": single(179.99, oblique),
    "180 degrees": single(180.0, oblique),
    "180 degrees about x": single(180.0, (1.0, 0.0, 0.0)),
    "179.99999 degrees, eight digits": np.round(Rotation.from_rotvec(np.radians(179.99999) * oblique).as_quat(scalar_first=True), 8),
    "180 degrees, exact": np.array([0.0, 1.0, 0.0, 0.0]),
}.items():
    right = Rotation.from_quat(quaternion, scalar_first=True)
    attitude = UnitQuaternion(quaternion)
    angle, axis = attitude.angvec()
    far[name] = off(angle * np.asarray(axis), right)
    by_logarithm = off(2.0 * np.asarray(attitude.log().v), right)
    told, is_ = np.degrees(angle), np.degrees(right.magnitude())
    print(f"{name}: angvec {told:.3f}, scipy {is_:.5f} degrees; {far[name]:.4f} off, its own logarithm {by_logarithm:.1e}")
    if by_logarithm > 1e-5:
        raise SystemExit("CHANGED: the logarithm of the quaternion is off")
quaternion = single(180.0, (1.0, 0.0, 0.0))
right = Rotation.from_quat(quaternion, scalar_first=True)
matrix = SO3(right.as_matrix(), check=False)
distance = np.degrees(matrix.angdist(SO3()))
pose = SE3.Rt(right.as_matrix(), [1.0, 2.0, 3.0], check=False)
again = np.degrees((Rotation.from_matrix(SE3.Exp(pose.log(twist=True)).R) * right.inv()).magnitude())
print(f"as matrix: {distance:.2f} degrees from no turn; there and back by the logarithm of the pose: {again:.2f} degrees off")
if far["180 degrees about x"] < 2 or far["180 degrees"] < 2 or far["179.99999 degrees, eight digits"] < 0.3 or distance < 181 or again < 0.5:
    raise SystemExit("CHANGED: half turns in single precision come out better")
if max(far["179 degrees"], far["179.99 degrees"], far["180 degrees, exact"]) > 1e-4:
    raise SystemExit("CHANGED: other turns come out worse")
PY
