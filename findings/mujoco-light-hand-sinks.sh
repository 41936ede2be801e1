#!/usr/bin/env bash
# In MuJoCo a heavy body that leans on a light hand pushes the hand through the floor.
#
# Expected: the default contact yields by a fraction of a millimetre under a resting body, as it does for one heavy
#   ball; a stiff arm that carries the same weight should press its hand in about as far.
# Happens: 60 kg on a stiff arm press a hand of 0.4 kg 10 mm into the floor and one of 0.05 kg 79 mm, more than its own
#   diameter, at rest, without a warning. The same 60 kg in one piece with the hand: 0.14 mm.
# Seen with: mujoco 4.0.0, defaults. A contact's compliance is set from the inverse mass of the two bodies that touch
#   (mjModel.body_invweight0), not from what they carry: the depth grows as load over hand mass.
# Means: contact heights, and lever arms with them, depend on how mass is shared out along a limb. Splitting a foot
#   into light toes, or a hand off its forearm, makes the same floor several times softer.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import mujoco

RADIUS = 0.03
SERVO = '<joint name="reach" type="slide" axis="0 0 1"/>'
MODEL = """<mujoco><option timestep="0.001"/><worldbody><geom type="plane" size="2 2 1"/>
<body pos="0 0 .6"><joint type="slide" axis="0 0 1"/><geom type="sphere" size=".15" mass="60"/>
<body pos="0 0 -.2">{joint}<geom type="capsule" fromto="0 0 0 0 0 -.3" size=".03" mass="{hand}"/></body></body></worldbody>
{actuator}</mujoco>"""
ARM = '<actuator><position joint="reach" kp="40000" kv="600"/></actuator>'


def depth(hand, joint, actuator):
    """Depth in metres and speed in m/s after 10 s."""
    model = mujoco.MjModel.from_xml_string(MODEL.format(hand=hand, joint=joint, actuator=actuator))
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 10000)
    assert not any(warning.number for warning in data.warning), "the simulation warned"
    return -min(contact.dist for contact in data.contact), float(abs(data.qvel).max())


print("mujoco", mujoco.__version__, "- depth of a hand of 3 cm radius under 60 kg, after 10 s")
rigid, _ = depth(0.4, "", "")
print(f"rigid with the body     {1000 * rigid:7.2f} mm")
deep = {}
for hand in (4.0, 0.4, 0.05):
    deep[hand], speed = depth(hand, SERVO, ARM)
    print(f"stiff arm, {hand:4.2f} kg hand {1000 * deep[hand]:7.2f} mm = {deep[hand] / RADIUS:.2f} radii, moving at {speed:.0e} m/s")
if not (rigid < 0.0005 and 0.0005 < deep[4.0] < 0.002 and 0.007 < deep[0.4] < 0.013 and deep[0.05] > 2 * RADIUS):
    raise SystemExit("CHANGED: the depth no longer grows as the hand gets lighter")
PY
