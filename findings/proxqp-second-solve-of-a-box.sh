#!/usr/bin/env bash
# Ask ProxQP twice for the same answer and the second leaves the box.
#
# Expected: solve() on an object that has just been solved, nothing changed, returns the same answer, at once.
# Happens: with bounds given as box constraints the first answer is right; the second runs into the iteration limit and lies
#   outside the bounds by a quarter. The same bounds given as rows are solved as often as one likes, and so is the box
#   with initial_guess = WARM_START_WITH_PREVIOUS_RESULT.
# Seen with: proxsuite 0.8.0, proxqp.dense.QP(..., box_constraints=True), other settings at their defaults.
# Means: a control loop that keeps its solver object, as the library invites to, has torques beyond their limits from the
#   second step on unless it reads the status. Make a new object each step, or choose the warm start.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check proxsuite==0.8.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from proxsuite import proxqp

HESSIAN, GRADIENT, BOUND = np.array([[2.0, 0.5], [0.5, 1.0]]), np.array([3.0, 3.0]), np.ones(2)


def with_box(guess=None):
    qp = proxqp.dense.QP(2, 0, 0, True)
    if guess is not None:
        qp.settings.initial_guess = guess
    qp.init(HESSIAN, GRADIENT, None, None, None, None, None, -BOUND, BOUND)
    return qp


def with_rows():
    qp = proxqp.dense.QP(2, 0, 2, False)
    qp.init(HESSIAN, GRADIENT, None, None, np.eye(2), -BOUND, BOUND)
    return qp


print("proxsuite", version("proxsuite"), "- two unknowns within +-1, the optimum is (-1, -1)")
right = {}
warm = proxqp.InitialGuess.WARM_START_WITH_PREVIOUS_RESULT
for name, qp in (("box", with_box()), ("box, warm start", with_box(warm)), ("rows", with_rows())):
    right[name] = []
    for attempt in ("first", "second"):
        qp.solve()
        right[name].append(bool(np.allclose(qp.results.x, -1, atol=1e-3)))
        print(f"{name:15s} {attempt:6s}: {qp.results.x.round(4)} {str(qp.results.info.status).split('.')[-1]}")
if right != {"box": [True, False], "box, warm start": [True, True], "rows": [True, True]}:
    raise SystemExit("CHANGED: a second solve of a box returns the first answer, or another case fails")
PY
