#!/usr/bin/env bash
# A TRC file of 25 frames a second has 20 to nimblephysics, and 60 if it is short; the same recording as C3D has 25.
#
# Expected: framesPerSecond of a TRC file is what its header gives as DataRate, or the inverse of the time between two rows, which agree here.
# Happens: it is the count of frames over the time from the first to the last, one interval too few, as a whole number of tens, which its
#   docstring does not tell. Of 2000 frames 15 a second become 10, 24 and 25 become 20, 85 become 80, 128 become 130; 6 frames at 50 are 60
#   a second, and at 120 are 140. Time stamps are right, to the digits in the file. loadC3D tells 25 and 85, and 148 of 148.5.
# Seen with: nimblephysics 0.10.52.1, its compiled half alone (OpenSimParser.loadTRC, C3DLoader.loadC3D), ezc3d 1.7.2 to write C3D. The usual 60, 100
#   and 120 come out right once a file has some 50 frames, which hides it.
# Means: velocities by this rate are 20 % too small, and accelerations 36 %; a low-pass filter made for it cuts elsewhere. Markers of
#   one recording, as TRC, and its forces, as C3D, no longer run side by side. Take the rate from the differences of the time stamps.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps nimblephysics==0.10.52.1 ezc3d==1.7.2 numpy==2.4.6
cd "$work"
cat > c3d.py <<'PY'
"""A C3D file of 50 frames at the rate that is named."""

import sys

import ezc3d
import numpy as np

rate = float(sys.argv[1])
file = ezc3d.c3d()
file["parameters"]["POINT"]["RATE"]["value"] = [rate]
file["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
file["parameters"]["POINT"]["LABELS"]["value"] = ["pelvis"]
points = np.ones((4, 1, 50))
points[:3, 0] = 1000.0 * np.array([[0.5], [1.0], [0.2]]) + np.arange(50)
file["data"]["points"] = points
file.write("clip.c3d")
PY
"$work/venv/bin/python" -W ignore - <<'PY'
import contextlib
import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np
from nimblephysics_libs._nimblephysics import biomechanics

HEAD = ["PathFileType\t4\t(X/Y/Z)\tclip.trc", "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames"]
NAMES = ["Frame#\tTime\tpelvis\t\t", "\t\tX1\tY1\tZ1", ""]


def trc(rate, frames):
    """Frames a second that are told of a TRC file, and its time stamps."""
    rows = [f"{i + 1}\t{i / rate:.6f}\t{500 + i:.3f}\t1000.000\t200.000" for i in range(frames)]
    told = f"{rate}\t{rate}\t{frames}\t1\tmm\t{rate}\t1\t{frames}"
    Path("clip.trc").write_text("\n".join([*HEAD, told, *NAMES, *rows]) + "\n")
    clip = biomechanics.OpenSimParser.loadTRC(str(Path("clip.trc").resolve()))
    return clip.framesPerSecond, np.array(clip.timestamps)


@contextlib.contextmanager
def quiet():
    """The C3D reader writes to standard output from C++."""
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    yield
    os.dup2(kept, 1)


def c3d(rate):
    subprocess.run([sys.executable, "c3d.py", str(rate)], check=True)
    with quiet():
        return biomechanics.C3DLoader.loadC3D(str(Path("clip.c3d").resolve())).framesPerSecond


print("nimblephysics", version("nimblephysics"), "ezc3d", version("ezc3d"), flush=True)
seen = {}
for rate, frames in ((15, 2000), (24, 2000), (25, 2000), (85, 2000), (100, 2000), (128, 2000), (50, 6), (120, 6), (100, 11)):
    told, times = trc(rate, frames)
    seen[rate, frames] = told
    by_times = 1.0 / np.diff(times).mean()
    print(f"TRC, {frames} frames at {rate} a second: told {told}; by its time stamps {by_times:.2f}", flush=True)
    if abs(by_times - rate) > 0.01:
        raise SystemExit("CHANGED: the time stamps are others")
as_c3d = {rate: c3d(rate) for rate in (25, 85, 148.5)}
print(f"C3D: {as_c3d}")
if as_c3d != {25: 25, 85: 85, 148.5: 148}:
    raise SystemExit("CHANGED: C3D files have another rate")
if list(seen.values()) != [10, 20, 20, 80, 100, 130, 60, 140, 110]:
    raise SystemExit("CHANGED: TRC files have another rate")
PY
