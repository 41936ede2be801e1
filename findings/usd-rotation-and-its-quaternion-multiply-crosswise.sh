#!/usr/bin/env bash
# In USD a somersault times a twist, as rotations, is the twist after the somersault, and the quaternions of the same two multiply to the somersault after the twist.
#
# Expected: Gf.Rotation and its Gf.Quatd are one thing written in two ways, with methods from each to the other: the quaternion of a product is the product of the
#   quaternions, whichever convention holds. It is so in libraries that have both, with matrices in the place of one as well.
# Happens: Gf.Rotation a * b turns by a and then by b about fixed axes, as Gf's matrices do, whose vectors are rows. Gf.Quatd a * b turns by b and then by a, as in
#   textbooks, and Gf.Quaternion, which the other method gives, too. A quarter turn about x and one about z are 120 degrees apart in the two.
#   About one axis, or for small turns, nothing is seen.
# Seen with: usd-core 26.11. Its reference has the same words for both, that the argument is post-multiplied "into this". Issue 4087 tells how the order
#   of rotation ops confused even its documents.
# Means: UsdSkel holds quaternions, xformOps matrices or angles, and code that writes a limb's attitude goes through Gf.Rotation for its (axis, angle). A chain
#   that is multiplied in one type and checked in the other is bent wrongly in every joint with two axes. Stay in one type down the chain, and turn a known
#   vector (TransformDir, Transform) to see which.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check usd-core==26.11
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

from pxr import Gf

X, Z = Gf.Vec3d(1, 0, 0), Gf.Vec3d(0, 0, 1)
PROBES = (Gf.Vec3d(1, 0, 0), Gf.Vec3d(0, 1, 0), Gf.Vec3d(0.2, 0.5, -0.8))


def apart(one, other):
    """Greatest distance of the probes as they are turned by two functions."""
    return max((one(probe) - other(probe)).GetLength() for probe in PROBES)


print("usd-core", version("usd-core"), "- the product a * b turns by")
for degrees, axis in ((90.0, Z), (50.0, Gf.Vec3d(1, 2, 2).GetNormalized()), (40.0, X)):
    a, b = Gf.Rotation(X, 90.0), Gf.Rotation(axis, degrees)
    a_then_b, b_then_a = (lambda v: b.TransformDir(a.TransformDir(v))), (lambda v: a.TransformDir(b.TransformDir(v)))
    matrix = Gf.Matrix3d(a) * Gf.Matrix3d(b)
    products = {
        "Rotation": (a * b).TransformDir,
        "Matrix3d": lambda v: v * matrix,
        "Quatd": (a.GetQuat() * b.GetQuat()).Transform,
        "Quaternion": Gf.Rotation(a.GetQuaternion() * b.GetQuaternion()).TransformDir,
        "Rotation of Quatd": Gf.Rotation(a.GetQuat() * b.GetQuat()).TransformDir,
    }
    difference = (Gf.Rotation(a.GetQuat() * b.GetQuat()) * (a * b).GetInverse()).GetAngle()
    difference = min(difference, 360.0 - difference)
    for name, turn in products.items():
        first, second = apart(turn, a_then_b), apart(turn, b_then_a)
        order = "either" if max(first, second) < 1e-9 else "a, then b" if first < 1e-9 else "b, then a" if second < 1e-9 else "neither"
        print(f"a: 90 about x, b: {degrees:.0f} about {tuple(round(c, 2) for c in axis)}; {name:17s} {order}")
        if order != ("either" if axis == X else "a, then b" if name in ("Rotation", "Matrix3d") else "b, then a"):
            raise SystemExit("CHANGED: a product goes in another order")
    print(f"   the two are {difference:.1f} degrees apart")
    if apart(Gf.Rotation(a.GetQuat()).TransformDir, a.TransformDir) > 1e-9 or apart(a.GetQuat().Transform, a.TransformDir) > 1e-9:
        raise SystemExit("CHANGED: one turn is no longer the same in both types")
    if axis == Z and abs(difference - 120.0) > 1e-6:
        raise SystemExit("CHANGED: two quarter turns are apart by another angle")
PY
