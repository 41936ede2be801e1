#!/usr/bin/env bash
# Drake finds the motors of a hand-written MJCF, and none once MuJoCo has saved the file.
#
# Expected: loading a model in MuJoCo and saving it changes the layout, not what other readers of the format find in it.
# Happens: MuJoCo saves <motor> as <general>, of which it is a shorthand; Drake's parser knows <motor> and skips
#   <general>. The same character has two actuators before and none after; the load succeeds, the log has a warning.
# Seen with: drake 1.51.1, mujoco 4.0.0.
# Means: the model kept in an experiment's log, or one that passed through MjSpec, is a puppet without strings elsewhere.
#   Rename <general> back before handing it on where gains and biases are those of a motor, and count the actuators.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check drake==1.51.1 mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import mujoco
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

WRITTEN = """<mujoco model="leg"><worldbody><body name="pelvis" pos="0 0 1"><freejoint/><geom type="sphere" size=".1"/>
<body name="thigh" pos="0 0 -.1"><joint name="hip" type="hinge" axis="0 1 0"/>
<geom type="capsule" fromto="0 0 0 0 0 -.4" size=".05"/>
<body name="shin" pos="0 0 -.4"><joint name="knee" type="hinge" axis="0 1 0"/>
<geom type="capsule" fromto="0 0 0 0 0 -.4" size=".04"/></body></body></body></worldbody>
<actuator><motor name="hip" joint="hip" ctrlrange="-50 50"/><motor name="knee" joint="knee" ctrlrange="-50 50"/></actuator>
</mujoco>"""

spec = mujoco.MjSpec.from_string(WRITTEN)
spec.compile()
saved = spec.to_xml()
print("drake", version("drake"), "mujoco", version("mujoco"))
found = {}
for label, text in (("as written", WRITTEN), ("as saved", saved), ("renamed", saved.replace("<general ", "<motor "))):
    plant = MultibodyPlant(0.01)
    Parser(plant).AddModelsFromString(text, "xml")
    plant.Finalize()
    found[label] = mujoco.MjModel.from_xml_string(text).nu, plant.num_actuators()
    print(f"{label:10s}: MuJoCo {found[label][0]} actuators, Drake {found[label][1]}")
if found != {"as written": (2, 2), "as saved": (2, 0), "renamed": (2, 2)}:
    raise SystemExit("CHANGED: Drake finds the motors of a model saved by MuJoCo, or none at all")
PY
