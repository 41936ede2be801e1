#!/usr/bin/env bash
# A somersault in the air of PyBullet loses two fifths of its spin in a jump from 10 m, and falls at 11 m/s in place of 14.
#
# Expected: between take-off and landing nothing acts but gravity. PyBullet tells of a linearDamping and an angularDamping of
#   0.04, which its users take for rates: 4 % a second, 6 % on the way down from a platform.
# Happens: of whatever loadURDF makes the damping grows with speed, 0.04 (1 + |v|) and 0.04 (1 + |w|) a second, in m/s and rad/s:
#   at 9 rad/s 40 % of the spin a second. 1.43 s after it was let go a body has 5.7 rad/s left of 9 and has fallen 8.8 m at
#   10.9 m/s where it is 10 m at 14.0. The step plays no part. Loaded with useMaximalCoordinates=1 nothing is damped.
# Seen with: pybullet 3.2.7.
# Means: flips and dives that are learnt or tuned there need more spin than anywhere else, and land late; compared with another
#   simulator it looks as if inertia were wrong. changeDynamics(body, link, linearDamping=0, angularDamping=0) takes it away.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pybullet==3.2.7 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import pybullet

BODY = """<robot name="body"><link name="trunk"><inertial><mass value="8"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size=".1 .2 .4"/></geometry></collision></link></robot>"""
GRAVITY, FALL, SPIN, DAMPING = 9.81, 10.0, 9.0, 0.04
TIME = (2 * FALL / GRAVITY) ** 0.5
with open("body.urdf", "w") as file:
    file.write(BODY)
pybullet.connect(pybullet.DIRECT)


def fall(step=1e-3, damped=True, **loading):
    """Metres fallen, speed and spin after the time of a fall of 10 m without air."""
    pybullet.resetSimulation()
    pybullet.setTimeStep(step)
    pybullet.setGravity(0, 0, -GRAVITY)
    body = pybullet.loadURDF("body.urdf", [0, 0, 50], **loading)
    if not damped:
        pybullet.changeDynamics(body, -1, linearDamping=0, angularDamping=0)
    pybullet.resetBaseVelocity(body, [0, 0, 0], [0, 0, SPIN])
    for _ in range(round(TIME / step)):
        pybullet.stepSimulation()
    velocity, spin = pybullet.getBaseVelocity(body)
    return 50 - pybullet.getBasePositionAndOrientation(body)[0][2], -velocity[2], spin[2]


def reckoned(step=1e-4):
    """Speed and spin by damping that grows with both."""
    speed, spin = 0.0, SPIN
    for _ in range(round(TIME / step)):
        speed += step * (GRAVITY - DAMPING * (1 + speed) * speed)
        spin -= step * DAMPING * (1 + spin) * spin
    return speed, spin


print("pybullet", version("pybullet"))
seen = {"as it comes": fall(), "step of 1/240 s": fall(1 / 240), "damping 0": fall(damped=False),
        "maximal coordinates": fall(useMaximalCoordinates=1)}
for name, (fallen, speed, spin) in seen.items():
    print(f"{name:20s} after {TIME:.2f} s fallen {fallen:5.2f} m, {speed:5.2f} m/s, {spin:4.2f} rad/s")
speed, spin = reckoned()
print(f"0.04 (1 + v) and (1 + w) a second give        {speed:5.2f} m/s, {spin:4.2f} rad/s")
free = GRAVITY * TIME
thick = [s for s in seen.values() if abs(s[1] - speed) < 0.1 and abs(s[2] - spin) < 0.1]
thin = [s for s in seen.values() if abs(s[1] - free) < 0.1 and abs(s[2] - SPIN) < 0.01]
if len(thick) != 2 or len(thin) != 2:
    raise SystemExit("CHANGED: other air")
PY
