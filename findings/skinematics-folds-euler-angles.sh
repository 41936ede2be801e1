#!/usr/bin/env bash
# Of half of all attitudes scikit-kinematics says that their Euler angles are 0, 0 and something.
#
# Expected: rotmat.sequence takes a rotation matrix apart into three angles that build it again; to="Euler" is Rz Rx Rz, to="Helmholtz" Ry
#   Rz Rx. At the singular attitudes one angle is free; the docstring asks for angles below pi.
# Happens: angles come from arcsin alone, so that one beyond 90 degrees is folded back: 150 is 30. And a middle angle below zero counts as
#   too small: of (20, -30, 10) come (0, 0, 29). Of random attitudes a seventh is built again by its "Euler" angles
#   and a quarter by its "Helmholtz" ones, the others are off by 114 and 107 degrees in the median; "Fick" (Rz Ry Rx) is right
#   with all. No number is NaN and no warning comes. A list of matrices with middle angles of both signs raises a ValueError.
# Seen with: scikit-kinematics 0.10.4, the last one for Python 3.11; 0.12.0 has the same lines.
# Means: hips of a squat and shoulders overhead are beyond 90 degrees, and curves of them have a kink there that looks like a stop of
#   the joint. Take "Fick", or scipy's as_euler, and build the matrix again from what comes.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check scikit-kinematics==0.10.4 scipy==1.17.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from scipy.spatial.transform import Rotation
from skinematics import rotmat

# The order in which each gives its angles, as indices into those of the sequence of moving axes.
SEQUENCES = {"Fick": ("ZYX", [0, 1, 2]), "Helmholtz": ("YZX", [1, 0, 2]), "Euler": ("ZXZ", [0, 1, 2])}


def angles(turn, to):
    axes, order = SEQUENCES[to]
    return np.asarray(rotmat.sequence(turn.as_matrix(), to=to))[order]


print("scikit-kinematics", version("scikit-kinematics"))
seen = {}
turns = Rotation.random(1000, random_state=1)
for to, (axes, _) in SEQUENCES.items():
    found = np.array([angles(turn, to) for turn in turns])
    off = np.degrees((turns.inv() * Rotation.from_euler(axes, found)).magnitude())
    right, rest = (off < 0.01).mean(), off[off >= 0.01]
    wrong = f", the rest off by {np.median(rest):.0f} degrees in the median" if len(rest) else ""
    print(f"{to:10s} builds {100 * right:.0f} % of random attitudes again{wrong}")
    seen[to] = right
for given in ([20, 30, 10], [20, 30, 150], [20, -30, 10]):
    got = np.degrees(angles(Rotation.from_euler("ZXZ", given, degrees=True), "Euler"))
    print(f"Euler {given} comes as {np.round(got).tolist()}")
zero = np.degrees(angles(Rotation.from_euler("ZXZ", [20, -30, 10], degrees=True), "Euler"))
if seen["Fick"] < 1 or max(seen["Helmholtz"], seen["Euler"]) > 0.4 or np.abs(zero[:2]).max() > 0:
    raise SystemExit("CHANGED: angles beyond 90 degrees come back")
PY
