#!/usr/bin/env bash
# A marker half a metre left of the origin, in a C3D file of integers: pupyC3D has it 6.05 m to the right, and the foot pulls the floor up by 32 kN in place of pressing.
#
# Expected: a C3D file whose POINT:SCALE is positive holds its points as signed 16-bit integers times that scale, and analog samples as signed ones as well, unless
#   ANALOG:FORMAT says UNSIGNED. ezc3d and c3d read it so.
# Happens: pupyC3D reads all of them as unsigned. What is below zero is 65,536 counts too high: -500 mm are 6053.6 mm at a scale of 0.1 mm, and
#   -700 N are 32,068 N at half a newton a count. What is above zero is right. Files of floating-point numbers are right throughout.
# Seen with: pupyC3D 0.1.3; ezc3d 1.7.2 and c3d 0.6.0 for comparison. Its documentation has a "uint16" for parameters, and nothing of samples.
# Means: many older recordings are of integers. With the origin in the middle of the volume half of the markers fly off to one side; with the origin in a
#   corner all looks well until somebody steps over a line. Where plates count a foot's push downwards as negative no force is right. Subtract
#   65536 times the scale from whatever is above 32767 times it.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pupyc3d==0.1.3 ezc3d==1.7.2 c3d==0.6.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import struct
from importlib.metadata import version
from pathlib import Path

import c3d
import ezc3d
import numpy as np
from pupyC3D import C3DFile

MM = 0.1  # mm a count
NEWTON = 0.5  # N a count
POINTS = np.array([[[-500.0, 200.0, 900.0], [100.0, -50.0, 80.0]], [[-510.0, 210.0, 910.0], [110.0, -40.0, 90.0]]])  # mm, by frame and marker
FORCES = np.array([-700.0, 690.0])  # N


def group(name, number):
    return struct.pack("<bb", len(name), -number) + name + struct.pack("<h", 3) + b"\0"


def parameter(name, number, kind, sizes, data):
    body = struct.pack("<bB", kind, len(sizes)) + bytes(sizes) + data + b"\0"
    return struct.pack("<bb", len(name), number) + name + struct.pack("<h", len(body) + 2) + body


def integers(*numbers):
    return struct.pack(f"<{len(numbers)}h", *numbers)


def write(path):
    """A C3D file of integers as the format has it: a header, parameters in two blocks, samples from the fourth block on."""
    scale = struct.pack("<f", MM)
    inside = group(b"POINT", 1) + parameter(b"USED", 1, 2, [], integers(2)) + parameter(b"SCALE", 1, 4, [], scale)
    inside += parameter(b"RATE", 1, 4, [], struct.pack("<f", 100.0)) + parameter(b"DATA_START", 1, 2, [], integers(4))
    inside += parameter(b"FRAMES", 1, 2, [], integers(2)) + parameter(b"LABELS", 1, -1, [4, 2], b"HIP ANKL") + parameter(b"UNITS", 1, -1, [2], b"mm")
    inside += group(b"ANALOG", 2) + parameter(b"USED", 2, 2, [], integers(1)) + parameter(b"GEN_SCALE", 2, 4, [], struct.pack("<f", 1.0))
    inside += parameter(b"SCALE", 2, 4, [1], struct.pack("<f", NEWTON)) + parameter(b"OFFSET", 2, 2, [1], integers(0))
    inside += parameter(b"RATE", 2, 4, [], struct.pack("<f", 100.0)) + parameter(b"LABELS", 2, -1, [4, 1], b"Fz1 ")
    inside += parameter(b"FORMAT", 2, -1, [6], b"SIGNED") + b"\0"
    head = struct.pack("<BBHHHHHfHHf", 2, 80, 2, 1, 1, 2, 0, MM, 4, 1, 100.0)
    samples = b""
    for points, force in zip(POINTS, FORCES):
        samples += b"".join(integers(*(round(float(number) / MM) for number in point), 0) for point in points) + integers(round(float(force) / NEWTON))
    path.write_bytes(head.ljust(512, b"\0") + (b"\0\0\x02\x54" + inside).ljust(1024, b"\0") + samples.ljust(512, b"\0"))


print("pupyC3D", version("pupyC3D"), "ezc3d", version("ezc3d"), "c3d", version("c3d"))
clip = Path("clip.c3d")
write(clip)
by_ezc3d = ezc3d.c3d("clip.c3d")["data"]
with clip.open("rb") as file:
    by_c3d = [(points[:, :3], analog[0, 0]) for _, points, analog in c3d.Reader(file).read_frames()]
read = C3DFile("clip.c3d").data
points = np.stack([read["POINTS"][name][:, :3] for name in ("HIP", "ANKL")], axis=1)
forces = read["ANALOGS"]["Fz1"].ravel()
print(f"hip at {POINTS[0, 0]} mm, force {FORCES[0]} N; ezc3d {by_ezc3d['points'][:3, 0, 0].round(1)} mm, {by_ezc3d['analogs'][0, 0, 0]:.0f} N")
print(f"pupyC3D: hip at {points[0, 0].round(1)} mm, ankle {points[0, 1].round(1)} mm, forces {forces} N")
if np.abs(by_ezc3d["points"][:3].transpose(2, 1, 0) - POINTS).max() > 1e-3 or np.abs(by_ezc3d["analogs"][0, 0] - FORCES).max() > 1e-3:
    raise SystemExit("CHANGED: ezc3d reads another file")
if any(np.abs(a - b).max() > 1e-3 or abs(c - d) > 1e-3 for (a, c), b, d in zip(by_c3d, POINTS, FORCES)):
    raise SystemExit("CHANGED: c3d reads another file")
if np.abs(points - np.where(POINTS < 0, POINTS + 65536 * MM, POINTS)).max() > 1e-3 or np.abs(forces - np.where(FORCES < 0, FORCES + 65536 * NEWTON, FORCES)).max() > 1e-3:
    raise SystemExit("CHANGED: integers have a sign")
PY
