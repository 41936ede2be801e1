#!/usr/bin/env bash
# Compare left and right of dm_control's humanoid: one hip bends ten degrees further than the other.
#
# Expected: the benchmark humanoid is its own mirror image, so that a policy, a pose or a recorded motion may be
#   mirrored to double the data, and one side may stand for both.
# Happens: left_hip_y goes from -120 to 20 degrees, right_hip_y from -110 to 20. Every other pair of joints, masses and
#   motors included, is the same. gymnasium's Humanoid, of the same descent, has -110 to 20 on both sides.
# Seen with: dm_control 1.0.50, suite/humanoid.xml (stand, walk, run).
# Means: a mirrored squat is no pose of the model (the stop holds it back), symmetry losses and mirrored replay buffers are
#   a little wrong where hips are bent most, and a gait that favours a side may have a reason in the file.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps dm_control==1.0.50
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

folder = Path(find_spec("dm_control").submodule_search_locations[0])
root = ElementTree.parse(folder / "suite" / "humanoid.xml").getroot()
joints = {joint.get("name"): joint for joint in root.iter("joint") if joint.get("name")}
print("dm_control", version("dm_control"))
unlike = []
for name, left in joints.items():
    if name.startswith("left_"):
        right = joints[name.replace("left_", "right_")]
        ranges = left.get("range"), right.get("range")
        low, high = ranges[1].split()
        # An axis may be written either way round: shoulders turn about opposite ones.
        alike = ranges[0] in (ranges[1], f"{-float(high):g} {-float(low):g}")
        print(f"{name[5:]:12s} left {ranges[0]:12s} right {ranges[1]:12s}", "" if alike else "<-")
        if not alike:
            unlike.append((name, *ranges))
if unlike != [("left_hip_y", "-120 20", "-110 20")]:
    raise SystemExit(f"CHANGED: {unlike}")
PY
