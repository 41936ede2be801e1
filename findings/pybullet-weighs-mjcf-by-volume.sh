#!/usr/bin/env bash
# PyBullet reads an MJCF and gives every geom the mass of water of its size.
#
# Expected: loadMJCF takes a body's mass from <inertial>, else from mass or density of its geoms, as the format says, and
#   says so where it does not support one of them.
# Happens: <inertial> is heeded, mass and density of geoms are passed over without a word: each geom weighs its volume times
#   1000 kg/m3. A pelvis of 50 kg comes out at 4.19 kg.
# Seen with: pybullet 3.2.7, mujoco 4.0.0 for comparison. Each model below has a file of its own, as PyBullet keeps the text of
#   a file that it has read once.
# Means: a character with masses from anthropometric tables stands, falls and needs torques like another person. The
#   usual check that it loads and looks right passes. Give each body its <inertial>, set masses and inertias afterwards
#   with changeDynamics, or load a URDF.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check --only-binary pybullet \
    pybullet==3.2.7 mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import mujoco
import pybullet

TEXT = """<mujoco model="character"><worldbody>
<body name="pelvis" pos="0 0 1"><geom type="sphere" size=".1" {geom}/>
<body name="thigh" pos="0 0 -.1"><joint name="hip" type="hinge" axis="0 1 0" range="-90 90"/>{inertial}
<geom type="capsule" fromto="0 0 0 0 0 -.4" size=".05"/></body></body></worldbody></mujoco>"""
INERTIAL = '<inertial pos="0 0 -.2" mass="8" diaginertia=".1 .1 .01"/>'

pybullet.connect(pybullet.DIRECT)
print("pybullet", version("pybullet"), "mujoco", version("mujoco"), "- mass of the whole")
masses = {}
for label, geom, inertial in (("nothing given", "", ""), ("mass", 'mass="50"', ""), ("density", 'density="20000"', ""), ("inertial", "", INERTIAL)):
    text = TEXT.format(geom=geom, inertial=inertial)
    name = f"{label.replace(' ', '_')}.xml"
    with open(name, "w") as file:
        file.write(text)
    (body,) = pybullet.loadMJCF(name)
    joints = range(-1, pybullet.getNumJoints(body))  # -1 is the base
    loaded = sum(pybullet.getDynamicsInfo(body, joint)[0] for joint in joints)
    masses[label] = float(mujoco.MjModel.from_xml_string(text).body_mass.sum()), loaded
    print(f"{label:13s}: MuJoCo {masses[label][0]:6.2f} kg, PyBullet {loaded:6.2f} kg")
by_volume = masses["nothing given"][0]
if any(abs(masses[label][1] - by_volume) > 0.01 for label in ("mass", "density")):
    raise SystemExit("CHANGED: PyBullet heeds the mass or the density of a geom")
if abs(masses["inertial"][1] - masses["inertial"][0]) > 0.01:
    raise SystemExit("CHANGED: PyBullet no longer heeds inertial")
if any(abs(masses[label][0] - by_volume) < 1 for label in ("mass", "density", "inertial")):
    raise SystemExit("CHANGED: MuJoCo does not tell these models apart")
PY
