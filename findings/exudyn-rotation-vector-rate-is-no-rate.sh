#!/usr/bin/env bash
# To Exudyn's RotationVector2GLocal the angular velocity of a body is the rate of its rotation vector, whatever the rotation vector is.
#
# Expected: of three pairs of functions that turn rates of rotation parameters into angular velocities, described alike as the derivative of angular
#   velocity by parameter rate, each is right for its parameters. For a rotation vector that matrix is the tangent of the exponential map.
# Happens: EulerParameters2G and RotXYZ2G are right, in the world's axes and in those of the body. RotationVector2G is the rotation matrix
#   and RotationVector2GLocal is the unit matrix. Both are right at no turn, and as long as the axis stays. Where the axis tilts, a body that is
#   turned by a quarter has 90 % of the speed that is told, 45 degrees askew, and at 170 degrees two thirds of it, 85 degrees askew. The
#   tangent is there under another name: lieGroupBasics.TExpSO3 is what is right in the body's axes.
# Seen with: exudyn 1.13.6, scipy 1.17.1 for comparison. The matrices fit its Lie group nodes, in whose formulas the rate is replaced by an
#   angular velocity in the body; the description tells of the rate.
# Means: angular velocities of a clip in rotation vectors, as SMPL has them, are near for small angles, and wrong for a hip or a rolling trunk; so are
#   momentum and energy made of them. Take TExpSO3, or the pair for quaternions.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check exudyn==1.13.6 scipy==1.17.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from exudyn import lieGroupBasics
from exudyn import rigidBodyUtilities as rigid
from scipy.spatial.transform import Rotation

STEP = 1e-6


def difference(parameters, vector, rate):
    """Central difference of parameters(rotation) along a rotation vector that changes at a rate."""
    after, before = (parameters(Rotation.from_rotvec(vector + sign * STEP * rate)) for sign in (1, -1))
    return (after - before) / (2 * STEP)


def velocities(vector, rate):
    """Angular velocity in the world and in the body, by finite differences of the attitude."""
    after, before = (Rotation.from_rotvec(vector + sign * STEP * rate) for sign in (1, -1))
    return (after * before.inv()).as_rotvec() / (2 * STEP), (before.inv() * after).as_rotvec() / (2 * STEP)


def near(one, other):
    return np.abs(one - other).max() < 1e-6


print("exudyn", version("exudyn"), "scipy", version("scipy"))
tilt = np.array([0.0, 1.0, 0.0])
for degrees in (0.0, 10.0, 90.0, 170.0):
    vector = np.array([np.radians(degrees), 0.0, 0.0])
    world, body = velocities(vector, tilt)
    attitude = Rotation.from_rotvec(vector)
    quaternion, angles = attitude.as_quat(scalar_first=True), attitude.as_euler("XYZ")
    quaternion_rate = difference(lambda rotation: rotation.as_quat(scalar_first=True), vector, tilt)
    angle_rate = difference(lambda rotation: rotation.as_euler("XYZ"), vector, tilt)
    by_quaternion = rigid.EulerParameters2G(quaternion) @ quaternion_rate, rigid.EulerParameters2GLocal(quaternion) @ quaternion_rate
    if not near(by_quaternion[0], world) or not near(by_quaternion[1], body):
        raise SystemExit("CHANGED: the pair for quaternions has other velocities")
    if not near(rigid.RotXYZ2G(angles) @ angle_rate, world) or not near(rigid.RotXYZ2GLocal(angles) @ angle_rate, body):
        raise SystemExit("CHANGED: the pair for angles has other velocities")
    if not near(lieGroupBasics.TExpSO3(vector) @ tilt, body):
        raise SystemExit("CHANGED: TExpSO3 has another velocity")
    told = rigid.RotationVector2GLocal(vector) @ tilt
    askew = np.degrees(np.arccos(told @ body / np.linalg.norm(told) / np.linalg.norm(body)))
    print(f"turned by {degrees:.0f} degrees: told {told}, is {body.round(3)}, {np.linalg.norm(body):.2f} of it and {askew:.0f} degrees askew")
    if not near(told, tilt) or not near(rigid.RotationVector2G(vector) @ tilt, attitude.apply(tilt)):
        raise SystemExit("CHANGED: the pair for rotation vectors has other velocities")
    along = np.array([1.0, 0.0, 0.0])
    if not near(rigid.RotationVector2GLocal(vector) @ along, velocities(vector, along)[1]):
        raise SystemExit("CHANGED: it is off about a steady axis, too")
PY
