#!/usr/bin/env bash
# ezc3d writes a C3D file of 70,000 frames and reads 65,535 of them back.
#
# Expected: the header's frame counter has 16 bits, every mocap engineer knows; a library gets round it by the
#   TRIAL:ACTUAL_END_FIELD or POINT:LONG_FRAMES parameters, or refuses to write.
# Happens: writing says nothing and the data are all in the file, but POINT:FRAMES is written as 65535, and reading ends there:
#   the last 4,465 frames are gone without a word.
# Seen with: ezc3d 1.7.2.
# Means: five minutes at 240 Hz are 72,000 frames. The end of a long take is where a character gets up again: compare the
#   number of frames after writing, and cut long takes.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check ezc3d==1.7.2 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version
from pathlib import Path

import ezc3d
import numpy as np

print("ezc3d", version("ezc3d"))
seen = {}
for frames in (60000, 70000):
    take = ezc3d.c3d()
    take["parameters"]["POINT"]["RATE"]["value"] = [240.0]
    take["parameters"]["POINT"]["LABELS"]["value"] = ("head",)
    points = np.ones((4, 1, frames))
    points[0, 0] = np.arange(frames)
    take["data"]["points"] = points
    take.write("take.c3d")
    back = ezc3d.c3d("take.c3d")
    seen[frames] = back["data"]["points"].shape[2]
    print(
        f"written {frames}, read {seen[frames]}, last value {back['data']['points'][0, 0, -1]:.0f}, "
        f"POINT:FRAMES {int(back['parameters']['POINT']['FRAMES']['value'][0])}, "
        f"{Path('take.c3d').stat().st_size // 16} points' worth of bytes in the file"
    )
if seen != {60000: 60000, 70000: 65535}:
    raise SystemExit("CHANGED: all frames come back")
PY
