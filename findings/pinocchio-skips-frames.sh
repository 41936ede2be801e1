#!/usr/bin/env bash
# Pinocchio loads an MJCF character without the limbs that stand in a <frame>.
#
# Expected: a reader of MJCF that does not know <frame>, MuJoCo's way to move a group of elements, refuses the file.
# Happens: it goes through a body and takes what it knows; a <frame> and all in it is passed over in silence. An arm in a
#   frame is gone, joints and mass included, and a geom in a frame is missing from its body's mass: 33 kg instead of 47.
#   Only a frame round the root body ends in an error.
# Seen with: pin 4.1.0, mujoco 4.0.0.
# Means: a model with one limb in a frame has fewer joints, which someone notices; one with geoms in a frame has the right nq
#   and wrong masses: gravity compensation, centre of mass and momentum are those of a lighter person. MuJoCo
#   keeps frames when it saves (MjSpec.to_xml), so a saved copy is no cure: write the pose into the elements, and compare
#   the total mass.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0 mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import mujoco
import pinocchio

LIMB = '<body name="arm"><joint name="shoulder" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0 0 -.6" size=".04"/></body>'
TEXT = """<mujoco model="person"><worldbody><body name="trunk"><joint name="hip" axis="0 1 0"/>
<geom type="capsule" fromto="0 0 0 0 0 .5" size=".12"/>{}</body></worldbody></mujoco>"""
MODELS = {
    "no frame": TEXT.format(LIMB),
    "arm in a frame": TEXT.format(f'<frame pos="0 .2 .5" euler="30 0 0">{LIMB}</frame>'),
    "belly in a frame": TEXT.format(f'<frame pos=".05 0 .2"><geom size=".15"/></frame>{LIMB}'),
}


def by_pinocchio(text):
    with open("person.xml", "w") as file:
        file.write(text)
    model = pinocchio.buildModelFromMJCF("person.xml")
    return model.nq, pinocchio.computeTotalMass(model)


print("pin", pinocchio.__version__, "mujoco", mujoco.__version__, "- joints and mass in kg")
agree = []
for name, text in MODELS.items():
    spec = mujoco.MjSpec.from_string(text)
    model = spec.compile()
    expected = model.nq, float(model.body_mass.sum())
    for label, given in (("as written", text), ("as saved", spec.to_xml())):
        got = by_pinocchio(given)
        agree.append(got[0] == expected[0] and abs(got[1] - expected[1]) < 0.01)
        print(f"{name:16s} {label:10s}: MuJoCo {expected[0]}, {expected[1]:5.2f}; Pinocchio {got[0]}, {got[1]:5.2f}")
if agree != [True, True, False, False, False, False]:
    raise SystemExit("CHANGED: Pinocchio reads what stands in a frame, or MuJoCo resolves frames when it saves")
PY
