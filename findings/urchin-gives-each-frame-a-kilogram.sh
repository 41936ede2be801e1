#!/usr/bin/env bash
# Load a URDF with urchin and save it: each link that was there as a mere frame weighs 1 kg, with moments of inertia of 1 kg m2.
#
# Expected: a link without <inertial> has no mass, the format's documentation says; marks for sensors, soles and joint centres are written so. Loading and
#   saving keeps that, as urdf_parser_py does.
# Happens: urchin gives such a link an inertia of 1 kg and 1 kg m2 about each axis when it reads it, and writes it out on save(). A leg of 11 kg with a sole, an
#   ankle marker and an IMU comes back as one of 14 kg, and its knee has 3.5 kg m2 to turn in place of 0.15. Nothing is said. Joints, axes,
#   limits and shapes come back as they were.
# Seen with: urchin 0.0.30 (the successor of urdfpy), urdf_parser_py 0.0.4 and Pinocchio (pin 4.1.0) for comparison. Issue 19 of urdf-modifiers tells of the same,
#   by urdfpy. PyBullet takes 1 kg on reading, too, and says so.
# Means: urchin is what scripts change models with: longer legs, another foot. What they write looks right and moves in treacle; its controller needs
#   torques of another body. Set the inertial of such links to one with mass 0 and inertia 0 before saving, and compare total masses.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check urchin==0.0.30 urdf-parser-py==0.0.4 pin==4.1.0 numpy==2.4.6
cd "$work"
cat > leg.urdf <<'URDF'
<robot name="leg">
  <link name="thigh">
    <inertial><origin xyz="0 0 -0.2"/><mass value="8"/><inertia ixx="0.13" ixy="0" ixz="0" iyy="0.13" iyz="0" izz="0.03"/></inertial>
  </link>
  <link name="shin">
    <inertial><origin xyz="0 0 -0.18"/><mass value="3"/><inertia ixx="0.05" ixy="0" ixz="0" iyy="0.05" iyz="0" izz="0.006"/></inertial>
  </link>
  <link name="imu"/>
  <link name="ankle_marker"/>
  <link name="sole"/>
  <joint name="knee" type="revolute">
    <parent link="thigh"/><child link="shin"/><origin xyz="0 0 -0.42"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="2.6" effort="200" velocity="15"/>
  </joint>
  <joint name="imu_mount" type="fixed"><parent link="shin"/><child link="imu"/><origin xyz="0.05 0 -0.1"/></joint>
  <joint name="marker_mount" type="fixed"><parent link="shin"/><child link="ankle_marker"/><origin xyz="0 0.05 -0.4"/></joint>
  <joint name="sole_mount" type="fixed"><parent link="shin"/><child link="sole"/><origin xyz="0 0 -0.45"/></joint>
</robot>
URDF
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pinocchio
import urchin
from urdf_parser_py.urdf import URDF

urchin.URDF.load("leg.urdf").save("by_urchin.urdf")
Path("by_urdf_parser_py.urdf").write_text(URDF.from_xml_file("leg.urdf").to_xml_string())
cured = urchin.URDF.load("leg.urdf")
for name in ("imu", "ankle_marker", "sole"):
    cured.link_map[name].inertial = urchin.Inertial(mass=0.0, inertia=np.zeros((3, 3)))
cured.save("cured.urdf")
print("urchin", version("urchin"), "urdf_parser_py", version("urdf-parser-py"), "pin", version("pin"))
mass, knee = {}, {}
for name in ("leg", "by_urdf_parser_py", "cured", "by_urchin"):
    model = pinocchio.buildModelFromUrdf(f"{name}.urdf")
    mass[name] = sum(inertia.mass for inertia in model.inertias)  # the root, which is fixed here, counts as well
    knee[name] = float(pinocchio.crba(model, model.createData(), np.zeros(1))[0, 0])
    print(f"{name:18s} {mass[name]:5.2f} kg, moment of inertia about the knee {knee[name]:.4f} kg m2, limits {model.lowerPositionLimit} {model.upperPositionLimit}")
if any(abs(mass[name] - mass["leg"]) > 1e-9 or abs(knee[name] - knee["leg"]) > 1e-9 for name in ("by_urdf_parser_py", "cured")):
    raise SystemExit("CHANGED: the others do not keep the masses")
frames = sum(1.0 + float(np.sum(np.square(place))) for place in ((0.05, 0.1), (0.4,), (0.45,)))  # 1 kg m2 each, and 1 kg at its distance from the knee's axis
if abs(mass["by_urchin"] - mass["leg"] - 3) > 1e-9 or abs(knee["by_urchin"] - knee["leg"] - frames) > 1e-6:
    raise SystemExit("CHANGED: frames no longer weigh a kilogram")
PY
