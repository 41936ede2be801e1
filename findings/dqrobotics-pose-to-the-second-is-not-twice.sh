#!/usr/bin/env bash
# A pose that goes 1 m forward and turns by 90 degrees: made twice it is at (1, 1), and to the power of 2 DQ Robotics has it at (2, 0).
#
# Expected: pow(x, a), "x raised to the power of a", of a unit dual quaternion has x^2 = x x, x^-1 the inverse and (x^0.5)^2 = x: a times the one screw that x is. That is what
#   powers of poses are for, in ScLERP, and so it is with the quaternion of a pure rotation.
# Happens: turn and place are multiplied each by itself. x^2 is turned rightly and lies at (2, 0) in place of (1, 1), x^-1 at (-1, 0) where the inverse lies at (0, 1), and
#   x^0.5 twice over comes to (0.85, 0.35) in place of (1, 0). log() is half the rotation vector and half the place, without what couples them; exp() undoes it, so that
#   exp(log(x)) = x passes as a test. Of a rotation alone, or a displacement alone, all powers are right.
# Seen with: dqrobotics 26.4.0a7, numpy 2.4.6; scipy 1.17.1 for the truth. Issues of a like package, dual_quaternions, tell of pow and ScLERP by screws; of this one none was found.
# Means: between two poses a hand or a root follows no screw and no straight line either, and depends on where the origin of the world lies. Steps of a pose by x^(1/n) do
#   not add up to x. Take the logarithm of a 4x4 matrix (Pinocchio's log6, scipy's logm), or interpolate place and turn each by itself and say so.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check dqrobotics==26.4.0a7 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from dqrobotics import DQ, E_, exp, log, pow, rotation, translation, vec3, vec4, vec8
from scipy.linalg import expm, logm
from scipy.spatial.transform import Rotation


def pose(vector, place):
    """The unit dual quaternion of a rotation vector and a place."""
    turn = DQ(np.roll(Rotation.from_rotvec(vector).as_quat(), 1))
    return turn + E_ * 0.5 * DQ(place) * turn


def matrix(x):
    told = np.eye(4)
    told[:3, :3] = Rotation.from_quat(np.roll(vec4(rotation(x)), -1)).as_matrix()
    told[:3, 3] = vec3(translation(x))
    return told


def rightly(x, exponent):
    return expm(exponent * logm(matrix(x)).real)


def apart(one, other):
    """Distance of two places [m] and angle between two attitudes [degrees]."""
    turn = Rotation.from_matrix(one[:3, :3].T @ other[:3, :3]).magnitude()
    return float(np.linalg.norm((one - other)[:3, 3])), float(np.degrees(turn))


print("dqrobotics", version("dqrobotics"))
quarter = pose([0, 0, np.pi / 2], [1.0, 0, 0])
truths = {2: matrix(quarter) @ matrix(quarter), -1: np.linalg.inv(matrix(quarter)), 0.5: rightly(quarter, 0.5)}
shift = {}
for exponent, truth in truths.items():
    if max(apart(truth, rightly(quarter, exponent))) > 1e-6:
        raise SystemExit("CHANGED: scipy's logarithm is another")
    power = matrix(pow(quarter, exponent))
    shift[exponent], turn = apart(power, truth)
    print(f"x^{exponent}: at {power[:3, 3].round(3) + 0.0}, rightly {truth[:3, 3].round(3) + 0.0}, {shift[exponent]:.2f} m and {turn:.1f} degrees off")
    if turn > 1e-6:
        raise SystemExit("CHANGED: powers are turned otherwise")
half = pow(quarter, 0.5)
print("x^0.5 x^0.5 at", matrix(half * half)[:3, 3].round(3) + 0.0, "and x x at", matrix(quarter * quarter)[:3, 3].round(3) + 0.0)
if np.abs(vec8(exp(log(quarter)) - quarter)).max() > 1e-12:
    raise SystemExit("CHANGED: exp does not undo log")
alone = [pose([0.3, -0.5, 1.2], [0, 0, 0]), pose([0, 0, 0], [1.0, 2.0, 3.0])]
if max(max(apart(matrix(pow(x, exponent)), rightly(x, exponent))) for x in alone for exponent in (2, -1, 0.5)) > 1e-5:
    raise SystemExit("CHANGED: powers of a rotation or of a displacement alone are wrong")
if min(shift.values()) < 0.1 or np.linalg.norm(matrix(half * half)[:3, 3] - [1, 0, 0]) < 0.1:
    raise SystemExit("CHANGED: powers are those of the screw")
PY
