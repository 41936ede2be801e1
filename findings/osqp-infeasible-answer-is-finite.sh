#!/usr/bin/env bash
# OSQP fills the answer of an infeasible problem with 2143289344, which is finite.
#
# Expected: where there is no solution the vector is None or NaN, so that isfinite() tells.
# Happens: x and y hold 2143289344.0 everywhere. That is 0x7fc00000, the bit pattern of a single-precision NaN, taken for
#   a whole number; OSQP_NAN is defined as that integer. numpy.isfinite is true for all of it. By default solve()
#   raises nothing.
# Seen with: osqp 1.1.3.
# Means: a controller that guards its torques by isfinite, or clips them to limits, sends full torque to every joint when
#   its constraints contradict each other. Test info.status_val, not x.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check osqp==1.1.3 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
import numpy as np
import osqp
from scipy import sparse

# Two torques; the first is to be at least 1 and at most 0.
solver = osqp.OSQP()
solver.setup(
    sparse.csc_matrix(np.eye(2)),
    np.zeros(2),
    sparse.csc_matrix(np.array([[1.0, 0.0], [1.0, 0.0]])),
    np.array([1.0, -np.inf]),
    np.array([np.inf, 0.0]),
    verbose=False,
)
answer = solver.solve()
print("osqp", osqp.__version__, "- status:", answer.info.status, answer.info.status_val)
print("x", answer.x, "=", hex(int(answer.x[0])), "finite:", bool(np.isfinite(answer.x).all()))
print("clipped to torques of +-100:", np.clip(answer.x, -100, 100))
if answer.info.status != "primal infeasible" or not (answer.x == 2143289344.0).all():
    raise SystemExit("CHANGED: the answer of an infeasible problem is no longer 2143289344")
PY
