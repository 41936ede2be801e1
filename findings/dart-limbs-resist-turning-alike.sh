#!/usr/bin/env bash
# In DART every limb of an MJCF character has a moment of inertia of 1 kg m2, a hand as a trunk.
#
# Expected: mass, centre and inertia of a body without <inertial> come from its geoms, and from <inertial> where there is
#   one; DART's parser says that it infers them.
# Happens: the mass is that of the geom, the moment of inertia is 1 kg m2 about every axis, whatever size and mass. So
#   it is with <inertial>, and of a body that has one and no geom the mass is 1 kg too.
# Seen with: dartpy 6.20.0, by MjcfParser.readWorld.
# Means: a thigh of 8 kg is 3 times as hard to swing about the hip, a forearm of 1 kg 50 times about the elbow. Set the inertia of
#   each body node after loading.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check dartpy==6.20.0 mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version
from pathlib import Path

import dartpy
import mujoco
import numpy as np

LIMBS = {
    "thigh": '<geom type="box" size="0.07 0.07 0.2" pos="0 0 -0.2" mass="8"/>',
    "forearm": '<geom type="box" size="0.03 0.03 0.12" pos="0 0 -0.12" mass="1"/>',
    "foot with inertial": '<inertial pos="0 0 -0.1" mass="2" diaginertia="0.01 0.012 0.004"/><geom size="0.05"/>',
    "no geom": '<inertial pos="0 0 -0.1" mass="2" diaginertia="0.01 0.012 0.004"/>',
}
MODEL = """<mujoco><worldbody><body name="limb" pos="0 0 1"><joint name="hinge" axis="0 1 0"/>%s</body></worldbody></mujoco>"""

print("dartpy", version("dartpy"), "and mujoco", version("mujoco"), "- one limb on a hinge")
alike, lost = [], {}
for name, inside in LIMBS.items():
    path = Path("model.xml").absolute()
    path.write_text(MODEL % inside)
    right = mujoco.MjModel.from_xml_path(str(path))
    node = dartpy.utils.MjcfParser.readWorld(str(path)).getSkeleton(0).getBodyNode("limb")
    moment = np.diag(node.getInertia().getMoment())
    alike.append(moment)
    lost[name] = node.getMass() / right.body_mass[1]
    print(
        f"{name:19s} MuJoCo {right.body_mass[1]:.1f} kg, {right.body_inertia[1].round(4)} kg m2;"
        f" DART {node.getMass():.1f} kg, {moment} kg m2"
    )
if not np.allclose(alike, 1.0) or [round(v, 6) for v in lost.values()] != [1.0, 1.0, 1.0, 0.5]:
    raise SystemExit("CHANGED: limbs have inertias of their own")
PY
