#!/usr/bin/env bash
# pytransform3d's slerp of axis and angle takes two attitudes that are 10 degrees apart through 358 degrees.
#
# Expected: axis_angle_slerp, matrix_slerp, quaternion_slerp and rotor_slerp, which point to each other, are one motion in four ways to
#   write it: the one turn about a fixed axis that leads from start to end. From no turn to 120 degrees about y, half of it is 60 about y.
# Happens: axis and angle are interpolated each by itself, the axis along the sphere. The identity has no axis and is written with
#   (1, 0, 0), by the library itself too; from there half of 120 degrees about y is 60 about (1, 1, 0). 90 degrees about x and about y are
#   19 off in the middle. 175 degrees one way and 175 the other about nearly opposite axes, 10 degrees apart, take 358 to meet; about
#   opposite axes the axis comes out shorter than 1, and as 0 in the middle.
# Seen with: pytransform3d 3.17.0, rotations.axis_angle_slerp, beside its own quaternion_slerp.
# Means: a limb that leaves its rest pose swings out of the plane of its motion, and one near half a turn is thrown once round. Ends look
#   right, and but for opposite axes the norms do. quaternion_slerp with shortest_path=True, of quaternion_from_axis_angle.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pytransform3d==3.17.0 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
import pytransform3d.rotations as pr


def written(x, y, z, degrees):
    axis = np.array([x, y, z]) / np.linalg.norm([x, y, z])
    return np.append(axis, np.radians(degrees))


def apart(a, b):
    """Of two turns [deg]."""
    return np.degrees(pr.quaternion_dist(*map(pr.quaternion_from_axis_angle, (a, b))))


def by_quaternions(a, b, t):
    ends = map(pr.quaternion_from_axis_angle, (a, b))
    return pr.axis_angle_from_quaternion(pr.quaternion_slerp(*ends, t, shortest_path=True))


def travelled(slerp, a, b):
    stops = [slerp(a, b, t) for t in np.linspace(0.0, 1.0, 21)]
    return sum(apart(*pair) for pair in zip(stops, stops[1:]))


print("pytransform3d", version("pytransform3d"))
rest = pr.axis_angle_from_matrix(np.eye(3))
half = pr.axis_angle_slerp(rest, written(0, 1, 0, 120), 0.5)
print("half of 120 degrees about y:", np.round(half[:3], 3), "by", np.degrees(half[3]).round(1), "degrees")
quarter = written(1, 0, 0, 90), written(0, 1, 0, 90)
off = apart(pr.axis_angle_slerp(*quarter, 0.5), by_quaternions(*quarter, 0.5))
print(f"90 degrees about x to 90 about y: {off:.1f} degrees off in the middle")
near = written(0, 0, 1, 175), written(0, 0.01, -1, 175)
ways = [travelled(slerp, *near) for slerp in (pr.axis_angle_slerp, by_quaternions)]
print(f"two attitudes {apart(*near):.1f} degrees apart: {ways[0]:.1f} travelled, by quaternions {ways[1]:.1f}")
opposite = pr.axis_angle_slerp(written(0, 0, 1, 170), written(0, 0, -1, 170), 0.5)
print("between opposite axes:", opposite[:3])
seen = (
    np.allclose(half[:3], [0.5**0.5, 0.5**0.5, 0.0])
    and 19.0 < off < 20.0
    and ways[0] > 350.0
    and abs(ways[1] - apart(*near)) < 0.1
    and not opposite[:3].any()
)
if not seen:
    raise SystemExit("CHANGED: it is the turn that quaternions make, too")
PY
