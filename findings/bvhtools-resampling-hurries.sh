#!/usr/bin/env bash
# bvhTools' resampleFPS makes the motion itself faster: what falls, falls under more than gravity.
#
# Expected: a clip of one second at 120 frames a second, resampled to 30, is the same motion looked at less often: a frame every
#   1/30 s, each as the body was at that time; the last moment may be cut off where no frame falls on it.
# Happens: the number of frames is scaled and rounded first, and these are then spread from the first frame to the last one. 121
#   frames, which are 120 intervals, become 30 and not 31, whose 29 intervals have to hold the whole second. All speeds are greater
#   by 30/29, accelerations by its square; the shorter the clip, the more: 25 frames turn at 108 degrees a second in place of 90.
#   Going up in rate slows the motion down likewise. Frame Time says the rate asked for all the same.
# Seen with: bvhtools 1.6.0 (bvhTools.bvhMotionEditor.resampleFPS).
# Means: whoever takes angular velocities, momentum or flight times from a resampled clip gets those of another motion, and two clips
#   of unlike lengths are hurried unlike. Interpolate at times of one's own, or take every nth frame.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps bvhtools==1.6.0 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from bvhTools.bvhIO import readBvh
from bvhTools.bvhMotionEditor import resampleFPS

G = 9.81  # m/s^2
HEAD = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  End Site
  {
    OFFSET 0 1 0
  }
}
MOTION
"""


def clip(frames, rate):
    """A body that falls from rest and turns about the vertical at 90 degrees a second."""
    times = np.arange(frames) / rate
    rows = [f"0 {-G / 2 * t * t:.6f} 0 0 0 {90 * t:.6f}" for t in times]
    with open("fall.bvh", "w") as file:
        file.write(HEAD + f"Frames: {frames}\nFrame Time: {1 / rate:.8f}\n" + "\n".join(rows) + "\n")
    return readBvh("fall.bvh")


def told(bvh):
    """Frames, gravity [m/s^2] and turning [deg/s] that a clip shows."""
    rows, step = np.array(bvh.motion.frames, float), bvh.motion.frameTime
    fall = np.diff(rows[:, 1], 2).mean() / step**2
    return len(rows), float(-fall.round(2)), float((np.diff(rows[:, 5]).mean() / step).round(1))


print("bvhtools", version("bvhtools"), "- a fall of 9.81 m/s^2 while turning at 90 deg/s; frames, and both as the clip shows them")
seen = {}
for frames, rate, to in ((121, 120, 30), (25, 120, 30), (121, 120, 40), (31, 30, 120)):
    before = clip(frames, rate)
    after = resampleFPS(before, to)
    seen[frames, rate, to] = told(before), told(after)
    print(f"{rate:3} to {to:3} a second:", *seen[frames, rate, to])
kept = [abs(after[1] - G) < 0.1 and abs(after[2] - 90) < 0.5 for _, after in seen.values()]
right = all(abs(before[1] - G) < 0.01 and before[2] == 90.0 for before, _ in seen.values())
if not right or any(kept) or seen[121, 120, 30][1][0] != 30:
    raise SystemExit("CHANGED: resampling keeps the motion's own time, or loses it otherwise")
PY
