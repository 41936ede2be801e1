#!/usr/bin/env bash
# An MJCF character may not leave a cube of 2 m round the origin in Pinocchio, nor stand taller than 1.01 m.
#
# Expected: a free joint has no limits: infinite for its place, as for a URDF with a free flyer.
# Happens: read from MJCF all seven numbers of the root get -1.01 to 1.01, the room that Pinocchio leaves to the numbers
#   of a unit quaternion. pink then stops with "Joint 0 violates configuration limits" as soon as a step or a jump
#   takes the pelvis past 1.01 m.
# Seen with: pin 4.1.0, pin-pink 4.4.0 (solve_ik, check_limits). pinocchio.randomConfiguration keeps to the same cube.
# Means: a model whose pelvis is at 0.9 m works until it walks a metre; a clip that travels cannot be tracked, although the
#   same code runs with the URDF. Set lowerPositionLimit[:3] and upperPositionLimit[:3] to infinity after loading.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 pin-pink==4.4.0 daqp==0.11.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
import pink
import pinocchio

MJCF = """<mujoco model="walker"><worldbody><body name="pelvis" pos="0 0 .9"><freejoint name="root"/><geom size=".1"/>
<body name="leg" pos="0 0 -.1"><joint name="hip" axis="0 1 0" range="-60 60"/><geom size=".05" pos="0 0 -.8"/></body>
</body></worldbody></mujoco>"""
LINK = """<link name="{}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
URDF = f"""<robot name="walker">{LINK.format("pelvis")}{LINK.format("leg")}<joint name="hip" type="revolute"><axis xyz="0 1 0"/>
<parent link="pelvis"/><child link="leg"/><limit lower="-1.05" upper="1.05" effort="9" velocity="9"/></joint></robot>"""
for name, text in (("walker.xml", MJCF), ("walker.urdf", URDF)):
    with open(name, "w") as file:
        file.write(text)


def freed(model):
    model.lowerPositionLimit[:3], model.upperPositionLimit[:3] = -np.inf, np.inf
    return model


def walk(model):
    """How far the pelvis comes by inverse kinematics to a target 3 m ahead, and what stopped it."""
    start = pinocchio.neutral(model)
    start[2] = 0.9
    posture = pink.Configuration(model, model.createData(), start)
    task = pink.tasks.FrameTask("pelvis", position_cost=1.0, orientation_cost=1.0, gain=0.05)
    task.set_target(pinocchio.SE3(np.eye(3), np.array([3.0, 0.0, 0.9])))
    for _ in range(200):
        try:
            velocity = pink.solve_ik(posture, [task], 0.01, solver="daqp")
        except pink.exceptions.NotWithinConfigurationLimits as error:
            return float(posture.q[0]), str(error).splitlines()[0]
        posture.integrate_inplace(velocity, 0.01)
    return float(posture.q[0]), "nothing"


print(*(f"{name} {version(name)}" for name in ("pin", "pin-pink")), "- a target 3 m ahead")
came = {}
for name, model in (
    ("MJCF", pinocchio.buildModelFromMJCF("walker.xml")),
    ("URDF", pinocchio.buildModelFromUrdf("walker.urdf", pinocchio.JointModelFreeFlyer())),
    ("MJCF, freed", freed(pinocchio.buildModelFromMJCF("walker.xml"))),
):
    came[name], stopped = walk(model)
    limit = model.upperPositionLimit[0]
    print(f"{name:11s}: upper limit of x {limit:.3g}; came {came[name]:.2f} m far, stopped by: {stopped}")
if not 1.01 <= came["MJCF"] < 1.3 or min(came["URDF"], came["MJCF, freed"]) < 2.9:
    raise SystemExit("CHANGED: the root of an MJCF has no limits of place, or that of a URDF has some")
PY
