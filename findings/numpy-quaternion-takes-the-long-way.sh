#!/usr/bin/env bash
# A turn of 10 degrees is a rotation vector of 350 degrees, the other way, to numpy-quaternion.
#
# Expected: q and -q are one attitude, so their rotation vectors agree and none is longer than half a turn; so it is in
#   scipy and MuJoCo.
# Happens: as_rotation_vector() doubles the quaternion's logarithm as it is. Where the first component is negative the
#   vector is up to a full turn long and points the other way. quaternionic, the successor, does the same.
# Seen with: numpy-quaternion 2024.0.13, quaternionic 1.0.18; scipy 1.17.1, mujoco 4.0.0 for comparison.
# Means: a controller that takes its attitude error from it pushes 35 times as hard in the wrong direction as soon as one of
#   the two attitudes was stored with the other sign: files that keep the first component positive change the sign once
#   in each revolution of a roll. Make that of the product positive before.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check numpy-quaternion==2024.0.13 quaternionic==1.0.18 \
    numpy==2.4.6 scipy==1.17.1 mujoco==4.0.0
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import mujoco
import numpy as np
import quaternion
import quaternionic
from scipy.spatial.transform import Rotation


def by_mujoco(q):
    vector = np.zeros(3)
    mujoco.mju_quat2Vel(vector, q, 1.0)
    return vector


READERS = {
    "numpy-quaternion": lambda q: quaternion.as_rotation_vector(quaternion.from_float_array(q)),
    "quaternionic": lambda q: quaternionic.array(q).to_rotation_vector,
    "scipy": lambda q: Rotation.from_quat(q, scalar_first=True).as_rotvec(),
    "mujoco": by_mujoco,
}
half = np.radians(10) / 2
turn = np.array([np.cos(half), 0, 0, np.sin(half)])
seen = {}
for name, read in READERS.items():
    seen[name] = tuple(round(float(np.degrees(read(q))[2]), 3) for q in (turn, -turn))
    print(f"{name:16s} {version(name):10s}: q gives {seen[name][0]:8.3f}, -q gives {seen[name][1]:8.3f} degrees about z")
if any(seen[name] != (10.0, 10.0) for name in ("scipy", "mujoco")):
    raise SystemExit("CHANGED: the libraries compared with disagree on q and -q")
if any(seen[name] != (10.0, -350.0) for name in ("numpy-quaternion", "quaternionic")):
    raise SystemExit("CHANGED: q and -q have one rotation vector")
PY
