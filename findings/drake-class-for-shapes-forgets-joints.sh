#!/usr/bin/env bash
# Put an MJCF leg into a default class that only sets the size of its shapes: in Drake its hinges turn about another axis.
#
# Expected: a default class within another starts from all that the outer one says and changes what it names, so MuJoCo's reference; a parser that has
#   nested classes, as Drake's has, passes on the rest.
# Happens: element by element: an inner class that has a <joint> inherits the outer one's joint, one that has none has none. Its joints are MuJoCo's
#   built-in ones: the axis is z in place of y, there is no damping and no limit, and no warning, where Drake warns of many a thing that it leaves out.
#   With an empty <joint/> in the inner class all is well.
# Seen with: drake 1.51.1, the last one for Python 3.11, mujoco 4.0.0. Newton had an issue of inner classes that inherited nothing (1206, closed).
# Means: "collision" and "visual", thick and thin limbs, left and right are classes of shapes within a class for the whole body, and as childclass they hold
#   for joints, too. Such a character stands like the right one and its knees twist. Compare axes, limits and damping joint by joint, or load a file
#   that MuJoCo has saved, in which nothing is left to defaults.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check drake==1.51.1 mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - 2>drake.log <<'PY' || { cat drake.log >&2; exit 1; }
from importlib.metadata import version
from pathlib import Path

import mujoco
import numpy as np
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant

LEG = """<mujoco model="leg"><compiler angle="radian"/><default><default class="human"><joint axis="0 1 0" damping="3" range="-2 .3"/>
<geom type="capsule" size=".07" density="700"/><default class="thin">{joint}<geom size=".04"/></default></default></default>
<worldbody><body name="leg" pos="0 0 1" childclass="{name}"><joint name="hip" frictionloss="1"/><geom fromto="0 0 0 0 0 -.8"/></body></worldbody></mujoco>"""


def hip(name, joint=""):
    """Axis, range and damping of the hip in MuJoCo and in Drake, and the mass of the leg in both."""
    xml = LEG.format(name=name, joint=joint)
    model = mujoco.MjModel.from_xml_string(xml)
    plant = MultibodyPlant(0.0)
    Parser(plant).AddModelsFromString(xml, "mujoco.xml")
    plant.Finalize()
    found = plant.GetJointByName("hip")
    drake = np.r_[found.revolute_axis(), found.position_lower_limits(), found.position_upper_limits(), found.default_damping()]
    return np.r_[model.jnt_axis[0], model.jnt_range[0], model.dof_damping], drake, model.body("leg").mass[0], plant.GetBodyByName("leg").default_mass()


print("drake", version("drake"), "mujoco", mujoco.__version__, "- axis, range and damping of the hip")
same = {}
for title, case in (("outer class", ("human",)), ("inner, without <joint>", ("thin",)), ("inner, empty <joint/>", ("thin", "<joint/>"))):
    here, drake, mass, seen = hip(*case)
    same[title] = bool(np.allclose(here, drake))
    print(f"{title:22s} MuJoCo {here}, Drake {drake}; mass {mass:.2f} and {seen:.2f} kg")
    if abs(mass - seen) > 1e-6 or not np.allclose(here, [0, 1, 0, -2, 0.3, 3]):
        raise SystemExit("CHANGED: shapes are not the same either, or MuJoCo's hip is another")
lost = hip("thin")[1]
if not same["outer class"] or not same["inner, empty <joint/>"] or not np.allclose(lost, [0, 0, 1, -np.inf, np.inf, 0]):
    raise SystemExit("CHANGED: an inner class without <joint> has the joint of the outer one, or others have not")
said = Path("drake.log").read_text().splitlines()
print("Drake warns of the dry friction that it leaves out:", len(said), "lines")
if not said or any("frictionloss" not in line for line in said):
    raise SystemExit("CHANGED: nothing is said of dry friction, or something of the joint")
PY
