#!/usr/bin/env bash
# World positions by bvh-converter, of a BVH file whose joints all have places of their own in each frame: every joint lies at its OFFSET, with 0 in the hip.
#
# Expected: a joint with six channels is at the place that its frames give, as the root is. Exporters that write six for every joint leave OFFSET at 0, or let limbs stretch.
#   A converter to world positions uses the numbers, as it reads them, or refuses a file with such joints.
# Happens: only the root's places are used. Those of other joints are read, so that all later columns are right, and put aside: the joint is at its OFFSET. Where OFFSET is 0 a
#   leg of 0.8 m has hip, knee and ankle in one point, only an End Site sticks out; where OFFSET is the length at rest a shin that grows by 5 cm stays as it was. Rotations
#   are right. Nothing is said.
# Seen with: bvh-converter 1.0.2 (process_bvhfile, process_bvhkeyframe and the command), bvhio 1.5.4 beside it. Issue 121 of deep-motion-editing tells of files with OFFSET 0;
#   of this one none was found. Readers don't agree on whether such places come on top of OFFSET or instead of it; with OFFSET 0 both are one.
# Means: with OFFSET 0 one sees it. With the lengths at rest, and places that follow a real body by some centimetres, heights of hands and feet, contacts and the centre of mass
#   are off by those, and look right. Count the channels of a file first, and compare one ankle with another reader's.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check bvh-converter==1.0.2 bvhio==1.5.4 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import contextlib
import io
from importlib.metadata import version
from pathlib import Path

import bvhio
import numpy as np
from bvh_converter.bvhplayer_skeleton import process_bvhfile, process_bvhkeyframe

LEG = """HIERARCHY
ROOT hip
{
OFFSET 0 0 0
SIX
JOINT knee
{
OFFSET 0 REST 0
SIX
JOINT ankle
{
OFFSET 0 REST 0
SIX
End Site
{
OFFSET 0 0 0.2
}
}
}
}
MOTION
Frames: 1
Frame Time: 0.01
""".replace("SIX", "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation")
BEND = np.radians(30)  # of the hip, about x


def write(rest, knee, ankle):
    """A leg whose joints are at these heights from the one above, in the only frame, and at another one by OFFSET."""
    frame = [0, 1, 0, 0, 30, 0, 0, knee, 0, 0, 0, 0, 0, ankle, 0, 0, 0, 0]
    Path("leg.bvh").write_text(LEG.replace("REST", str(rest)) + " ".join(map(str, frame)) + "\n")


def converted():
    """Height of each joint, by bvh-converter."""
    with contextlib.redirect_stdout(io.StringIO()):
        skeleton = process_bvhfile("leg.bvh")
        process_bvhkeyframe(skeleton.keyframes[0], skeleton.root, 0)
        header, frames = skeleton.get_frames_worldpos(0)
    told = dict(zip(header, frames[0], strict=True))
    return np.array([told[f"{joint}.Y"] for joint in ("hip", "knee", "ankle")])


def beside():
    """The same by bvhio."""
    root = bvhio.readAsHierarchy("leg.bvh")
    root.loadPose(0)
    return np.array([joint.PositionWorld.y for joint, _, _ in root.layout()][:3])


print("bvh-converter", version("bvh-converter"), "bvhio", version("bvhio"), "- heights of hip, knee and ankle [m]")
rightly = 1 - np.array([0, 0.4, 0.8]) * np.cos(BEND)
for name, rest, knee, ankle in (("OFFSET 0", 0, -0.4, -0.4), ("OFFSET at rest", -0.4, -0.4, -0.45)):
    write(rest, knee, ankle)
    print(f"{name}: bvh-converter {converted().round(3)}, bvhio {beside().round(3)}")
    if rest == 0 and (np.abs(converted() - 1).max() > 1e-9 or np.abs(beside() - rightly).max() > 1e-5):
        raise SystemExit("CHANGED: places of joints are used, or bvhio leaves them out")
    if rest and np.abs(converted() - rightly).max() > 1e-9:
        raise SystemExit("CHANGED: joints are not at their OFFSET")
PY
