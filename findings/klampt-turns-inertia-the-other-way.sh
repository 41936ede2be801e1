#!/usr/bin/env bash
# A limb whose URDF gives its moments of inertia in axes turned by 30 degrees has them turned by -30 degrees in Klamp't.
#
# Expected: rpy of an <inertial> says how the axes of the moments of inertia stand in the link: I = R I' R^T. A loader does that, or ignores it,
#   which is soon seen.
# Happens: Klamp't computes R^T I' R. Without a turn, and with a half or a quarter about a main axis, there is no difference, which is what
#   a loader is tried with first. Mass, centre and main moments are right, and so are kinematics and gravity; the mass matrix is not. With
#   moments of 1, 2 and 2.5 kg m2 turned by 30 degrees about z the product of inertia of 0.43 kg m2 has the wrong sign, and the limb
#   resists turning about the bisector of x and y with 1.93 kg m2 in place of 1.07.
# Seen with: klampt 0.10.1.post1; Pinocchio (pin 4.1.0) has R I' R^T.
# Means: a limb that lies obliquely in its link has such axes, and converters that take the main moments from a mesh write them. The torque to swing it
#   is off while standing still looks right. Write the six numbers in the axes of the link, with rpy 0.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check klampt==0.10.1.post1 pin==4.1.0 scipy==1.17.1 numpy==2.4.6
cd "$work"
cat > look.py <<'PY'
from importlib.metadata import version

import numpy as np
import pinocchio
from klampt import WorldModel
from scipy.spatial.transform import Rotation

OBLIQUE = np.array([1.0, 1.0, 0.0]) / np.sqrt(2.0)  # axis of the hinge
MAIN = np.diag([1.0, 2.0, 2.5])
LINK = '<link name="{}"><inertial><origin xyz="0 0 -0.2" rpy="{} {} {}"/><mass value="3"/><inertia ixx="1" iyy="2" izz="2.5" ixy="0" ixz="0" iyz="0"/></inertial></link>'


def inertia(rpy):
    """Of the limb about its centre: as URDF has it, in Pinocchio and in Klamp't; and the entry of the mass matrix of both."""
    text = f'''<robot name="two">{LINK.format("trunk", 0, 0, 0)}{LINK.format("limb", *rpy)}
        <joint name="hinge" type="continuous"><parent link="trunk"/><child link="limb"/><origin xyz="0 0 0" rpy="0 0 0"/>
        <axis xyz="{OBLIQUE[0]} {OBLIQUE[1]} 0"/></joint></robot>'''
    with open("two.urdf", "w") as file:
        file.write(text)
    world = WorldModel()
    world.readFile("two.urdf")
    limb = world.robot(0).link("limb")
    model = pinocchio.buildModelFromXML(text)
    axes = Rotation.from_euler("xyz", rpy).as_matrix()
    return (
        axes @ MAIN @ axes.T,
        model.inertias[1].inertia,
        np.reshape(limb.getMass().getInertia(), (3, 3)),
        pinocchio.crba(model, model.createData(), pinocchio.neutral(model))[0, 0],
        np.array(world.robot(0).getMassMatrix())[limb.getIndex(), limb.getIndex()],
    )


print("klampt", version("klampt"), "pin", version("pin"))
for name, rpy in {"no turn": (0, 0, 0), "a quarter": (0, 0, np.pi / 2), "30 degrees": (0, 0, np.pi / 6), "oblique": (0.5, -0.4, 0.7)}.items():
    urdf, pin, klampt, pin_mass, klampt_mass = inertia(rpy)
    axes = Rotation.from_euler("xyz", rpy).as_matrix()
    about = OBLIQUE @ urdf @ OBLIQUE, OBLIQUE @ klampt @ OBLIQUE
    print(f"{name:10s}: Ixy {urdf[0, 1]:6.3f} in URDF, {pin[0, 1]:6.3f} in Pinocchio, {klampt[0, 1]:6.3f} in Klamp't; "
          f"about the hinge {about[0]:.3f} and {about[1]:.3f}; mass matrix {pin_mass:.3f} and {klampt_mass:.3f}")
    if np.abs(pin - urdf).max() > 1e-9:
        raise SystemExit("CHANGED: Pinocchio no longer agrees with URDF")
    if np.abs(klampt - axes.T @ MAIN @ axes).max() > 1e-9 or abs(klampt_mass - pin_mass - (about[1] - about[0])) > 1e-6:
        raise SystemExit("CHANGED: Klamp't no longer turns the other way")
if abs(klampt_mass - pin_mass) < 0.1:
    raise SystemExit("CHANGED: the mass matrices agree")
PY
"$work/venv/bin/python" -W ignore look.py | grep -v -e URDFParser -e WorldModel
