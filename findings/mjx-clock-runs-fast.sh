#!/usr/bin/env bash
# After four minutes the clock of an MJX simulation runs 0.7 % fast.
#
# Expected: single precision costs a clock its seventh digit, so well under a millisecond in ten minutes.
# Happens: time is a float32 to which the step is added again and again, and each sum is rounded the same way. With a step of
#   2 ms it is 0.9 s ahead after 400 s and 2.3 s ahead after 600 s; up to 256 s it is slow instead. The
#   error does not average out: in each range of times every step has the same wrong length.
# Seen with: mujoco-mjx 3.17.0, jax 0.10.2, mujoco 4.0.0; data.time only, the states do not depend on it here.
# Means: references, pushes and phases looked up by data.time drift from the motion, at 60 Hz by a frame within two
#   minutes and by a hundred within ten. Count steps and multiply, or set the time back at each episode's start.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check \
    mujoco-mjx==3.17.0 mujoco==4.0.0 jax==0.10.2 jaxlib==0.10.2 numpy==2.4.6
cd "$work"
JAX_PLATFORMS=cpu "$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import jax
import mujoco
from mujoco import mjx

model = mujoco.MjModel.from_xml_string(
    """<mujoco><option timestep="0.002"/><worldbody><body><joint axis="0 1 0"/>
    <geom type="capsule" fromto="0 0 0 0 0 -.3" size=".03"/></body></worldbody></mujoco>"""
)
on_device = mjx.put_model(model)


@jax.jit
def hundred_seconds(data):
    return jax.lax.scan(lambda data, _: (mjx.step(on_device, data), None), data, None, length=50000)[0]


print(*(f"{name} {version(name)}" for name in ("mujoco-mjx", "jax", "mujoco")))
data = mjx.put_data(model, mujoco.MjData(model))
ahead = {}
for seconds in (100, 200, 300, 400, 500, 600):
    data = hundred_seconds(data)
    ahead[seconds] = float(data.time) - seconds
    print(f"{50000 * seconds // 100} steps of 2 ms: time says {float(data.time):.3f} s, {ahead[seconds]:+.3f} s off")
if not (ahead[100] < -0.01 and 0.8 < ahead[400] < 1.0 and 2.2 < ahead[600] < 2.4):
    raise SystemExit("CHANGED: the clock keeps better time, or worse")
PY
