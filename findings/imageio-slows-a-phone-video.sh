#!/usr/bin/env bash
# imageio reads 90 frames from a video of 60 and tells a frame rate at which they last half as long again.
#
# Expected: a phone slows its frame rate in poor light; a reader gives each frame once, or fills up to a steady rate and tells
#   that rate.
# Happens: it fills up to the stream's base rate, here 60 per second, by showing frames twice, and tells the mean rate of the
#   frames in the file, 41.4. Frame number over fps runs 1.47 times too slow: what took 1.47 s seems to take 2.15 s.
#   count_frames() says 60. With a steady rate all agree.
# Seen with: imageio 2.38.1, imageio-ffmpeg 0.8.1, file written by av 18.1.0.
# Means: the angular velocity of a filmed somersault comes out 32 % too low, and gravity at less than half its value, by the
#   file's own metadata. Take the times of the frames from av (frame.time), or test that a fall has 9.81.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check \
    imageio==2.38.1 imageio-ffmpeg==0.8.1 av==18.1.0 numpy==2.4.6 pillow==13.0.0
cd "$work"
"$work/venv/bin/python" - <<'PY'
from fractions import Fraction
from importlib.metadata import version

import av
import imageio.v2 as imageio
import numpy as np

RATE = 60
TIMES = {"steady": range(60), "slowing": [*range(30), *range(30, 90, 2)]}  # in 1/60 s; the second half at 30 per second


def write(name, times):
    with av.open(name, "w") as file:
        stream = file.add_stream("libx264", rate=RATE)
        stream.width = stream.height = 64
        stream.pix_fmt = "yuv420p"
        for number, time in enumerate(times):
            frame = av.VideoFrame.from_ndarray(np.full((64, 64, 3), 4 * number, np.uint8))
            frame.pts, frame.time_base = time, Fraction(1, RATE)
            for packet in stream.encode(frame):
                file.mux(packet)
        for packet in stream.encode(None):
            file.mux(packet)


print(*(f"{name} {version(name)}" for name in ("imageio", "imageio-ffmpeg", "av")))
slow = {}
for name, times in TIMES.items():
    write("clip.mp4", times)
    with av.open("clip.mp4") as file:
        stamps = [frame.time for frame in file.decode(video=0)]
    reader = imageio.get_reader("clip.mp4", "ffmpeg")
    fps, counted, read = reader.get_meta_data()["fps"], reader.count_frames(), sum(1 for _ in reader)
    reader.close()
    slow[name] = (read - 1) / fps / (stamps[-1] - stamps[0])
    print(
        f"{name:8s}: av has {len(stamps)} frames in {stamps[-1] - stamps[0]:.3f} s; imageio reads {read}, counts {counted}, "
        f"fps {fps}: {(read - 1) / fps:.3f} s, {slow[name]:.2f} times as long"
    )
if abs(slow["steady"] - 1) > 0.01 or not 1.35 < slow["slowing"] < 1.55:
    raise SystemExit("CHANGED: frames and rate fit together, or not even for a steady rate")
PY
