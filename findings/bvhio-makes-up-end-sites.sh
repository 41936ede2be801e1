#!/usr/bin/env bash
# Read a BVH file with bvhio and write it again: feet, hands and head have other lengths and directions.
#
# Expected: a library that reads and writes BVH keeps the skeleton, the offsets of the End Sites included; they are the
#   only place where the length of the last bones stands.
# Happens: an End Site is not carried into the hierarchy. On writing each gets a made-up one: straight along the bone
#   before it, 0.3 times as long. A foot that reached 16 cm forward reaches 12 cm further down the shin. All joints,
#   rotations and frames are kept.
# Seen with: bvhio 1.5.4, readAsHierarchy and writeHierarchy. readAsBvh and writeBvh, which keep the file's own layout, keep
#   the End Sites too.
# Means: a clip that was only cut or resampled no longer has the toes on the ground: contacts by the height of the end points,
#   and bone lengths for retargeting, are wrong by centimetres. Copy the End Sites over from the source.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check bvhio==1.5.4
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import bvhio

BVH = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Knee
  {
    OFFSET 0 -44 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT Ankle
    {
      OFFSET 0 -40 0
      CHANNELS 3 Zrotation Xrotation Yrotation
      End Site
      {
        OFFSET 0 -6 16
      }
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.01
0 90 0 0 10 0 0 -20 0 0 10 0
1 90 0 0 12 0 0 -24 0 0 12 0
"""
with open("walk.bvh", "w") as file:
    file.write(BVH)
bvhio.writeHierarchy("again.bvh", bvhio.readAsHierarchy("walk.bvh"), 0.01)
bvhio.writeBvh("plain.bvh", bvhio.readAsBvh("walk.bvh"))


def offsets(name):
    """Of each joint and of the end site, in centimetres."""
    with open(name) as file:
        return [[float(number) for number in line.split()[1:]] for line in file if line.split()[:1] == ["OFFSET"]]


def ankle_in_the_last_frame(name):
    root = bvhio.readAsHierarchy(name).loadPose(1)
    return [round(number, 3) for number in root.filter("Ankle")[0].PositionWorld]


print("bvhio", version("bvhio"))
before, after = offsets("walk.bvh"), offsets("again.bvh")
for name, old, new in zip(("hips", "knee", "ankle", "end site"), before, after, strict=True):
    print(f"{name:8s} read {old}, written {new}")
places = ankle_in_the_last_frame("walk.bvh"), ankle_in_the_last_frame("again.bvh")
print("the ankle in the last frame:", *places)
if after[:3] != before[:3] or places[0] != places[1]:
    raise SystemExit("CHANGED: joints and motion do not survive either")
if offsets("plain.bvh") != before:
    raise SystemExit("CHANGED: writeBvh does not keep the end site either")
if max(abs(new - made_up) for new, made_up in zip(after[3], (0, -12, 0), strict=True)) > 1e-6:
    raise SystemExit("CHANGED: the end site is kept, or made up in another way")
PY
