#!/usr/bin/env bash
# CasADi uses "only the lower triangular part" of a QP's Hessian: of seven of its solvers two do, and all seven report success.
#
# Expected: of the input h of conic the documentation says that only its lower triangular part is actually used. So the values above the
#   diagonal do not matter, and a Hessian of which the lower half was filled in, as Cholesky factors and many an accumulation are, will do.
# Happens: with daqp and highs it does. osqp and proxqp read the upper half and solve the QP without the coupling; qrqp, qpoases and ipqp take both
#   entries as they are, and find points that are optimal for neither half nor for their mean. With a pattern that
#   is triangular there is an error; with a full one, whose upper values are 0, none, and success is True throughout.
# Seen with: casadi 3.8.2, ca.conic with the solvers that its wheel brings.
# Means: a whole-body controller moves to another solver by one word, and its momentum terms no longer know of each other. A product
#   J'WJ is symmetric and shows nothing. Fill in both halves: ca.tril2symm(ca.tril(h)).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check casadi==3.8.2 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import os
import sys

import casadi as ca
import numpy as np

QUIET = {"print_iter": False, "print_header": False, "print_info": False}
SOLVERS = {
    "daqp": {},
    "highs": {"highs": {"output_flag": False}},
    "osqp": {"osqp": {"verbose": False}},
    "proxqp": {},
    "qrqp": QUIET,
    "ipqp": QUIET,
    "qpoases": {"printLevel": "none"},
}
H, g = np.array([[2.0, 1.0], [1.0, 2.0]]), np.array([-2.0, -5.0])
BOUNDS = {"lba": -np.inf, "uba": 20.0, "lbx": -9.0, "ubx": 9.0}


def solved(name, hessian):
    a = ca.DM([[1.0, 1.0]])
    qp = {"h": ca.DM(hessian).sparsity(), "a": a.sparsity()}
    solver = ca.conic("solver", name, qp, {"error_on_fail": False, **SOLVERS[name]})
    found = solver(h=ca.DM(hessian), g=g, a=a, **BOUNDS)
    return np.array(found["x"]).ravel(), bool(solver.stats()["success"])


sys.stdout.flush()
shown, silent = os.dup(1), os.open(os.devnull, os.O_WRONLY)
os.dup2(silent, 1)  # banners of qpOASES
lower = {name: solved(name, np.tril(H)) for name in SOLVERS}
whole = {name: solved(name, H) for name in SOLVERS}
os.dup2(shown, 1)

right = np.linalg.solve(H, -g)
print("casadi", ca.__version__)
print("says: only the lower triangular part is used:", "lower triangular part is actually used" in " ".join(ca.conic.__doc__.replace("|", " ").split()))
print("the QP's solution", np.round(right, 3))
for name, (x, success) in lower.items():
    print(f"{name:8s} {np.round(x, 3)} success {success}; with both halves {np.round(whole[name][0], 3)}")
near = {name: bool(np.allclose(x, right, atol=1e-2)) for name, (x, _) in lower.items()}
if not all(success for _, success in (*lower.values(), *whole.values())):
    raise SystemExit("CHANGED: not all succeed")
if [name for name in near if near[name]] != ["daqp", "highs"] or not all(np.allclose(x, right, atol=1e-2) for x, _ in whole.values()):
    raise SystemExit("CHANGED: others use the lower triangular part, or none")
PY
