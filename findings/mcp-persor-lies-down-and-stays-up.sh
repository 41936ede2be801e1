#!/usr/bin/env bash
# Lay a character down by turning its root: to mcp-persor the absolute place of its head is as high as when it stood.
#
# Expected: get_joint_motion_df of a joint has two modes, relative and absolute. The first are the channels of the BVH file; the second, which goes from the joint up to the root,
#   is where the joint is in the world and how it is turned there: each place is turned by the joints above before it is added, and turns follow one another.
# Happens: "absolute" adds up columns: the X places of all joints on the way to the root, the Y places, and likewise their Euler angles. A head 0.7 m above a root that lies on its
#   back at 0.1 m is told to be at 0.8 m, where it is at 0.1 m and 0.7 m behind. A root that turns by 90 degrees about y and a trunk that bends by 90 about x have a sum that
#   is 120 degrees off, as the file's order has x first. As long as nothing turns, all is right. Given back to set_joint_motion_df with mode="absolute", other
#   absolute places change nothing: its differences are between columns of two sets of names, so they are NaN, and those are passed over.
# Seen with: mcp-persor 1.0.6 (persor.py, its functions of absolute data), pandas 3.0.2, numpy 2.4.6, scipy 1.17.1. It is for files of the mocopi app, in which each joint has
#   places and turns; its docstrings say that these are absolute data of a joint, and no more.
# Means: heights of heads and hands are right for whoever stands upright, as in a first try, and wrong for each fall, roll and turn. Chain the rotations of the relative data along
#   get_skeleton_path2root with scipy.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check mcp-persor==1.0.6 pandas==3.0.2 matplotlib==3.11.2 numpy==2.4.6 scipy==1.17.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from mcp_persor import BVHparser
from scipy.spatial.transform import Rotation

PLACES, TURNS = ["Xposition", "Yposition", "Zposition"], ["Zrotation", "Xrotation", "Yrotation"]
CHANNELS = "CHANNELS 6 " + " ".join(PLACES + TURNS)
HIERARCHY = f"""HIERARCHY
ROOT root
{{
OFFSET 0 0 0
{CHANNELS}
JOINT trunk
{{
OFFSET 0 30 0
{CHANNELS}
JOINT head
{{
OFFSET 0 40 0
{CHANNELS}
End Site
{{
OFFSET 0 10 0
}}
}}
}}
}}
MOTION
"""
POSES = {  # place of the root [cm] and turns about z, x and y of root, trunk and head [deg]
    "stands": ([0, 90, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]),
    "stands elsewhere": ([50, 90, 20], [0, 0, 0], [0, 0, 0], [0, 0, 0]),
    "lies on its back": ([0, 10, 0], [0, -90, 0], [0, 0, 0], [0, 0, 0]),
    "lies, trunk turned": ([0, 10, 0], [0, -90, 0], [60, 0, 0], [0, 0, 45]),
    "turns and bends": ([0, 90, 0], [0, 0, 90], [0, 90, 0], [0, 0, 0]),
}
rows = [[*root, *first, 0, 30, 0, *second, 0, 40, 0, *third] for root, first, second, third in POSES.values()]
with open("clip.bvh", "w") as file:
    file.write(HIERARCHY + f"Frames: {len(rows)}\nFrame Time: 0.02\n" + "\n".join(" ".join(map(str, row)) for row in rows) + "\n")
clip = BVHparser("clip.bvh")
told = clip.get_joint_motion_df("head", mode="absolute")

print("mcp-persor", version("mcp-persor"), "- place of the head [cm] and its turns about z, x, y [deg]")
for row, (pose, (root, *turns)) in enumerate(POSES.items()):
    first, second, third = (Rotation.from_euler("ZXY", turn, degrees=True) for turn in turns)
    true = root + first.apply([0, 30, 0]) + (first * second).apply([0, 40, 0])
    place, angles = told.loc[row, PLACES].to_numpy(float), told.loc[row, TURNS].to_numpy(float)
    off = float(np.degrees((Rotation.from_euler("ZXY", angles, degrees=True) * (first * second * third).inv()).magnitude()))
    print(f"{pose}: told {place} and {angles}, is at {np.round(true, 1)}; the attitude told is off by {off:.0f} degrees")
    if np.abs(place - (np.array(root) + [0, 70, 0])).max() > 1e-9 or np.abs(angles - np.sum(turns, axis=0)).max() > 1e-9:
        raise SystemExit("CHANGED: it is not the sums of columns that are told")
    if pose.startswith("stands") != (np.abs(place - true).max() < 1e-9) or pose in ("lies, trunk turned", "turns and bends") and off < 45:
        raise SystemExit("CHANGED: other poses are right")

before = clip.get_motion_df()
wanted = told.copy()
wanted[PLACES] += 25.0
clip.set_joint_motion_df("head", wanted, mode="absolute")
changed = float((clip.get_motion_df() - before).abs().to_numpy().max())
relative = clip.get_joint_motion_df("head")
relative[PLACES] += 25.0
clip.set_joint_motion_df("head", relative, mode="relative")
moved = float((clip.get_motion_df() - before).abs().to_numpy().max())
print(f"head put 25 cm away: the file's numbers change by up to {changed} if absolute and {moved} if relative")
if changed != 0 or moved != 25:
    raise SystemExit("CHANGED: putting a joint to an absolute place does something, or to a relative one something else")
PY
