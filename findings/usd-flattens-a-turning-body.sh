#!/usr/bin/env bash
# Between two samples of its matrix a turning body in USD shrinks, halfway round to nothing.
#
# Expected: a time-sampled transform is interpolated like a pose: place along a line, attitude along a turn.
# Happens: xformOp:transform is a matrix and its sixteen numbers are interpolated one by one. Halfway through a quarter turn
#   a limb is 29 % too thin across the axis; halfway through a half turn it is flat, its determinant 0. With translate
#   and orient in place of the matrix the same two samples give the turn.
# Seen with: usd-core 26.11, XformCache and any other reader of UsdGeom.Xformable.
# Means: matrices are what a simulator has at hand, and at 60 samples a second nothing shows. With every tenth frame kept, or
#   key poses of a flip, distances between joints and heights of hands and feet read at other times are wrong by
#   centimetres. Write translate and orient.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check usd-core==26.11 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from pxr import Gf, Usd, UsdGeom

stage = Usd.Stage.CreateNew("flip.usda")


def turn(degrees):
    return Gf.Rotation(Gf.Vec3d(0, 1, 0), degrees)


def halfway(kind, degrees):
    """The rotation part of the pose at time 5, of samples at 0 and 10."""
    limb = UsdGeom.Xform.Define(stage, f"/{kind}{degrees}")
    if kind == "transform":
        operation = limb.AddTransformOp()
        for time, angle in ((0, 0), (10, degrees)):
            operation.Set(Gf.Matrix4d().SetRotate(turn(angle)), time)
    else:
        operation = limb.AddOrientOp()
        for time, angle in ((0, 0), (10, degrees)):
            operation.Set(Gf.Quatf(turn(angle).GetQuat()), time)
    return np.array(UsdGeom.XformCache(Usd.TimeCode(5)).GetLocalToWorldTransform(limb.GetPrim()))[:3, :3]


print("usd-core", version("usd-core"), "- a limb of 0.4 m across the axis, halfway between two samples")
length = {}
for degrees in (6, 60, 90, 180):
    for kind in ("transform", "orient"):
        pose = halfway(kind, degrees)
        length[kind, degrees] = float(np.linalg.norm(np.array([0.4, 0.0, 0.0]) @ pose))
        print(f"{degrees:3d} degrees apart, {kind:9s}: {length[kind, degrees]:.4f} m long, determinant {np.linalg.det(pose):.4f}")
if any(abs(length["orient", degrees] - 0.4) > 1e-6 for degrees in (6, 60, 90, 180)):
    raise SystemExit("CHANGED: samples of orient are not interpolated as turns either")
if not np.allclose([length["transform", degrees] for degrees in (90, 180)], [0.4 / 2**0.5, 0], atol=1e-6):
    raise SystemExit("CHANGED: samples of a matrix are interpolated as poses")
PY
