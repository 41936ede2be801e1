#!/usr/bin/env bash
# In Pinocchio a limb of an MJCF character that may touch nothing weighs nothing, and a character that is to weigh 70 kg as much as it likes.
#
# Expected: a body without <inertial> gets mass and inertia of its geoms, whatever they collide with (contype and conaffinity are about
#   contacts), and a compiler's settotalmass, which MuJoCo 4 still takes, scales all of them. What is not supported is said, as Drake does
#   of settotalmass.
# Happens: geoms with contype="0" conaffinity="0" are taken for pictures alone, also where each has a mass written: a shin of 3 kg weighs 0. A
#   body with both kinds weighs a part. settotalmass is passed over. Neither is told.
# Seen with: pin 4.1.0, buildModelFromMJCF; mujoco 4.0.0. Of gymnasium 1.4.0's models the swimmer weighs 0 for 106.8 kg, the pusher
#   0.2 for 13.7, the half cheetah 21.2 for 14.
# Means: limbs that pass through each other to save contacts are an everyday matter; inverse dynamics and the mass matrix of such a model are
#   another body's, or singular. Give each body its <inertial>, or compare computeTotalMass with MuJoCo's mj_getTotalmass.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import subprocess
import sys
from pathlib import Path

import mujoco
import numpy as np

LEG = """<mujoco model="leg"><compiler {compiler}/><worldbody><body name="pelvis" pos="0 0 1"><freejoint/>
  <geom type="sphere" size="0.1" mass="8"/>
  <body name="thigh"><joint name="hip" axis="0 1 0"/><geom type="capsule" size="0.06" fromto="0 0 0 0 0 -0.4" mass="4"/>
    <geom type="sphere" size="0.05" pos="0 0 -0.4" mass="1" {touches}/>
    <body name="shin" pos="0 0 -0.4"><joint name="knee" axis="0 1 0"/>
      <geom type="capsule" size="0.05" fromto="0 0 0 0 0 -0.4" mass="3" {touches}/></body></body></body></worldbody></mujoco>"""
NOTHING = 'contype="0" conaffinity="0"'


THEIRS = """
import numpy as np, pinocchio
model = pinocchio.buildModelFromMJCF("leg.xml")
upper = np.triu(pinocchio.crba(model, model.createData(), pinocchio.neutral(model)))
print(*(inertia.mass for inertia in model.inertias[1:]), np.linalg.eigvalsh(upper + np.triu(upper, 1).T).min())
"""


def masses(**said):
    """Of pelvis, thigh and shin [kg], by MuJoCo and by Pinocchio, and the mass matrix's least eigenvalue there."""
    text = LEG.format(**{"compiler": "", "touches": "", **said})
    Path("leg.xml").write_text(text)
    done = subprocess.run([sys.executable, "-c", THEIRS], check=True, capture_output=True, text=True)
    assert not done.stderr, done.stderr  # nothing is told
    *theirs, least = map(float, done.stdout.split())
    return mujoco.MjModel.from_xml_string(text).body_mass[1:].round(3).tolist(), np.round(theirs, 3).tolist(), least


found = {}
for name, said in (
    ("all collide", {}),
    ("knee and shin do not", {"touches": NOTHING}),
    ("to weigh 70 kg", {"compiler": 'settotalmass="70"'}),
):
    found[name] = masses(**said)
    print(f"{name:22s} MuJoCo {found[name][0]} kg, Pinocchio {found[name][1]} kg, least eigenvalue {found[name][2]:.1e}")
plain = [8.0, 5.0, 3.0]
expected = {"all collide": (plain, plain), "knee and shin do not": (plain, [8.0, 4.0, 0.0]), "to weigh 70 kg": ([35.0, 21.875, 13.125], plain)}
if {name: each[:2] for name, each in found.items()} != expected:
    raise SystemExit(f"CHANGED: {found}")
PY
