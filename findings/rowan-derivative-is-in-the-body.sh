#!/usr/bin/env bash
# rowan integrates an angular velocity in the world, and derives by one in the body, of one name.
#
# Expected: derivative(q, v) and integrate(q, v, dt) stand side by side and take the same q and v, so a small step of one is a
#   small step of the other; both pages put v on the left of q, which is an angular velocity in world axes.
# Happens: integrate does that. derivative multiplies on the right, which is an angular velocity in the body's axes. For a
#   body that lies on its side and spins about the vertical, the derivative is that of a spin about its own long axis.
#   From the identity, as in the page's example, both agree.
# Seen with: rowan 1.3.2; scipy 1.17.1 for comparison.
# Means: an attitude that a solver integrates from derivative() tumbles otherwise than one that integrate() steps, and the norm
#   is 1 in both. Give derivative the velocity turned into the body's axes, rotate(conjugate(q), v).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check rowan==1.3.2 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
import rowan
from scipy.spatial.transform import Rotation

DT = 1e-6  # s
spin = np.array([0.0, 0.0, 2.0])  # rad/s
lying = Rotation.from_euler("x", 90, degrees=True)
q = lying.as_quat(scalar_first=True)


def rate(after):
    """The angular velocity [rad/s] in world axes that leads from `q` there in DT."""
    turn = Rotation.from_quat(after, scalar_first=True) * lying.inv()
    return turn.as_rotvec() / DT


print("rowan", version("rowan"), "- a body on its side, told to spin at", spin, "rad/s")
stepped = rate(rowan.calculus.integrate(q, spin, DT))
derived = rate(rowan.normalize(q + DT * rowan.calculus.derivative(q, spin)))
turned = rowan.rotate(rowan.conjugate(q), spin)
told = rate(rowan.normalize(q + DT * rowan.calculus.derivative(q, turned)))
print("integrate                              :", stepped.round(3) + 0.0, "in world axes")
print("derivative                             :", derived.round(3) + 0.0)
print("derivative, told it in the body's axes :", told.round(3) + 0.0)
alike = rowan.calculus.derivative([1, 0, 0, 0], spin), (rowan.calculus.integrate([1, 0, 0, 0], spin, DT) - [1, 0, 0, 0]) / DT
print("from the identity they differ by       :", float(np.abs(alike[0] - alike[1]).max().round(3)))
seen = np.allclose(stepped, spin, atol=1e-3) and np.allclose(derived, lying.apply(spin), atol=1e-3) and np.allclose(told, spin, atol=1e-3)
if not seen:
    raise SystemExit("CHANGED: derivative and integrate take the angular velocity in the same axes, or in other ones")
PY
