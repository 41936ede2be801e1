#!/usr/bin/env bash
# A body that turns 10 degrees a frame begins with 15 in the Catmull-Rom spline of package splines, and ends with 15.
#
# Expected: a spline through the attitudes of a steady turn about one axis is that steady turn, as it is for positions in the same
#   package: through 0, 10, 20, ... its CatmullRom and its natural spline go on by 10 throughout.
# Happens: splines.quaternion.CatmullRom and KochanekBartels, with the "natural" ends that are the default, start at 1.5 times the rate,
#   fall below it within the first frame and come back to it at the second. In the middle the turn is steady. The first
#   control point is put halfway to the second attitude, where for positions it is halfway to the control point before that.
# Seen with: splines 0.3.3; PiecewiseSlerp of the same package keeps the rate.
# Means: each clip that is resampled or sped up by it starts with a jerk that no one made, and pieces that are put together have one at
#   every seam. All given attitudes are met, so a test of these is passed. Give it an attitude more at either end, and leave the end
#   intervals out.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check splines==0.3.3 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
import splines
from splines.quaternion import CatmullRom, KochanekBartels, PiecewiseSlerp, UnitQuaternion

STEP, SHORT = 10.0, 1e-4  # degrees a frame; the part of a frame over which a rate is taken
frames = np.arange(6)
attitudes = [UnitQuaternion.from_axis_angle((0, 0, 1), np.radians(STEP * k)) for k in frames]


def heading(attitude):  # the turn about z, in degrees
    return np.degrees(2 * np.arctan2(attitude.vector[2], attitude.scalar))


def rates(spline, at):  # degrees a frame, from the attitudes themselves
    return np.array([heading(spline.evaluate(t + SHORT)) - heading(spline.evaluate(t)) for t in at]) / SHORT


at = np.array([0.0, 0.25, 0.5, 1.0, 2.5, 4.0, 5.0 - SHORT])
print("splines", version("splines"), f"- degrees a frame of a steady turn of {STEP:.0f}, at the frames", at.round(2))
seen = {kind.__name__: rates(kind(attitudes), at) for kind in (CatmullRom, KochanekBartels, PiecewiseSlerp)}
seen["positions"] = np.array([splines.CatmullRom(STEP * frames).evaluate(t, 1) for t in at])
for name, rate in seen.items():
    print(f"{name:16s} {rate.round(2)}")
if not all(np.allclose(seen[name], STEP, atol=0.01) for name in ("PiecewiseSlerp", "positions")):
    raise SystemExit("CHANGED: what was steady no longer is")
for name in ("CatmullRom", "KochanekBartels"):
    if not np.allclose(seen[name][[0, 6]], 1.5 * STEP, atol=0.05) or not np.allclose(seen[name][[3, 4, 5]], STEP, atol=0.01):
        raise SystemExit("CHANGED: the ends no longer turn 1.5 times as fast")
PY
