#!/usr/bin/env bash
# A table that CasADi interpolates by splines is 0 beyond its last point, by one rounding already.
#
# Expected: outside of its grid an interpolant goes on as its last piece does, as plugin `linear` of the same function does, or is clamped,
#   or is NaN, so that it is seen.
# Happens: with plugin `bspline` the value is 0, on either side, in every dimension and with a derivative of 0. At the last point it is right,
#   and at the next floating-point number 0: a table of 100 N m over 0 to 0.3 s has 0 N m at 0.1 + 0.2 s.
# Seen with: casadi 3.8.2, ca.interpolant.
# Means: a muscle longer than its curve has no force, a foot beyond the height field stands on nothing, and a reference read at the sum of
#   the time steps ends on 0: a jump in the cost of the last node, without a gradient that leads back. A table that ends near 0 hides it. Widen the
#   grid by a point at each end, or bring the argument inside by fmin and fmax.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check casadi==3.8.2 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import casadi as ca
import numpy as np

time, torque = np.array([0.0, 0.1, 0.2, 0.3]), np.array([100.0, 100.0, 100.0, 100.0])
at = {"0.3": 0.3, "0.1 + 0.2": 0.1 + 0.2, "0.4": 0.4, "-1e-9": -1e-9}
print("casadi", ca.__version__)
seen = {}
for kind in ("linear", "bspline"):
    table = ca.interpolant("table", kind, [time], torque)
    seen[kind] = {name: round(float(table(value)), 6) for name, value in at.items()}
    print(f"{kind:8s}", ", ".join(f"{value:g} N m at {name} s" for name, value in seen[kind].items()))
t = ca.MX.sym("t")
slope = ca.Function("slope", [t], [ca.jacobian(ca.interpolant("ramp", "bspline", [time], time)(t), t)])
print("slope of t itself, inside and outside:", round(float(slope(0.15)), 6), float(slope(0.31)))
wrong = seen["bspline"] == {"0.3": 100.0, "0.1 + 0.2": 0.0, "0.4": 0.0, "-1e-9": 0.0}
if not wrong or set(seen["linear"].values()) != {100.0} or float(slope(0.31)) != 0.0:
    raise SystemExit("CHANGED: it goes on beyond its last point")
PY
