#!/usr/bin/env bash
# The mean of no turn, no turn and a turn of 172 degrees is 8 degrees to scipy, not 57.
#
# Expected: Rotation.mean of turns about one axis is the mean of the angles as long as they span less than half a
#   revolution; it is the rotation with the least sum of squared angles to all.
# Happens: it minimises squared distances of matrices instead. For two rotations or small spreads the two agree; for
#   more, those far from the rest hardly count: (0, 0, 172) degrees give 8, (0, 0, 120) give 30 instead of 40.
# Seen with: scipy 1.17.1; the reference names the chordal mean, the angles here follow from it.
# Means: an average heading or trunk attitude over a roll, or over a window in which the body turns fast, leans to where
#   the body lingered, by tens of degrees. A mean of rotation vectors about the estimate, repeated a few times, gives
#   the mean that people have in mind.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
import numpy as np
import scipy
from scipy.spatial.transform import Rotation


def about_z(degrees):
    return Rotation.from_euler("Z", np.reshape(degrees, (-1, 1)), degrees=True)


def mean_angle(degrees):
    return float(np.degrees(about_z(degrees).mean().as_rotvec()[2]))


def geodesic_mean_angle(degrees):
    turns, mean = about_z(degrees), about_z(degrees)[0]
    for _ in range(50):
        mean = mean * Rotation.from_rotvec((mean.inv() * turns).as_rotvec().mean(axis=0))
    return float(np.degrees(mean.as_rotvec()[2]))


print("scipy", scipy.__version__)
seen = {}
for degrees in ((0, 172), (0, 10, 20), (0, 0, 30), (0, 0, 120), (0, 0, 172)):
    seen[degrees] = mean_angle(degrees), geodesic_mean_angle(degrees)
    print(f"turns of {degrees!s:12s} degrees: mean {seen[degrees][0]:6.2f}, by least squared angles {seen[degrees][1]:6.2f}")
chordal, geodesic = seen[0, 0, 172]
if not (7 < chordal < 9 and 57 < geodesic < 58 and abs(seen[0, 0, 120][0] - 30) < 0.01 and abs(seen[0, 172][0] - 86) < 0.01):
    raise SystemExit("CHANGED: Rotation.mean weighs far rotations in another way")
PY
