#!/usr/bin/env bash
# Pinocchio and MuJoCo number the joints of one URDF differently.
#
# Expected: both walk down the tree from the root, branches in the order of the file, so that q of one is q of the other.
# Happens: Pinocchio takes the branches in alphabetical order of the joints' names, MuJoCo in the file's. A file with the
#   right leg first has right, left in MuJoCo and left, right in Pinocchio; a vector handed over swaps the legs, and
#   all lengths fit.
# Seen with: pin 4.1.0, mujoco 4.0.0. The children of a link come out of a URDF parser that keeps joints by name.
# Means: map by name (model.idx_qs, jnt_qposadr), never by index. With mirrored legs in a symmetric pose mass, centre
#   of mass and gravity torques agree, so a test on the standing pose does not find it.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import mujoco
import pinocchio

LINK = """<link name="{0}"><inertial><mass value="1"/><origin xyz="0 0 -.1"/>
<inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
JOINT = """<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{2}"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="10" velocity="1"/></joint>"""
LINKS = ("pelvis", "right_thigh", "right_shin", "left_thigh", "left_shin")
JOINTS = (
    ("right_hip", "pelvis", "right_thigh"),
    ("right_knee", "right_thigh", "right_shin"),
    ("left_hip", "pelvis", "left_thigh"),
    ("left_knee", "left_thigh", "left_shin"),
)
text = '<robot name="legs">' + "".join(LINK.format(link) for link in LINKS) + "".join(JOINT.format(*j) for j in JOINTS) + "</robot>"
with open("legs.urdf", "w") as file:
    file.write(text)

simulated = mujoco.MjModel.from_xml_string(text)
analysed = pinocchio.buildModelFromUrdf("legs.urdf")
in_file = [joint[0] for joint in JOINTS]
in_mujoco = [simulated.joint(i).name for i in range(simulated.njnt)]
in_pinocchio = list(analysed.names)[1:]
print("pin", pinocchio.__version__, "mujoco", mujoco.__version__)
print("file      ", in_file)
print("MuJoCo    ", in_mujoco)
print("Pinocchio ", in_pinocchio)
if in_mujoco != in_file or in_pinocchio != ["left_hip", "left_knee", "right_hip", "right_knee"]:
    raise SystemExit("CHANGED: the orders of joints are no longer file order and alphabetical order")
PY
