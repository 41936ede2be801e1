#!/usr/bin/env bash
# Written by the c3d package as integers of 0.01 mm, a head at 1600 mm lies at 289 mm, and with 0.1 mm it is at 1599.9 mm.
#
# Expected: a C3D file of integers holds 16 bits for each coordinate, which times a scale of 0.01 mm reach 327.67 mm. A writer that is given such a scale and a point beyond
#   it refuses, or stops at the end of the range. What fits is rounded to the nearest count.
# Happens: what does not fit is written as another number; where a conversion keeps the lowest 16 bits, as on x86-64, it goes on from the other end of the range, so that a marker
#   that rises without a stop falls by 0.66 m at 327.68 mm and rises again. What fits is cut, not rounded, towards 0, and 1600 / 0.1 in single precision is a little under
#   16,000: 15,999. Forces of integers are cut likewise, a push of -700.6 N to -700. Nothing is said. With floating-point numbers, which it writes untold, all is as it was.
# Seen with: c3d 0.6.0 (Writer, point_scale), numpy 2.4.6; the numbers are so in the file itself. Its documentation tells of no range, and its issues of none that was found.
# Means: a finer scale is chosen to lose less, and for a body lying on the floor it is right: such files pass a first look, and somersaults in them are folded. Jumps by
#   65,536 counts are the sign of it. Half a count is lost on the average, downwards above the origin and upwards below it. Keep point_scale=-1.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check c3d==0.6.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W error::RuntimeWarning - <<'PY'
import platform
from importlib.metadata import version
from pathlib import Path

import c3d
import numpy as np

PUSH = -700.6  # N
heights = np.arange(0.0, 1601.0, 100.0)  # mm, of a marker that rises
frames = [(np.array([[0.0, 0.0, height, 0.0, 0.0], np.zeros(5)]), np.full((1, 10), PUSH)) for height in heights]


def written(scale):
    """Heights [mm] and pushes [N] in the file by c3d, and heights [mm] by the numbers that lie in it."""
    writer = c3d.Writer(point_rate=100.0, analog_rate=1000.0, point_scale=scale)
    writer.add_frames(frames)
    writer.set_point_labels(["head", "foot"])
    writer.set_analog_labels(["Fz"])
    with open("clip.c3d", "wb") as file:
        writer.write(file)
    with open("clip.c3d", "rb") as file:
        reader = c3d.Reader(file)
        read = [(points[0, 2], analog[0, 0]) for _, points, analog in reader.read_frames()]
    numbers = np.frombuffer(Path("clip.c3d").read_bytes()[512 * (reader.header.data_block - 1) :], "<f4" if scale < 0 else "<i2")
    lying = numbers[: 18 * len(heights)].reshape(-1, 18)[:, 2] * abs(scale)  # two points of four numbers and ten pushes a frame
    return (*np.array(read, dtype=float).T, lying)


print("c3d", version("c3d"), "- heights of", *(int(height) for height in heights), "mm")
found = {scale: written(scale) for scale in (-1.0, 0.1, 0.01)}
for scale, (height, push, lying) in found.items():
    print(f"scale {scale}:", *(f"{number:.1f}" for number in height), f"- push {push[0]:.2f} N")
    if np.abs(height - lying).max() > 1e-3:
        raise SystemExit("CHANGED: the reader tells other numbers than lie in the file")
if np.abs(found[-1.0][0] - heights).max() > 1e-3 or abs(found[-1.0][1][0] - PUSH) > 1e-3:
    raise SystemExit("CHANGED: floating-point numbers are not kept")
within, fine = heights < 327.67, found[0.01][0]
if np.abs(fine - heights)[within].max() > 0.0151 or np.abs(fine - heights)[~within].min() < 50:
    raise SystemExit("CHANGED: what does not fit is kept, or what fits is not")
if np.ptp(fine[~within]) < 1:
    raise SystemExit("CHANGED: what does not fit is put at the end of the range")
if platform.machine() in ("x86_64", "AMD64") and abs(fine[-1] - 289.28) > 0.0151:  # elsewhere it may be another number
    raise SystemExit("CHANGED: the head does not lie where its lowest 16 bits are")
if abs(found[0.1][0][-1] - 1599.9) > 0.01 or abs(found[0.1][1][0] + 700) > 1e-6:
    raise SystemExit("CHANGED: what fits is not cut")
PY
