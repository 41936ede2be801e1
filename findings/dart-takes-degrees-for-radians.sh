#!/usr/bin/env bash
# Limits of an MJCF joint reach DART 57 times too wide: an elbow of 145 degrees may turn 23 times round.
#
# Expected: MJCF's ranges of hinges are degrees unless the compiler says radian; the parser turns them into the library's
#   radians, as it does with the euler angles of the same file.
# Happens: the number in the file becomes a limit in radians, with angle="degree" written out as well as without. Euler
#   angles of that file are understood as degrees. Only with angle="radian" are both right.
# Seen with: dartpy 6.20.0, by MjcfParser.readWorld.
# Means: nothing looks wrong until a limb folds through the trunk. Save the model in radians (MuJoCo's own mj_saveLastXML
#   does) before DART reads it.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check dartpy==6.20.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math
from importlib.metadata import version
from pathlib import Path

import dartpy

MODEL = """<mujoco>%s<worldbody><body name="arm" pos="0 0 1"><geom size="0.1" mass="2"/>
  <body name="forearm" pos="0 0 0.3" euler="%s 0 0"><joint name="elbow" axis="0 1 0" range="%s" limited="true"/>
  <geom size="0.1" mass="1"/></body></body></worldbody></mujoco>"""
DEGREES = ("90", "0 145")
RADIANS = (f"{math.pi / 2}", f"0 {math.radians(145)}")

print("dartpy", version("dartpy"), "- an elbow from 0 to 145 degrees, its forearm drawn at a right angle")
found = {}
for compiler, numbers in (("", DEGREES), ('<compiler angle="degree"/>', DEGREES), ('<compiler angle="radian"/>', RADIANS)):
    path = Path("model.xml").absolute()
    path.write_text(MODEL % (compiler, *numbers))
    body = dartpy.utils.MjcfParser.readWorld(str(path)).getSkeleton(0)
    elbow = body.getJoint("elbow")
    upright = body.getBodyNode("forearm").getWorldTransform().rotation()[2][2]  # 0 at a right angle
    found[compiler] = math.degrees(elbow.getPositionUpperLimit(0))
    print(f"{compiler or '(no compiler element)':27s} upper limit {found[compiler]:8.1f} degrees; forearm at {math.degrees(math.acos(upright)):.1f}")
wide = math.degrees(145)
if not all(math.isclose(a, b, rel_tol=1e-5) for a, b in zip(found.values(), (wide, wide, 145.0), strict=True)):
    raise SystemExit("CHANGED: degrees are degrees")
PY
