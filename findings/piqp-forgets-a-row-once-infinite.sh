#!/usr/bin/env bash
# PIQP never again enforces a row that was unbounded when the solver was set up.
#
# Expected: infinity switches a row off, and update() with a finite bound switches it on, as in OSQP.
# Happens: a row that is infinite on both sides at setup() has its coefficients set to zero. update(h_u=...) accepts the
#   finite bound, the row is 0 <= h from then on, and the answer is "solved" with the constraint broken at will. Passing
#   the matrix again along with the bound cures it. A note on the zeros is printed at setup, none at the update.
# Seen with: piqp 0.7.0, the dense and the sparse solver.
# Means: a whole-body QP set up once for all contacts, with the rows of those in the air switched off by infinity, has no
#   friction limits on a foot that lands. Pass G with each update, or give rows that may come alive a bound of
#   moderate size (with 1e10 or more it no longer converges).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check piqp==0.7.0 osqp==1.1.3 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
import osqp
import piqp
from scipy import sparse

# Nearest to (3, 3) within a box of +-10; then also x + y <= 1, whose answer is (0.5, 0.5).
H, C, ROW, BOX = np.eye(2), np.array([-3.0, -3.0]), np.array([[1.0, 1.0]]), np.full(2, 10.0)
INFINITE, ONE = np.array([np.inf]), np.array([1.0])


def by_piqp(solver, matrix, first, **more):
    solver.setup(matrix(H), C, None, None, matrix(ROW), None, first, -BOX, BOX)
    solver.solve()
    solver.update(h_u=ONE, **more)
    status = solver.solve()
    return str(status).split("_")[-1].lower(), solver.result.x.copy()


def by_osqp():
    solver = osqp.OSQP()
    rows = sparse.csc_matrix(np.vstack([ROW, np.eye(2)]))
    lower, box = np.r_[-np.inf, -BOX], np.r_[np.inf, BOX]
    solver.setup(sparse.csc_matrix(H), C, rows, lower, box, verbose=False, eps_abs=1e-8, eps_rel=1e-8)
    solver.solve()
    solver.update(u=np.r_[1.0, BOX])
    answer = solver.solve()
    return answer.info.status, answer.x


print("piqp", version("piqp"), "osqp", version("osqp"), "- x + y <= 1 after the update")
answers = {
    "PIQP, dense, infinite at setup": by_piqp(piqp.DenseSolver(), np.array, INFINITE),
    "PIQP, sparse, infinite at setup": by_piqp(piqp.SparseSolver(), sparse.csc_matrix, INFINITE),
    "PIQP, 10 at setup": by_piqp(piqp.DenseSolver(), np.array, np.array([10.0])),
    "PIQP, infinite, G passed again": by_piqp(piqp.DenseSolver(), np.array, INFINITE, G=ROW),
    "OSQP, infinite at setup": by_osqp(),
}
for name, (status, x) in answers.items():
    print(f"{name:32s} {status}: x + y = {x.sum():.4f}")
sums = [float(x.sum()) for _, x in answers.values()]
if not np.allclose(sums, [6, 6, 1, 1, 1], atol=1e-3) or any(status != "solved" for status, _ in answers.values()):
    raise SystemExit("CHANGED: a row that was infinite is enforced once it is bounded")
PY
