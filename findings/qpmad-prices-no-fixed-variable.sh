#!/usr/bin/env bash
# qpsolvers with qpmad: a variable that is fixed has no multiplier, and those of the equalities are bent to make up for it.
#
# Expected: a QP that is strictly convex and feasible has one solution and, with independent constraints, one set of multipliers. Solvers
#   behind one interface return it, whether a variable is fixed by equal bounds or by a row of A.
# Happens: the solution is right and marked as found; of a variable with lb = ub z_box is 0. qpmad takes equal bounds for an
#   equality and tells the multipliers of inequalities alone; the interface then fits y to what is left by least squares, so
#   that it is wrong, too. The multiplier of the same variable, fixed by a row of A, is right.
# Seen with: qpsolvers 4.13.0, pyqpmad 1.4.1; daqp 0.8.7 for comparison.
# Means: where multipliers are forces (a joint that is held, a foot that must not move) the held one bears nothing and the others bear
#   its share. Write fixed variables as rows of A, or look at the duality gap, which is not 0.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check qpsolvers==4.13.0 pyqpmad==1.4.1 daqp==0.8.7 \
    numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from qpsolvers import Problem, solve_problem

# Two carts of 1 and 3 kg on a spring's pull of 6 and -2 N; a rod keeps their accelerations alike but for 1 m/s2, the second is held.
MASS, PULL, ROD = np.diag([1.0, 3.0]), np.array([-6.0, 2.0]), np.array([[1.0, -1.0]])
HELD = 0.5  # m/s2
open_end = np.array([-np.inf, HELD]), np.array([np.inf, HELD])
bounds = Problem(MASS, PULL, A=ROD, b=np.array([1.0]), lb=open_end[0], ub=open_end[1])
rows = Problem(MASS, PULL, A=np.vstack([ROD, [[0.0, 1.0]]]), b=np.array([1.0, HELD]), lb=np.full(2, -1e3), ub=np.full(2, 1e3))
print("qpsolvers", version("qpsolvers"), "pyqpmad", version("pyqpmad"), "daqp", version("daqp"))
found = {}
for solver in ("daqp", "pyqpmad"):
    answer = solve_problem(bounds, solver=solver)
    off = MASS @ answer.x + PULL + ROD.T @ answer.y + answer.z_box
    found[solver] = answer.y[0], answer.z_box[1], float(np.abs(off).max())
    print(f"held by bounds, {solver:7s}: x {answer.x.round(3)}, rod {answer.y[0]:6.3f}, hold {answer.z_box[1]:6.3f}, "
          f"not balanced {found[solver][2]:.3f}, gap {answer.duality_gap():.3f}, found {answer.found}")
by_row = solve_problem(rows, solver="pyqpmad")
print(f"held by a row, pyqpmad  : x {by_row.x.round(3)}, rod {by_row.y[0]:6.3f}, hold {by_row.y[1]:6.3f}")
truth = np.linalg.solve(np.array([[1.0, 0.0], [-1.0, 1.0]]), -(MASS @ [1.5, 0.5] + PULL))  # both multipliers, by hand
seen = np.allclose(found["daqp"][:2], truth, atol=1e-6) and np.allclose(by_row.y, truth, atol=1e-6)
if not seen or found["pyqpmad"][1] != 0.0 or found["pyqpmad"][2] < 0.1:
    raise SystemExit("CHANGED: a fixed variable has its multiplier, or the others differ")
PY
