#!/usr/bin/env bash
# PyBullet loads the first version of a URDF file for ever, also after the file has been written anew.
#
# Expected: loadURDF reads the file; at the latest after resetSimulation() a file that has changed gives the new model.
# Happens: the text of every file is kept under its name and never compared with the disk. A character of 40 kg is loaded, the
#   file is written anew with 60 and then 80 kg, and PyBullet simulates 40 kg each time, resetSimulation() in between or
#   not. A new name or a new connection reads the new text.
# Seen with: pybullet 3.2.7; loadMJCF goes the same way.
# Means: a sweep over body mass, limb lengths or joint limits that writes body.urdf for each point runs the first point again
#   and again, and its table says that the parameter has no effect. setPhysicsEngineParameter(enableFileCaching=0) after
#   each connect, or a name for each model.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check --only-binary pybullet pybullet==3.2.7 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import pybullet

BODY = """<robot name="body"><link name="trunk"><inertial><mass value="{}"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""
MASSES = (40.0, 60.0, 80.0)


def loaded(**settings):
    """The masses of three versions of one file, in kg."""
    pybullet.connect(pybullet.DIRECT)
    pybullet.setPhysicsEngineParameter(**settings)
    masses = []
    for mass in MASSES:
        pybullet.resetSimulation()
        with open("body.urdf", "w") as file:
            file.write(BODY.format(mass))
        masses.append(pybullet.getDynamicsInfo(pybullet.loadURDF("body.urdf"), -1)[0])
    pybullet.disconnect()
    return masses


kept, fresh = loaded(), loaded(enableFileCaching=0)
print("pybullet", version("pybullet"), "- masses written", *MASSES)
print("by default        ", *kept)
print("enableFileCaching=0", *fresh)
if kept != [MASSES[0]] * 3 or fresh != list(MASSES):
    raise SystemExit("CHANGED: a file written anew is read anew, or not even without the cache")
PY
