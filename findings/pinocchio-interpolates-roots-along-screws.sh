#!/usr/bin/env bash
# Pinocchio's interpolation between two poses of a character sends its root round a curve.
#
# Expected: halfway between two configurations the root is halfway along the straight line, turned by half.
# Happens: the root's place and attitude are interpolated together, along a screw. A body that moves 2 m along x and turns half
#   round on the way passes 1 m beside the middle of the line.
# Seen with: pin 4.1.0: pinocchio.interpolate and difference on a free-flyer, geodesic on SE(3). A model whose root is a
#   translation and a spherical joint goes straight.
# Means: frames put between captured ones, blends between two reference poses and random starts "between" two postures
#   lift a tumbling body off the ground or sink it. The effect goes with distance times turn per interval: unseen
#   between frames of a walk, large between key poses of a roll.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import numpy as np
import pinocchio

ORIGIN = pinocchio.SE3.Identity()


def with_one_root_joint():
    model = pinocchio.Model()
    model.addJoint(0, pinocchio.JointModelFreeFlyer(), ORIGIN, "root")
    return model


def with_separate_root_joints():
    model = pinocchio.Model()
    place = model.addJoint(0, pinocchio.JointModelTranslation(), ORIGIN, "place")
    model.addJoint(place, pinocchio.JointModelSpherical(), ORIGIN, "attitude")
    return model


def beside_the_line(model, degrees):
    """How far from the middle of a line of 2 m along x the root is halfway, turning about z on the way."""
    half = np.radians(degrees) / 2
    start = np.array([0, 0, 0, 0, 0, 0, 1.0])
    end = np.array([2, 0, 0, 0, 0, np.sin(half), np.cos(half)])  # quaternions are x, y, z, w
    middle = pinocchio.interpolate(model, start, end, 0.5)
    return float(np.linalg.norm(middle[:3] - [1, 0, 0]))


print("pin", pinocchio.__version__, "- halfway, metres from the middle of a straight line of 2 m")
seen = {}
for degrees in (0, 10, 45, 90, 179.99):
    seen[degrees] = beside_the_line(with_one_root_joint(), degrees), beside_the_line(with_separate_root_joints(), degrees)
    print(f"turned by {degrees:6.2f} degrees: free flyer {seen[degrees][0]:.4f}, translation and spherical {seen[degrees][1]:.4f}")
if any(separate > 1e-9 for _, separate in seen.values()) or seen[0][0] > 1e-9 or abs(seen[179.99][0] - 1) > 0.01:
    raise SystemExit("CHANGED: the root of a free flyer goes straight, or another way")
PY
