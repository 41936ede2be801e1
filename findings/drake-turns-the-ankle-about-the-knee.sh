#!/usr/bin/env bash
# The foot of an MJCF character has two hinges in its ankle; in Drake the first of them turns it about the knee.
#
# Expected: joints of one body are put in line between it and its parent, all of them where the file puts the body; MuJoCo does so, and Drake makes a body
#   without mass for each joint but the last.
# Happens: the place of the body belongs to the last joint only. The first stands at the origin of the parent: with the first ankle angle at 0.4 rad the
#   foot is 16 cm from where it is in MuJoCo, turned rightly. A motor of that joint has to turn 0.19 kg m2 in place of 0.0074. With three joints two are
#   wrong, slides are shifted along unturned axes. With all joints at zero nothing is to be seen, nor with bodies of one joint, nor is there a warning.
# Seen with: drake 1.51.1, the last one for Python 3.11, mujoco 4.0.0. Its issue 20367, closed, was of the pos of single joints.
# Means: hips, ankles, shoulders and spines of the usual MJCF characters have two or three hinges. Total mass and the standing pose agree, and limbs come
#   off as soon as it moves; torques for it are of another body. Put a body with next to no mass between the joints in the file itself.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check drake==1.51.1 mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import mujoco
import numpy as np
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

FOOT = '<inertial pos=".05 0 -.03" mass="1" diaginertia=".002 .004 .005"/>'
ONE = f'<body name="foot" pos="0 0 -.4"><joint name="pitch" axis="0 1 0"/><joint name="roll" axis="1 0 0"/>{FOOT}</body>'
TWO = f"""<body name="cross" pos="0 0 -.4"><joint name="pitch" axis="0 1 0"/><inertial pos="0 0 0" mass="1e-9" diaginertia="1e-9 1e-9 1e-9"/>
<body name="foot"><joint name="roll" axis="1 0 0"/>{FOOT}</body></body>"""
LEG = """<mujoco model="leg"><compiler angle="radian"/><worldbody><body name="shin" pos="0 0 1"><joint name="knee" axis="0 1 0"/>
<inertial pos="0 0 -.2" mass="4" diaginertia=".05 .05 .01"/>{ankle}</body></worldbody></mujoco>"""


def poses(ankle, pitch):
    """Places of the foot in MuJoCo and in Drake [m], and what the first ankle joint has to turn [kg m2]."""
    xml = LEG.format(ankle=ankle)
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    data.qpos[:] = [0, pitch, 0]
    mujoco.mj_forward(model, data)
    inertia = np.zeros((3, 3))
    mujoco.mj_fullM(model, data, inertia)
    plant = MultibodyPlant(0.0)
    Parser(plant).AddModelsFromString(xml, "mujoco.xml")
    plant.Finalize()
    context = plant.CreateDefaultContext()
    plant.SetPositions(context, [0, pitch, 0])
    foot = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName("foot"))
    turned = np.abs(foot.rotation().matrix() - data.body("foot").xmat.reshape(3, 3)).max()
    return data.body("foot").xpos.copy(), foot.translation(), inertia[1, 1], plant.CalcMassMatrix(context)[1, 1], turned


print("drake", version("drake"), "mujoco", mujoco.__version__)
off, ratio, turned = {}, {}, 0.0
for name, ankle in (("two joints in one body", ONE), ("a body for each", TWO)):
    for pitch in (0.0, 0.4):
        there, drake, inertia, seen, apart = poses(ankle, pitch)
        off[name, pitch], ratio[name, pitch] = float(np.linalg.norm(drake - there)), seen / inertia
        turned = max(turned, apart)
        print(f"{name}, pitch {pitch}: foot at {np.round(there, 3)} in MuJoCo, {np.round(drake, 3) + 0.0} in Drake; {inertia:.4f} and {seen:.4f} kg m2")
if turned > 1e-9 or max(off["a body for each", pitch] for pitch in (0.0, 0.4)) > 1e-6 or abs(ratio["a body for each", 0.4] - 1) > 1e-3:
    raise SystemExit("CHANGED: attitudes, or feet on joints of their own, differ too")
if off["two joints in one body", 0.0] > 1e-9 or abs(off["two joints in one body", 0.4] - 0.8 * np.sin(0.2)) > 1e-3 or ratio["two joints in one body", 0.0] < 20:
    raise SystemExit("CHANGED: the first of two joints of a body no longer turns it about the origin of the parent")
PY
