#!/usr/bin/env bash
# Asked to turn a joint by 30 degrees more, in every frame, bvhtoolbox turns it by 30 to 156 degrees, differently in each frame.
#
# Expected: an offset of 30 degrees in one channel is one and the same turn of 30 degrees, before or after what the joint does in each frame. add_angle_offsets
#   takes Euler angles in the channels' order, goes through quaternions and writes angles in that order again.
# Happens: it takes the three angles for turns about fixed axes in the order of the channels, which is the reverse product of what BVH says, multiplies, and takes
#   the product apart in the same wrong order. The written angles are valid ones of another motion. An offset in the first channel is right, and so is
#   any at the rest pose, or where the joint turns about that one axis only, which is what one tries first; no offset gives the clip back.
# Seen with: bvhtoolbox 0.1.3 (manipulate.offsetjointangles, command bvhoffsetjointangles), scipy 1.17.1 for comparison. bvh2csv of the same
#   package reads BVH's order rightly.
# Means: it is there to bring a skeleton's rest pose to another's, T to A. The rest pose comes out right and the moving limbs do not: 41 degrees off for an
#   arm that is turned by 20, 40 and -30 degrees. Multiply scipy's Rotation.from_euler with the channel's letters in upper case.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check bvhtoolbox==0.1.3 transforms3d==0.4.2 scipy==1.17.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from bvhtoolbox import BvhTree
from bvhtoolbox.manipulate.offsetjointangles import add_angle_offsets
from scipy.spatial.transform import Rotation

CLIP = """HIERARCHY
ROOT chest
{{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT arm
  {{
    OFFSET 20 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {{
      OFFSET 60 0 0
    }}
  }}
}}
MOTION
Frames: {frames}
Frame Time: 0.04
{rows}
"""


def offset(angles, more):
    """The arm's attitudes before and after, from channels Z, X and Y in degrees."""
    tree = BvhTree(CLIP.format(frames=len(angles), rows="\n".join("0 100 0 0 0 0 " + " ".join(map(str, row)) for row in angles)))
    add_angle_offsets(tree, {"arm": more})
    written = np.array(tree.frames, dtype=float)[:, 6:9]
    return Rotation.from_euler("ZXY", angles, degrees=True), Rotation.from_euler("ZXY", written, degrees=True)


FRAMES = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 70.0], [20.0, 40.0, -30.0], [-60.0, 70.0, 50.0], [45.0, -75.0, -60.0]])
print("bvhtoolbox", version("bvhtoolbox"), "scipy", version("scipy"))
worst = 0.0
for more in ((30.0, 0.0, 0.0), (0.0, 30.0, 0.0), (0.0, 0.0, 30.0)):
    before, after = offset(FRAMES, more)
    wanted = Rotation.from_euler("ZXY", more, degrees=True)
    by = np.degrees((after * before.inv()).magnitude())
    off = np.degrees([np.minimum((after * (before * wanted).inv()).magnitude(), (after * (wanted * before).inv()).magnitude())]).ravel()
    worst = max(worst, off.max())
    print(f"offset {more}: turned by {by.round(1)}, off by {off.round(1)} from the nearer of both products")
    if by[0] < 29.99 or by[0] > 30.01 or off[0] > 1e-3:
        raise SystemExit("CHANGED: the rest pose is no longer right")
one_axis = offset(np.array([[0.0, 0.0, a] for a in (10.0, 60.0, -80.0)]), (0.0, 0.0, 30.0))
unchanged = offset(FRAMES, (0.0, 0.0, 0.0))
print(f"about one axis throughout: turned by {np.degrees((one_axis[1] * one_axis[0].inv()).magnitude()).round(3)}; worst of all {worst:.1f} degrees")
if np.degrees((unchanged[1] * unchanged[0].inv()).magnitude()).max() > 1e-3 or abs(np.degrees((one_axis[1] * one_axis[0].inv()).magnitude()) - 30).max() > 1e-3:
    raise SystemExit("CHANGED: a single axis, or no offset, is no longer right")
if worst < 30:
    raise SystemExit("CHANGED: offsets are turned rightly")
PY
