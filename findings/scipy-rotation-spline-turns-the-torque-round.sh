#!/usr/bin/env bash
# At both ends of a clip scipy's RotationSpline has an angular acceleration of the wrong sign, however finely the clip is sampled.
#
# Expected: of "interpolation with continuous angular rate and acceleration", analogous to cubic splines, the second derivative comes
#   near the true one with finer samples; at the ends as with CubicSpline, or at worst to 0, as with a natural spline.
# Happens: at either end the rate is held to the mean rate of the first or the last interval. That is half a sample late, a mistake that
#   finer samples make smaller; the acceleration has to make up for it within one interval, and is 1 - sqrt(3) = -0.73 times the true one
#   at the end and 1.46 times at the next sample, at 10 samples a second and at 1000. It dies down by 3.7 a sample.
# Seen with: scipy 1.17.1. The reference says nothing of the ends. A turn at a steady rate is right, so an example of one shows nothing.
# Means: inverse dynamics of a captured turn begin and end with a joint torque that brakes where the body pushed off. Sampling faster
#   puts nothing right. Interpolate a clip that is five samples longer at either end, and cut those off.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check scipy==1.17.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation, RotationSpline

ACCELERATION = 3.0  # rad/s2 about the y axis, from rest, for one second: 86 degrees
print("scipy", version("scipy"), f"- a body turns from rest at {ACCELERATION} rad/s2; what the splines say of it")
wrong, right = [], []
for rate in (10, 100, 1000):
    t = np.arange(rate + 1) / rate
    angle = 0.5 * ACCELERATION * t**2
    turn = RotationSpline(t, Rotation.from_rotvec(angle[:, None] * [0.0, 1.0, 0.0]))
    at = np.append(t[:3], [0.5, 1.0])
    turning, plain = turn(at, 2)[:, 1], CubicSpline(t, angle)(at, 2)
    print(f"{rate:4d} Hz: rate at the start {turn(0.0, 1)[1]:.4f} of 0 rad/s")
    print("         RotationSpline, first three samples, middle, end:", turning.round(2))
    print("         CubicSpline of the angle, likewise             : ", plain.round(2))
    wrong.append(turning[[0, 4]] / ACCELERATION)
    right.append(np.append(plain, turning[3]) / ACCELERATION)
if not np.allclose(wrong, 1 - np.sqrt(3), atol=1e-3):
    raise SystemExit("CHANGED: the ends are no longer -0.73 of the true acceleration")
if not np.allclose(right, 1.0, atol=0.01):
    raise SystemExit("CHANGED: the middle or the cubic spline of the angle is no longer right")
PY
