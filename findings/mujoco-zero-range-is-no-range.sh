#!/usr/bin/env bash
# A MuJoCo joint with range="0 0" is not locked: it is free.
#
# Expected: limits of 0 and 0 hold the joint at 0 (softly), as limits of 0 and 0.001 do.
# Happens: the joint gets no limit and swings all the way round. No warning.
# Seen with: mujoco 4.0.0. Under autolimits (the default) "a range was given" is judged by its numbers, and 0 0 is the
#   value of a range that was not. limited="true" beside it does not help: compilation refuses it as an invalid range.
# Means: skeletons made from a table of limits (ASF, URDF, anatomy) often have degrees of freedom of width zero, such
#   as a knee's twist. Written as they are, these are the loosest joints of the body. Leave such joints out.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math

import mujoco

MODEL = """<mujoco><compiler angle="radian"/><worldbody><body><joint axis="0 1 0" {limits}/>
<geom type="capsule" fromto="0 0 0 .3 0 0" size=".03"/></body></worldbody></mujoco>"""


def swing(limits):
    """Whether there is a limit, and the largest angle in 2 s of falling from horizontal, degrees."""
    model = mujoco.MjModel.from_xml_string(MODEL.format(limits=limits))
    data = mujoco.MjData(model)
    largest = 0.0
    for _ in range(1000):
        mujoco.mj_step(model, data)
        largest = max(largest, abs(math.degrees(data.qpos[0])))
    return bool(model.jnt_limited[0]), largest


print("mujoco", mujoco.__version__)
seen = {limits: swing(limits) for limits in ('range="0 0.001"', 'range="0 0"')}
for limits, (limited, largest) in seen.items():
    print(f"{limits:16s} limited {limited!s:5s} swings to {largest:6.1f} degrees")
try:
    swing('range="0 0" limited="true"')
    forced = "compiles"
except ValueError as error:
    forced = "refused: " + str(error).splitlines()[0]
print('range="0 0" limited="true":', forced)
if seen['range="0 0"'][0] or seen['range="0 0"'][1] < 90 or seen['range="0 0.001"'][1] > 5 or forced == "compiles":
    raise SystemExit("CHANGED: a range of zero width now limits the joint")
PY
