#!/usr/bin/env bash
# With one row of G x <= h left open by h = inf, qpsolvers calls no solver's answer optimal, and finds x as before.
#
# Expected: a row without a bound is no constraint, and infinity says so: for lb and ub qpsolvers takes it so, and the solvers do, too. The
#   answer, its multipliers and is_optimal are those without the row.
# Happens: x and the multipliers are, with a 0 for the open row, and found is true. duality_gap() multiplies that 0 by infinity: NaN, so that
#   is_optimal(eps) is false for any eps. Of bounds that are boxes infinite ones are left out of the sum, of rows they are not.
#   PIQP's multiplier is 1e-18, and its gap infinite.
# Seen with: qpsolvers 4.13.0 with clarabel 0.11.1, daqp 0.11.0, quadprog 0.1.14 and piqp 0.7.0; its issue 135 was the same of boxes.
# Means: limits of joints, forces that only push and cones that open come as rows with one side open. A comparison of solvers counts each of these as
#   failed, and a controller that falls back when is_optimal is false always falls back. Leave such rows out.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check qpsolvers==4.13.0 clarabel==0.11.1 daqp==0.11.0 quadprog==0.1.14 piqp==0.7.0 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from qpsolvers import Problem, solve_problem

P, q = np.array([[2.0, 1.0], [1.0, 3.0]]), np.array([-1.0, -2.0])
ROW, OPEN = np.array([[1.0, 1.0]]), np.array([[1.0, 1.0], [1.0, 0.0]])
PROBLEMS = {
    "one row": Problem(P, q, ROW, np.array([0.3])),
    "and an open box": Problem(P, q, ROW, np.array([0.3]), lb=np.full(2, -np.inf), ub=np.full(2, np.inf)),
    "and an open row": Problem(P, q, OPEN, np.array([0.3, np.inf])),
}
OPTIMUM = np.linalg.solve(np.block([[P, ROW.T], [ROW, np.zeros((1, 1))]]), np.append(-q, 0.3))  # x and the multiplier, the row being active
print("qpsolvers", version("qpsolvers"), "- the optimum is", OPTIMUM[:2].round(4), "with a multiplier of", OPTIMUM[2].round(4))
for solver in ("clarabel", "daqp", "quadprog", "piqp"):
    for name, problem in PROBLEMS.items():
        answer = solve_problem(problem, solver=solver)
        right = bool(answer.found and np.abs(np.append(answer.x, answer.z[0]) - OPTIMUM).max() < 1e-6)
        gap, optimal = answer.duality_gap(), answer.is_optimal(1e-3)
        print(f"{solver:9s} {name:16s} right: {right}, duality gap {gap:8.1e}, optimal: {optimal}")
        if not right or optimal != (name != "and an open row") or np.isfinite(gap) != optimal:
            raise SystemExit("CHANGED: an open row no longer makes the difference")
PY
