#!/usr/bin/env bash
# The second hinge of an MJCF ankle turns about the place of the first in Newton: feet come out 2 cm off.
#
# Expected: each <joint> of a body has a pos of its own. MuJoCo's humanoid, and those of gymnasium and dm_control that
#   come from it, turn the foot in one body about two points: up and down 8 cm above it, sideways 4 cm above it.
# Happens: Newton makes one joint with several axes of them and takes the pos of the first for all. Masses, attitudes and
#   each first axis are right, so it shows neither at rest nor in a glance at the joint list.
# Seen with: newton 1.8.0 (CPU), by ModelBuilder.add_mjcf; mujoco 4.0.0 beside it.
# Means: poses of MuJoCo put feet below the floor or above it there. Give the second hinge a body of its own.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check newton==1.8.0 warp-lang==1.19.0 mujoco==4.0.0 numpy==2.4.6
cd "$work"
export WARP_CACHE_PATH="$work/warp"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import mujoco
import newton
import numpy as np
import warp

warp.config.quiet = True
MODEL = """<mujoco><worldbody><body name="shin" pos="0 0 1"><joint name="root" type="free"/><geom size="0.1" mass="2"/>
  <body name="foot" pos="0 0 -0.4"><joint name="ankle_y" axis="0 1 0" pos="0 0 0.08"/>
  <joint name="ankle_x" axis="1 0 0" pos="0 0 0.04"/><geom size="0.05" mass="1"/></body></body></worldbody></mujoco>"""

right = mujoco.MjModel.from_xml_string(MODEL)
data = mujoco.MjData(right)
builder = newton.ModelBuilder()
builder.add_mjcf(MODEL)
model = builder.finalize(device="cpu")
print("newton", version("newton"), "and mujoco", version("mujoco"), "- where the foot is, turned by 0.5 rad")
apart = {}
for name, angles in {"neither": (0, 0), "ankle_y": (0.5, 0), "ankle_x": (0, 0.5)}.items():
    data.qpos[7:] = angles
    mujoco.mj_kinematics(right, data)
    q = model.joint_q.numpy()
    q[7:] = angles
    state = model.state()
    newton.eval_fk(model, warp.array(q, dtype=warp.float32, device="cpu"), model.joint_qd, state)
    foot = state.body_q.numpy()[1, :3]
    apart[name] = float(np.linalg.norm(foot - data.xpos[2]))
    print(f"{name:8s} MuJoCo {data.xpos[2].round(4)}  Newton {foot.round(4) + 0.0}  {1000 * apart[name]:.1f} mm apart")
if max(apart["neither"], apart["ankle_y"]) > 1e-4 or abs(apart["ankle_x"] - 0.0198) > 1e-3:
    raise SystemExit("CHANGED: each hinge has an anchor")
PY
