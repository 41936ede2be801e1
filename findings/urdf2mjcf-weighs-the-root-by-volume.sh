#!/usr/bin/env bash
# A pelvis of 8 kg weighs 19 kg after urdf2mjcf; thigh and shin are right.
#
# Expected: a converter from URDF to MJCF keeps mass, centre and inertia of each link, which stand in its <inertial> and need no
#   computing; where it drops something it says so, as this one does of entries beside the diagonal.
# Happens: every link but the root keeps them. The root's <inertial> is not written, so that MuJoCo makes one up from its geoms: their
#   volume times 1000 kg/m3, and the visual ones count with the collision ones. Without a visual shape it is 9.6 kg, and without any
#   shape the file does not load. Nothing is said.
# Seen with: urdf2mjcf 0.2.39, a root that is no joint's child; mujoco 4.0.0 reads the result and, for comparison, the URDF itself,
#   with a link over the root, as it takes the root for the ground.
# Means: the pelvis of a legged robot is its heaviest part. It needs more to stand, lands harder, and turns slower in the air; a
#   picture shows nothing. Compare masses link by link, or put an empty link over the root.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check urdf2mjcf==0.2.39 mujoco==4.0.0 numpy==2.4.6
cd "$work"
PATH="$work/venv/bin:$PATH" "$work/venv/bin/python" - <<'PY'
import subprocess
from pathlib import Path

import mujoco

WEIGHS = {"pelvis": 8.0, "thigh": 5.0, "shin": 3.0}  # [kg]
BOX = '<{0}><geometry><box size="{1}"/></geometry></{0}>'
SIZES = {"pelvis": "0.24 0.25 0.16", "thigh": "0.12 0.12 0.4", "shin": "0.1 0.1 0.4"}  # [m]
HINGE = (
    '<joint name="{1}_hinge" type="revolute"><parent link="{0}"/><child link="{1}"/><origin xyz="0 0 -0.4"/>'
    '<axis xyz="0 1 0"/><limit lower="-1" upper="2" effort="100" velocity="10"/></joint>'
)
OVER = '<link name="over"/><joint name="to_root" type="floating"><parent link="over"/><child link="pelvis"/></joint>'


def robot(shapes, over=""):
    """A leg as URDF, with these kinds of shape."""
    links = [
        f'<link name="{name}"><inertial><origin xyz="0 0 0"/><mass value="{mass}"/>'
        '<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.05"/></inertial>'
        + "".join(BOX.format(kind, SIZES[name]) for kind in shapes) + "</link>"
        for name, mass in WEIGHS.items()
    ]
    return f'<robot name="leg">{over}{"".join(links)}{HINGE.format("pelvis", "thigh")}{HINGE.format("thigh", "shin")}</robot>'


def masses(model):
    """Of the links [kg]."""
    return [round(float(model.body(name).mass[0]), 3) for name in WEIGHS]


def converted(shapes):
    """The same after urdf2mjcf."""
    Path("leg.urdf").write_text(robot(shapes))
    done = subprocess.run(["urdf2mjcf", "leg.urdf", "--output", "leg.xml"], check=True, capture_output=True, text=True)
    assert "inertia" not in done.stdout + done.stderr and "mass" not in done.stdout + done.stderr
    return masses(mujoco.MjModel.from_xml_path("leg.xml"))


print("links [kg]", WEIGHS)
itself = masses(mujoco.MjModel.from_xml_string(robot(["collision"], OVER)))
found = {shapes: converted(shapes) for shapes in (("collision",), ("collision", "visual"))}
print("MuJoCo, the URDF itself", itself)
for shapes, each in found.items():
    print("urdf2mjcf,", " and ".join(shapes), each)
volume = 1000.0 * 0.24 * 0.25 * 0.16
right = list(WEIGHS.values())
if itself != right or [each for each in found.values()] != [[round(n * volume, 3), *right[1:]] for n in (1, 2)]:
    raise SystemExit("CHANGED: the root weighs what its file says, or another thing")
PY
