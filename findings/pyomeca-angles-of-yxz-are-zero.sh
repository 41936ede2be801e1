#!/usr/bin/env bash
# Asked for joint angles in the order yxz, pyomeca answers that the joint is straight.
#
# Expected: "valid values are all permutations of xyz": six orders, each giving back the angles that a rotation was made
#   of; an order that is not there is refused, as one of unknown letters is.
# Happens: five of the six do. yxz makes the rotation, and read back all three angles are 0, in every frame, without a word.
#   So do xyx, xzx, yxy and yzy of the orders that name an axis twice, yxy being the recommended one for the shoulder; zxz
#   and zyz are right.
# Seen with: pyomeca 2026.0.2, Angles.from_rototrans.
# Means: a still joint in a table may be a wrong order. Take the angles by scipy: Rotation.from_matrix(m).as_euler("YXZ").
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pyomeca==2026.0.2 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from pyomeca import Angles, Rototrans
from scipy.spatial.transform import Rotation

MADE = np.array([0.3, 0.5, 0.7])  # rad
print("pyomeca", version("pyomeca"), "- a joint turned by", MADE, "rad")
zero, right = set(), set()
for order in ("xyz", "xzy", "yxz", "yzx", "zxy", "zyx", "xyx", "xzx", "yxy", "yzy", "zxz", "zyz"):
    turned = Rototrans.from_euler_angles(Angles(MADE.reshape(3, 1, 1)), order)
    angles = np.array(Angles.from_rototrans(turned, order)).ravel()
    by_scipy = Rotation.from_matrix(np.array(turned)[:3, :3, 0]).as_euler(order.upper())
    print(f"{order}: {angles.round(3) + 0.0}, by scipy {by_scipy.round(3)}")
    right |= {order} if np.allclose(angles, MADE) and np.allclose(by_scipy, MADE) else set()
    zero |= {order} if not angles.any() and np.allclose(by_scipy, MADE) else set()
if zero != {"yxz", "xyx", "xzx", "yxy", "yzy"} or len(right) != 7:
    raise SystemExit("CHANGED: all orders give angles, or are refused")
PY
