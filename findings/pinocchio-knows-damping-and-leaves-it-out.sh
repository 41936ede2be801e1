#!/usr/bin/env bash
# Pinocchio reads armature, damping and dry friction of an MJCF joint into its model; its dynamics use the first, and gravity is the Earth's.
#
# Expected: what stands in the model takes part in the forward dynamics, or is not read. model.armature, model.damping and the limits of dry friction
#   are filled side by side from one <joint>, and aba, crba and rnea know the armature. <option gravity> is one line of the file.
# Happens: aba gives the acceleration of a joint without damping and without friction, to the last digit: -11 rad/s2
#   where MuJoCo has -25. From URDF it is the same. With a gravity of 1.62 m/s2 in the file model.gravity is 9.81, and weights are six times too large.
#   Nothing is said.
# Seen with: pin 4.1.0, mujoco 4.0.0. In its issue 1291 reading them from URDF was thought of; in 671 the armature, which was read only, was taken into account.
# Means: damping is what a passive joint's tissue is modelled by, and numbers of 1 to 5 N m s/rad are a good part of the torque in fast motion. Feedforward
#   by rnea lacks it in every joint, which feedback hides, and a simulation by aba is livelier than the model. Subtract model.damping * v oneself, and
#   set model.gravity.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from pathlib import Path

import mujoco
import numpy as np
import pinocchio

LEG = """<mujoco><compiler angle="radian"/><option gravity="0 0 -{gravity}"/><worldbody><body name="leg"><joint name="hip" axis="0 1 0" {hip}/>
<inertial pos="0 0 -.2" mass="8" diaginertia=".1 .1 .02"/></body></worldbody></mujoco>"""
URDF = """<robot name="leg"><link name="pelvis"/><link name="leg"><inertial><origin xyz="0 0 -.2"/><mass value="8"/>
<inertia ixx=".1" iyy=".1" izz=".02" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="hip" type="revolute"><parent link="pelvis"/>
<child link="leg"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="9" velocity="9"/><dynamics damping="3" friction="2"/></joint></robot>"""
Q, V, ZERO = np.array([0.3]), np.array([2.0]), np.zeros(1)


def accelerations(hip, gravity="9.81"):
    """Of the hip in MuJoCo, without limits and contacts, and in Pinocchio [rad/s2], and Pinocchio's model."""
    text = LEG.format(hip=hip, gravity=gravity)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = Q, V
    mujoco.mj_forward(model, data)
    Path("leg.xml").write_text(text)
    read = pinocchio.buildModelFromMJCF("leg.xml")
    return float(data.qacc[0]), float(pinocchio.aba(read, read.createData(), Q, V, ZERO)[0]), read


print("pin", pinocchio.__version__, "mujoco", mujoco.__version__)
found = {}
for hip in ("", 'armature=".2"', 'damping="3"', 'frictionloss="2"'):
    there, here, read = found[hip] = accelerations(hip)
    knows = f"armature {read.armature}, damping {read.damping}, dry friction {read.upperDryFrictionLimit}"
    print(f"{hip or 'plain':18s} {there:8.3f} rad/s2 in MuJoCo, {here:8.3f} in Pinocchio, which knows {knows}")
moon = accelerations("", "1.62")
print(f"gravity 1.62       {moon[0]:8.3f} rad/s2 in MuJoCo, {moon[1]:8.3f} in Pinocchio, which knows gravity {moon[2].gravity.linear}")
Path("leg.urdf").write_text(URDF)
urdf = pinocchio.buildModelFromUrdf("leg.urdf")
by_urdf = float(pinocchio.aba(urdf, urdf.createData(), Q, V, ZERO)[0])
print(f"URDF, damping 3             {by_urdf:8.3f} in Pinocchio, which knows damping {urdf.damping}, dry friction {urdf.upperDryFrictionLimit}")
plain = found[""][1]
if abs(plain - found[""][0]) > 1e-9 or abs(found['armature=".2"'][1] - found['armature=".2"'][0]) > 1e-9 or plain == found['armature=".2"'][1]:
    raise SystemExit("CHANGED: a plain joint differs, or one with armature")
if found['damping="3"'][2].damping[0] != 3 or found['frictionloss="2"'][2].upperDryFrictionLimit[0] != 2 or urdf.damping[0] != 3:
    raise SystemExit("CHANGED: damping or dry friction is not read")
if not found['damping="3"'][1] == found['frictionloss="2"'][1] == plain or abs(by_urdf - plain) > 1e-12 or abs(found['damping="3"'][0] - plain) < 5:
    raise SystemExit("CHANGED: damping or dry friction is taken into account")
if moon[2].gravity.linear[2] != -9.81 or moon[1] != plain:
    raise SystemExit("CHANGED: gravity is read from the file")
PY
