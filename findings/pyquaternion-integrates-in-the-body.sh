#!/usr/bin/env bash
# pyquaternion's integrate() says that rates are about the global axes, and turns about those of the body.
#
# Expected: integrate(rate, timestep), "rates about the global x, y and z axes", with a rate about the vertical leaves a
#   lying body lying and changes its heading.
# Happens: the rate is applied in the body's own axes. A body that lies and gets 90 deg/s about the world's vertical for one
#   second keeps its heading and rolls a quarter turn about its long axis: 120 degrees from the right attitude. From an
#   upright start, or for a turn about one and the same axis throughout, both readings agree.
# Seen with: pyquaternion 0.9.9; derivative() goes the same way, and says local.
# Means: gyroscope readings, which are in the body's axes, come out right although the text says otherwise; world
#   angular velocities, as most simulators log them, do not. Turn them into the body's axes first (q.inverse.rotate).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pyquaternion==0.9.9 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math
from importlib.metadata import version

import numpy as np
from pyquaternion import Quaternion

VERTICAL = np.array([0.0, 0.0, math.pi / 2])  # rad/s, for one second
STARTS = {"upright": Quaternion(), "turned about z": Quaternion(axis=[0, 0, 1], degrees=70), "lying": Quaternion(axis=[1, 0, 0], degrees=90)}


def apart(first, second):
    return math.degrees(2 * math.acos(min(1.0, abs(float(np.dot(first.elements, second.elements))))))


def head(attitude):
    return attitude.rotate(np.array([0.0, 0.0, 1.0])).round(3) + 0.0


print("pyquaternion", version("pyquaternion"), "- a quarter turn about the world's vertical")
off, cured = {}, {}
for name, start in STARTS.items():
    right = Quaternion(axis=[0, 0, 1], degrees=90) * start
    given, turned = Quaternion(start), Quaternion(start)
    given.integrate(VERTICAL, 1.0)
    turned.integrate(start.inverse.rotate(VERTICAL), 1.0)
    off[name], cured[name] = apart(given, right), apart(turned, right)
    print(
        f"{name:15s}: {off[name]:6.2f} degrees off, {cured[name]:.2f} with the rate in the body's axes; "
        f"head points to {head(given)}, should to {head(right)}"
    )
if max(cured.values()) > 1e-4 or max(off["upright"], off["turned about z"]) > 1e-4 or abs(off["lying"] - 120) > 0.01:
    raise SystemExit("CHANGED: rates are about the global axes")
PY
