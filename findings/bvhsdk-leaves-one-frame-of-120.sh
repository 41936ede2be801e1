#!/usr/bin/env bash
# Down-sampled by bvhsdk from 120 to 30 frames a second, as its documentation proposes, a clip of any length has one frame; from 100 to 60 it runs faster.
#
# Expected: downSample(30) keeps every fourth frame of a clip at 120; where rates are not multiples it takes the nearest frame or interpolates, and
#   what took a second still takes one.
# Happens: it removes every nth frame, with n rounded to a whole number. To get rid of three frames of four n would be 1.33: it is 1, and all go but
#   the first. 100 to 60 removes every second one, which are 50 left, and says that they are 60 a second: all speeds are 1.2 times what they were.
#   120 to 50 leaves 60 at 50, slowed down. Only halving, as 120 to 60, is right; from 120 to 100 frames stand unevenly. It returns True throughout.
# Seen with: bvhsdk 0.2.1, anim.Animation.downSample.
# Means: one frame is noticed; speeds, flight times and angular momentum that are off by a fifth are not, as the frame rate in the file is the one asked for.
#   Take every kth frame oneself, or interpolate.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check bvhsdk==0.2.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import contextlib
import io
from importlib.metadata import version
from pathlib import Path

import bvhsdk

HIERARCHY = """HIERARCHY
ROOT Hips
{
\tOFFSET 0.0 0.0 0.0
\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
\tEnd Site
\t{
\t\tOFFSET 0.0 1.0 0.0
\t}
}
"""


def sampled(rate, target):
    """A clip of 2 s in which the hips move by 1 m/s: frames left, seconds they take, speed [m/s]."""
    frames = [f"0.0 {frame / rate:.6f} 0.0 0.0 0.0 0.0" for frame in range(2 * rate + 1)]
    Path("clip.bvh").write_text(f"{HIERARCHY}MOTION\nFrames: {len(frames)}\nFrame Time: {1 / rate:.8f}\n" + "\n".join(frames) + "\n")
    with contextlib.redirect_stdout(io.StringIO()):
        clip = bvhsdk.ReadFile("clip.bvh")
        if not clip.downSample(target):
            raise SystemExit("CHANGED: it refuses")
    height = clip.root.translation[:, 1]
    lasts = (clip.frames - 1) * clip.frametime
    return clip.frames, float(lasts), float((height[-1] - height[0]) / lasts) if lasts else 0.0


print("bvhsdk", version("bvhsdk"), "- proposes 120 to 30:", "120 fps to 30 fps" in bvhsdk.anim.Animation.downSample.__doc__)
found = {}
for rates in ((120, 60), (120, 30), (240, 60), (100, 25), (100, 60), (120, 50)):
    found[rates] = sampled(*rates)
    print("{} to {}: {} frames, {:.2f} s, {:.2f} m/s".format(*rates, *found[rates]))
if found[120, 60][0] != 121 or abs(found[120, 60][2] - 1) > 0.01:
    raise SystemExit("CHANGED: halving is not right either")
if any(found[rates][0] != 1 for rates in ((120, 30), (240, 60), (100, 25))) or not (found[100, 60][2] > 1.15 and found[120, 50][2] < 0.87):
    raise SystemExit("CHANGED: a quarter of the rate leaves more than one frame, or other rates keep the speed")
PY
