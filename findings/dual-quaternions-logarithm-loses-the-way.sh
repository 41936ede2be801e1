#!/usr/bin/env bash
# Move a body by (1, 2, 3) m without a turn: the logarithm that dual_quaternions takes of it is zero, and its exponential is no motion at all.
#
# Expected: log takes a unit dual quaternion to a twist, and exp takes it back; the package says of log that it is screw axis times half the screw angle, both as dual numbers,
#   which for a mere translation is half of it. exp(log(pose)) is the pose.
# Happens: the turn comes back and the translation does not. For a pose with rotation R and translation t the dual half of log is a quarter of t - R't, R' being R backwards, so
#   that without a turn nothing is left, and what goes along the axis of the turn is always lost: a screw of 46 degrees and 3 m along its axis comes back with 0 m.
#   Of (1, 2, 3) with 46 degrees about x there is (0, -0.77, 1.17). All is a unit dual quaternion still, and nothing is said.
# Seen with: dual_quaternions 0.4.0, pyquaternion 0.9.9, numpy 2.4.6. Its screw(), pow() and sclerp() do not go by way of log and are right: two halves by pow(0.5) make the whole.
# Means: means and errors of poses, splines and a filter's update are taken in logarithms. They see nothing of a foot that goes straight ahead: as an error it is zero
#   there. Make the twist of screw(): l theta / 2 and (m theta + l d) / 2; without a turn, m is infinite there and the dual half is l d / 2.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check dual-quaternions==0.4.0 pyquaternion==0.9.9 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from dual_quaternions import DualQuaternion
from pyquaternion import Quaternion

print("dual_quaternions", version("dual-quaternions"), "pyquaternion", version("pyquaternion"))
motions = {
    "no turn": (Quaternion(), np.array([1.0, 2.0, 3.0])),
    "46 degrees about x": (Quaternion(axis=[1, 0, 0], radians=0.8), np.array([1.0, 2.0, 3.0])),
    "46 degrees about x, along x": (Quaternion(axis=[1, 0, 0], radians=0.8), np.array([3.0, 0.0, 0.0])),
    "86 degrees about an oblique axis": (Quaternion(axis=[1, -2, 2], radians=1.5), np.array([-0.5, 0.2, 1.0])),
}
for name, (turn, way) in motions.items():
    pose = DualQuaternion.from_quat_pose_array([*turn.elements, *way])
    logarithm = pose.log()
    back = logarithm.exp()
    halves = pose.pow(0.5) * pose.pow(0.5)
    dual, again = logarithm.q_d.vector, np.array(back.translation(), dtype=float)
    print(f"{name}: there {way}, dual half of the logarithm {np.round(dual, 3)}, back {np.round(again, 3)}, two halves by pow {np.round(np.array(halves.translation(), float), 3)}")
    if abs((back.q_r * turn.inverse).w) < 1 - 1e-9 or np.abs(logarithm.q_r.vector - turn.axis * turn.radians / 2).max() > 1e-9:
        raise SystemExit("CHANGED: the turn does not come back")
    if np.abs(np.array(pose.translation(), float) - way).max() > 1e-9 or np.abs(np.array(halves.translation(), float) - way).max() > 1e-9:
        raise SystemExit("CHANGED: the pose itself, or its half, is another")
    if not back.is_normalized:
        raise SystemExit("CHANGED: what comes back is no unit dual quaternion")
    left = way - turn.inverse.rotate(way)
    if np.abs(again - way).max() < 0.1:
        raise SystemExit("CHANGED: the translation comes back")
    if np.abs(dual - left / 4).max() > 1e-9 or np.abs(again - left / 2).max() > 1e-9:
        raise SystemExit("CHANGED: another translation is left")
PY
