#!/usr/bin/env bash
# From centimetres to metres by bvh2csv -s 0.01, the hips of a standing person are at 0.9 m, the chest at 0.21 m and the head at 0.15 m.
#
# Expected: the scale is a "factor for root position and offset values": all positions that are written are those without it, times the factor.
# Happens: each joint's place is scaled after its parent's scaled one has been added to its own offset, and the parent's part is so scaled again, once for every joint
#   between. With 0.01 only the root is right; the chest hangs 21 cm above the origin and the head 15 cm, wherever the person is. With 100 the head is
#   7000 times too high. With 1 all is right, and so are rotations.
# Seen with: bvhtoolbox 0.1.3 (bvh2csv, write_joint_positions), whose help proposes the scale for switching between centimetres and metres.
# Means: a picture shows it, and a table hardly does, as its first columns, the hips, are right. Speeds of limbs, contacts by height and the centre of
#   mass, which the table is for, are nonsense of a plausible size. Scale it afterwards.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check bvhtoolbox==0.1.3 transforms3d==0.4.2 numpy==2.4.6
cd "$work"
cat > clip.bvh <<'BVH'
HIERARCHY
ROOT hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT chest
  {
    OFFSET 0 20 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT head
    {
      OFFSET 0 15 0
      CHANNELS 3 Zrotation Xrotation Yrotation
      End Site
      {
        OFFSET 0 20 0
      }
    }
  }
}
MOTION
Frames: 3
Frame Time: 0.04
10 90 30 0 0 0 0 0 0 0 0 0
10 90 40 0 10 0 0 20 0 0 0 0
10 90 50 0 20 0 0 40 0 0 0 0
BVH
for scale in 1 0.01 100; do
  "$work/venv/bin/bvh2csv" --position --ends --scale "$scale" --out "by$scale" clip.bvh >bvh2csv.log || true # success is exit code 1 there
done
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np

SCALES = ("1", "0.01", "100")
places = {scale: np.genfromtxt(f"by{scale}/clip_pos.csv", delimiter=",", skip_header=1)[:, 1:].reshape(3, 4, 3) for scale in SCALES}  # frames, joints, xyz
upright = np.array([[10, 90, 30], [10, 110, 30], [10, 125, 30], [10, 145, 30]])
print("bvhtoolbox", version("bvhtoolbox"), "- heights of hips, chest, head and its end in the first frame")
for scale in SCALES:
    print(f"scale {scale:4s} written {places[scale][0, :, 1]}, expected {upright[:, 1] * float(scale)}")
if np.abs(places["1"][0] - upright).max() > 1e-4:
    raise SystemExit("CHANGED: positions are wrong without a scale, too")
for scale in SCALES[1:]:
    factor = float(scale)
    if np.abs(places[scale][:, 0] - factor * places["1"][:, 0]).max() > 1e-4 * factor:
        raise SystemExit("CHANGED: the root is no longer right")
    compounded = factor * places["1"][0, 0, 1]
    for joint, offset in enumerate((20, 15, 20), start=1):
        compounded = factor * (compounded + offset)
        if abs(places[scale][0, joint, 1] - compounded) > 1e-4 * max(1, compounded):
            raise SystemExit("CHANGED: the scale is no longer taken once more for each joint")
PY
