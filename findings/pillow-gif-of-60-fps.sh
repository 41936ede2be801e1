#!/usr/bin/env bash
# A 60 fps GIF by Pillow plays at 100 fps.
#
# Expected: GIF counts in hundredths of a second, so 16.7 ms becomes the nearest, 20 ms (50 fps), or alternates.
# Happens: it is cut, not rounded: 10 ms a frame. A second of motion lasts 0.6 s. 30 fps becomes 33.3, 15 fps 16.7; 25 and
#   50 are exact.
# Seen with: Pillow 13.0.0; matplotlib's PillowWriter and imageio write through it.
# Means: a clip of a roll looks 1.67 times as lively as it was. Write GIFs at 25 or 50 frames a second, or WebP or PNG,
#   whose clocks are finer.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pillow==13.0.0
cd "$work"
"$work/venv/bin/python" - <<'PY'
import PIL
from PIL import Image

print("Pillow", PIL.__version__, "- one second of frames, how long they are shown")
lasts = {}
for rate in (15, 25, 30, 50, 60):
    frames = [Image.new("L", (8, 8), 4 * i) for i in range(rate)]
    for ending in ("gif", "webp"):
        frames[0].save(f"clip.{ending}", save_all=True, append_images=frames[1:], duration=1000 / rate)
        with Image.open(f"clip.{ending}") as clip:
            shown = 0
            for i in range(clip.n_frames):
                clip.seek(i)
                clip.load()
                shown += clip.info["duration"]
        lasts[rate, ending] = shown
    print(f"{rate} fps: GIF {lasts[rate, 'gif']:.0f} ms, WebP {lasts[rate, 'webp']:.0f} ms")
if lasts[60, "gif"] != 600 or lasts[50, "gif"] != 1000 or not 990 <= lasts[60, "webp"] <= 1010:
    raise SystemExit("CHANGED: a GIF of 60 fps no longer lasts 0.6 of its time")
PY
