#!/usr/bin/env bash
# pytransform3d interpolates between two nearly equal orientations by way of almost a whole turn.
#
# Expected: slerp goes the short way; a quaternion and its negative are one orientation, and scipy and trimesh treat them
#   so.
# Happens: quaternion_slerp(q, p, 0.5) of orientations 34 degrees apart is 163 degrees from both when the second happens
#   to have the other sign. The short way is an option, shortest_path, which is off.
# Seen with: pytransform3d 3.17.0, scipy 1.17.1, trimesh 5.2.0.
# Means: signs in captured or simulated data are arbitrary (they follow the path, or the conversion from a matrix). A
#   resampled clip is fine until one frame's sign differs, and then whirls round for one frame.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pytransform3d==3.17.0 scipy==1.17.1 trimesh==5.2.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from pytransform3d.rotations import quaternion_slerp
from scipy.spatial.transform import Rotation, Slerp
from trimesh.transformations import quaternion_slerp as trimesh_slerp

START = np.array([1.0, 0.0, 0.0, 0.0])
END = np.array([np.cos(0.3), np.sin(0.3), 0.0, 0.0])  # 34 degrees about x


def degrees_from_start(quaternion):
    return float(np.degrees(Rotation.from_quat(quaternion, scalar_first=True).magnitude()))


def by_scipy(start, end, fraction):
    ends = Rotation.from_quat([start, end], scalar_first=True)
    return Slerp([0, 1], ends)(fraction).as_quat(scalar_first=True)


print(*(f"{name} {version(name)}" for name in ("pytransform3d", "scipy", "trimesh")), "- halfway between 0 and 34.4 degrees")
halfway = {}
for name, slerp in (
    ("pytransform3d", quaternion_slerp),
    ("pytransform3d, shortest_path", lambda start, end, t: quaternion_slerp(start, end, t, shortest_path=True)),
    ("scipy", by_scipy),
    ("trimesh", trimesh_slerp),
):
    halfway[name] = [degrees_from_start(slerp(START, sign * END, 0.5)) for sign in (1, -1)]
    print(f"{name:29s} same sign {halfway[name][0]:6.2f}, other sign {halfway[name][1]:6.2f} degrees")
odd = halfway.pop("pytransform3d")
if abs(odd[0] - 17.19) > 0.01 or abs(odd[1] - 162.81) > 0.01 or not np.allclose(list(halfway.values()), 17.19, atol=0.01):
    raise SystemExit("CHANGED: quaternion_slerp goes the short way, or one of the others does not")
PY
