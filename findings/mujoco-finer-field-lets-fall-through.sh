#!/usr/bin/env bash
# Refine a MuJoCo height field and a limb lying on it falls through.
#
# Expected: smaller cells cost time and make the ground more exact.
# Happens: a capsule 0.9 m long lies on level cells of 10 and 2 cm and drops through cells of 1 cm, without a warning
#   while it sinks.
# Seen with: mujoco 4.0.0. One pair of geoms keeps 50 contacts (mjMAXCONPAIR), collected from one side of the field
#   to the other; on fine cells all 50 lie under one end, and the other end has nothing below it.
# Means: the resolution of terrain has an upper bound that comes from the longest geom, about its length over 50 and
#   less when it lies across the grid. Watch for pairs that reach 50 contacts.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import mujoco

MODEL = """<mujoco><asset><hfield name="flat" nrow="{n}" ncol="{n}" size="2 2 1 .1"/></asset><worldbody>
<geom type="hfield" hfield="flat"/>
<body pos=".013 .021 .06" euler="0 90 0"><freejoint/><geom type="capsule" size=".05 .4"/></body></worldbody></mujoco>"""

print("mujoco", mujoco.__version__, "- a capsule of 5 cm radius on a level field of 4 m, 4 s later")
height = {}
for cells in (40, 200, 400):
    model = mujoco.MjModel.from_xml_string(MODEL.format(n=cells + 1))
    data = mujoco.MjData(model)
    contacts = 0
    for _ in range(2000):
        mujoco.mj_step(model, data)
        contacts = max(contacts, data.ncon)
    warned = sum(int(warning.number) for warning in data.warning)
    height[cells] = float(data.qpos[2])
    print(f"cells of {400 / cells:4.1f} cm: height {height[cells]:8.3f} m, most contacts {contacts}, warnings {warned}")
if not (abs(height[40] - 0.05) < 0.002 and abs(height[200] - 0.05) < 0.005 and height[400] < -1):
    raise SystemExit("CHANGED: the capsule no longer falls through the finest field alone")
if warned:
    raise SystemExit("CHANGED: the fall now comes with a warning")
PY
