#!/usr/bin/env bash
# Joint limits given to MuJoCo's MjSpec in Python are read as degrees.
#
# Expected: numbers handed over in Python are radians, as in mjModel.jnt_range and mjData.qpos.
# Happens: add_joint(range=[-1.57, 1.57]) compiles to +-0.0274 rad, a joint that hardly moves; and no error comes, as
#   any number is a fair angle.
# Seen with: mujoco 4.0.0. A new MjSpec has compiler.degree true, the default of the XML. A spec that was read from a
#   file with angle="radian" takes radians, so the same line means two things in two specs.
# Means: set spec.compiler.degree = False right after MjSpec(). A character built in code otherwise stands like a
#   statue and its controller is blamed.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import mujoco


def limit(spec):
    body = spec.worldbody.add_body()
    body.add_joint(axis=[0, 1, 0], range=[-1.57, 1.57])
    body.add_geom(size=[0.1, 0, 0])
    return float(spec.compile().jnt_range[0, 1])


print("mujoco", mujoco.__version__, "- add_joint(range=[-1.57, 1.57])")
fresh = limit(mujoco.MjSpec())
read = limit(mujoco.MjSpec.from_string('<mujoco><compiler angle="radian"/></mujoco>'))
print(f"in a new spec: {fresh:.4f} rad; in one read with angle=radian: {read:.4f} rad")
if abs(fresh - 0.0274) > 1e-4 or abs(read - 1.57) > 1e-9:
    raise SystemExit("CHANGED: a new MjSpec takes radians")
PY
