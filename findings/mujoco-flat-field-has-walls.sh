#!/usr/bin/env bash
# On a perfectly flat MuJoCo height field, contact normals lean over, up to horizontal.
#
# Expected: a height field of equal heights is a plane; a ball on it has contacts that point straight up.
# Happens: each cell is two prisms, and the ball meets the sides of those next door. Pressed in by 1 cm, a ball of 5 cm
#   radius gets normals 35 degrees off on cells of 20 cm and 90 degrees off (a wall) on cells of 10 cm. A frictionless
#   ball that rests on the field and is sent off at 3 m/s is braked and turned aside; on a plane it is not.
# Seen with: mujoco 4.0.0. With depth d and radius r the lean goes up to about arccos(1 - d / r), on small cells beyond.
# Means: light limb ends sink (soft contact), so hands and feet on "terrain" feel sideways forces from edges that are
#   not there. Compare with a plane before reading friction or slip from a height field.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math

import mujoco
import numpy as np


def world(cells, radius):
    """A flat field of 8 m by 8 m (a plane for no cells) and a frictionless ball."""
    field = f'<asset><hfield name="flat" nrow="{cells + 1}" ncol="{cells + 1}" size="4 4 1 .1"/></asset>' if cells else ""
    ground = 'type="hfield" hfield="flat"' if cells else 'type="plane" size="4 4 1"'
    text = f"""<mujoco>{field}<default><geom condim="1"/></default><worldbody><geom {ground}/>
    <body pos="-3 .03 {radius}"><freejoint/><geom type="sphere" size="{radius}" mass="5"/></body></worldbody></mujoco>"""
    model = mujoco.MjModel.from_xml_string(text)
    return model, mujoco.MjData(model)


def worst_lean(cells, depth, radius=0.05):
    model, data = world(cells, radius)
    lean = 0.0
    for x in np.linspace(0, 0.2, 21):
        for y in np.linspace(0, 0.2, 21):
            data.qpos[:3] = x, y, radius - depth
            mujoco.mj_forward(model, data)
            lean = max([lean] + [math.degrees(math.acos(min(1, contact.frame[2]))) for contact in data.contact])
    return lean


def speed_after(cells):
    model, data = world(cells, 0.1)
    mujoco.mj_step(model, data, 500)
    data.qvel[0] = 3.0
    mujoco.mj_step(model, data, 750)
    return data.qvel[:2].copy()


print("mujoco", mujoco.__version__, "- a ball pressed 1 cm into level ground, most any contact leans")
lean = {cells: worst_lean(cells, 0.01) for cells in (0, 40, 80)}
for cells, degrees in lean.items():
    print(f"{f'cells of {8 / cells:.1f} m' if cells else 'plane':14s} {degrees:5.1f} degrees")
speed = {cells: speed_after(cells) for cells in (0, 80)}
for cells, (vx, vy) in speed.items():
    print(f"{'height field' if cells else 'plane':12s} at 3 m/s along x, 1.5 s later: vx {vx:.4f}, vy {vy:.4f} m/s")
if not (lean[0] < 0.01 and 30 < lean[40] < 40 and lean[80] > 80):
    raise SystemExit("CHANGED: the contact normals of a flat height field no longer lean as described")
if not (abs(speed[0][0] - 3) < 1e-6 and speed[80][0] < 2.98 and abs(speed[80][1]) > 0.005):
    raise SystemExit("CHANGED: a frictionless ball crosses a flat height field undisturbed")
PY
