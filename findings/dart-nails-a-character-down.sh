#!/usr/bin/env bash
# An MJCF character whose root is a <freejoint/> hangs in the air for ever in DART.
#
# Expected: <freejoint/> is MJCF's short form of <joint type="free"/>, and the form that current models use: the character
#   has six degrees of freedom more than its hinges, and falls.
# Happens: DART's parser overlooks the element and welds the root to the world, without a word: after half a second of
#   gravity the trunk is where it was. With <joint type="free"/> written out it falls 1.23 m in the same time.
# Seen with: dartpy 6.20.0, by MjcfParser.readWorld.
# Means: write the long form in models for DART, or count the degrees of freedom after loading (getNumDofs).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check dartpy==6.20.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version
from pathlib import Path

import dartpy

MODEL = """<mujoco><worldbody><body name="trunk" pos="0 0 2">%s<geom type="box" size="0.15 0.1 0.3" mass="30"/>
  <body name="thigh" pos="0 0 -0.3"><joint name="hip" axis="0 1 0"/><geom type="sphere" size="0.1" mass="8"/></body>
</body></worldbody></mujoco>"""

print("dartpy", version("dartpy"), "- half a second of free fall")
fell = {}
for root in ("<freejoint/>", '<joint type="free"/>'):
    path = Path("model.xml").absolute()
    path.write_text(MODEL % root)
    world = dartpy.utils.MjcfParser.readWorld(str(path))
    world.setGravity([0, 0, -9.81])
    body = world.getSkeleton(0)
    trunk = body.getBodyNode("trunk")
    before = trunk.getWorldTransform().translation()[2]
    for _ in range(round(0.5 / world.getTimeStep())):
        world.step()
    fell[root] = before - trunk.getWorldTransform().translation()[2]
    print(f"{root:22s} {body.getNumDofs()} degrees of freedom, {type(body.getJoint(0)).__name__:10s} fell {fell[root]:.3f} m")
if fell["<freejoint/>"] != 0.0 or abs(fell['<joint type="free"/>'] - 1.2287) > 1e-3:
    raise SystemExit("CHANGED: a freejoint is one")
PY
