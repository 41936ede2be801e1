#!/usr/bin/env bash
# Turn a body by exactly half a turn: SymPy makes the quaternion 0 of its matrix.
#
# Expected: Quaternion.from_rotation_matrix undoes to_rotation_matrix, but for the sign of the whole, for every rotation; half a turn
#   about x is (0, 1, 0, 0).
# Happens: the sizes of i, j and k come from the diagonal and their signs from differences of the entries beside it, which are 0 at half a
#   turn: sign(0) is 0, and all of it vanishes, the norm too. So it goes about any axis, with exact numbers. With floating point rounding
#   decides over each sign by itself: about an oblique axis they need not fit together, and then it is half a turn about another axis.
# Seen with: sympy 1.14.0, and AHRS 0.4.0, DCM.to_quaternion with method="chiaverini" and "sarabandi" of its five; its default is right.
# Means: symbolic models of a body that is upside down or faces back have a frame that is nothing, and nothing fails before a division by
#   the norm. Half a turn is no rare attitude: files turned from y up to z up, feet that face back, one side's axes. Use
#   from_axis_angle, or scipy's Rotation for numbers.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check sympy==1.14.0 ahrs==0.4.0 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
import ahrs
import numpy as np
from scipy.spatial.transform import Rotation
from sympy import Matrix, Quaternion, Rational, pi

AXES = {"x": (1, 0, 0), "oblique": (Rational(2, 7), Rational(3, 7), Rational(6, 7))}


def apart(quaternion, rotation):
    """Angle [deg] between a quaternion, real part first, and a rotation."""
    quaternion = np.asarray(quaternion, dtype=float)
    return np.degrees((Rotation.from_quat(np.roll(quaternion, -1)).inv() * rotation).magnitude())


found = {}
for name, axis in AXES.items():
    for angle in (pi, pi / 3):
        there = Quaternion.from_axis_angle(axis, angle)
        back = Quaternion.from_rotation_matrix(there.to_rotation_matrix())
        found[name, angle] = back.norm()
        print(f"sympy, {angle} about {name}: {there} -> norm {back.norm()}")
half = Rotation.from_rotvec(np.pi * np.array(AXES["oblique"], dtype=float))
off = {}
for seed in range(200):
    axis = np.random.default_rng(seed).normal(size=3)
    turn = Rotation.from_rotvec(np.pi * axis / np.linalg.norm(axis))
    for method in ("chiaverini", "sarabandi", "shepperd"):
        quaternion = ahrs.DCM(turn.as_matrix()).to_quaternion(method=method)
        off[method] = off.get(method, 0) + (not apart(quaternion, turn) < 1.0)
print("AHRS, of 200 half turns about any axis more than a degree off:", off)
vanish = [norm for (_, angle), norm in found.items() if angle == pi]
kept = [norm for (_, angle), norm in found.items() if angle != pi]
if any(vanish) or any(norm != 1 for norm in kept) or min(off["chiaverini"], off["sarabandi"]) < 40 or off["shepperd"]:
    raise SystemExit("CHANGED: half a turn is kept, or others are not")
PY
