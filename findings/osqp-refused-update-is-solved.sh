#!/usr/bin/env bash
# OSQP refuses an update, keeps the old problem, solves that and says "solved".
#
# Expected: update() with data that setup() would refuse raises, as setup() does, or the status tells.
# Happens: a line on the console from the C code; update() returns None, as it always does, and solve() returns the last
#   problem's answer as "solved", also with raise_error=True. So it goes for a lower bound above its upper bound, for
#   Px from a full symmetric matrix where setup() had taken the same, and for Px or Ax with fewer numbers than at
#   setup(), which is what csc_matrix makes of a matrix in which an entry has become 0. A new q or bound in the same
#   call with a refused bound is dropped as well.
# Seen with: osqp 1.1.3.
# Means: one bad step of a controller that updates its QP goes unseen: the torques stay those of the step before, within
#   the old limits, not the new ones. Build P and A with a fixed pattern (zeros kept, upper triangle of P), check
#   l <= u before the call, and test the answer against the bounds.
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

WANTED, LOW, HIGH = np.array([3.0, 3.0]), np.full(2, -1.0), np.full(2, 1.0)
FULL, LATER = np.array([[2.0, 0.5], [0.5, 1.0]]), np.array([[1.0, 0.0], [0.0, 3.0]])


def answers(matrix, low, high, **change):
    """Before and after the change, and the status."""
    solver = osqp.OSQP()
    solver.setup(matrix, -WANTED, sparse.eye(2, format="csc"), low, high, verbose=False, eps_abs=1e-8, eps_rel=1e-8)
    before = solver.solve(raise_error=True).x.copy()
    returned = solver.update(**change)
    after = solver.solve(raise_error=True)
    return before, after.x.copy(), f"update() returned {returned}, {after.info.status}"


print("osqp", osqp.__version__)
identity, far = sparse.eye(2, format="csc"), np.full(2, 99.0)
kept = {}
for name, right, case in (
    ("allowed: u = 0.2", [0.2, 0.2], (identity, LOW, HIGH, {"u": np.full(2, 0.2)})),
    ("l = 0.5, u = 0.2", None, (identity, LOW, HIGH, {"l": np.full(2, 0.5), "u": np.full(2, 0.2)})),
    ("q = 0 and such bounds", None, (identity, LOW, HIGH, {"q": np.zeros(2), "l": np.full(2, 0.5), "u": np.full(2, 0.2)})),
    ("Px of a full matrix", np.linalg.solve(FULL * 2, WANTED), (sparse.csc_matrix(FULL), -far, far, {"Px": sparse.csc_matrix(FULL * 2).data})),
    ("Px with an entry now 0", np.linalg.solve(LATER, WANTED), (sparse.csc_matrix(FULL), -far, far, {"Px": sparse.csc_matrix(LATER).data})),
):
    matrix, low, high, change = case
    before, after, said = answers(matrix, low, high, **change)
    kept[name] = bool(np.allclose(before, after, atol=1e-5)) and "solved" in said
    print(f"{name:22s}: {before.round(3)} -> {after.round(3)} ({said}); right: {'none' if right is None else np.round(right, 3)}")
if list(kept.values()) != [False, True, True, True, True]:
    raise SystemExit("CHANGED: a refused update is told, or an allowed one is not taken")
PY
