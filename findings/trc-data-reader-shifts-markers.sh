#!/usr/bin/env bash
# Where a marker is hidden in a TRC file, trc-data-reader gives it the place of the next marker.
#
# Expected: TRC separates its columns by tabs and leaves those of a hidden marker empty; a reader gives NaN there.
# Happens: each line is split at white space, so the empty columns close up and everything to their right moves up: the
#   hidden hip is reported at the knee, the knee at the toe, and the last marker of the line is NaN. Only when the
#   hidden marker is the last is the answer right.
# Seen with: trc-data-reader 0.4.1 (module trc).
# Means: a body that rolls hides markers all the time. A gap is then not a gap but a jump of a limb's length to another
#   marker and back, which gap filling does not see, and the last markers of the file seem to be the ones that are
#   hard to track. Fill the gaps before exporting, or compare with a reader that keeps empty columns.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check trc-data-reader==0.4.1
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

from trc import TRCData

MARKERS = {"hip": (0, 900, 0), "knee": (100, 500, 0), "toe": (200, 50, 0)}  # millimetres
HIDDEN = (None, "hip", "knee", "toe")  # one frame each

lines = ["PathFileType\t4\t(X/Y/Z)\troll.trc"]
lines += ["DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames"]
lines += [f"100\t100\t{len(HIDDEN)}\t{len(MARKERS)}\tmm\t100\t1\t{len(HIDDEN)}"]
lines += ["Frame#\tTime\t" + "\t\t\t".join(MARKERS) + "\t\t"]
lines += ["\t\t" + "\t".join(f"{axis}{number}" for number in (1, 2, 3) for axis in "XYZ"), ""]
for frame, hidden in enumerate(HIDDEN):
    columns = [str(value) if name != hidden else "" for name, place in MARKERS.items() for value in place]
    lines.append(f"{frame + 1}\t{frame / 100:.2f}\t" + "\t".join(columns))
with open("roll.trc", "w") as file:
    file.write("\n".join(lines) + "\n")

data = TRCData()
data.load("roll.trc")
print("trc-data-reader", version("trc-data-reader"))
height = {}
for frame, hidden in enumerate(HIDDEN):
    height[hidden] = [data[name][frame][1] for name in MARKERS]
    print(f"hidden: {hidden!s:5s} heights of hip, knee, toe:", *height[hidden])
nan = [[value != value for value in values] for values in height.values()]
if height[None] != [900, 500, 50] or height["toe"][:2] != [900, 500]:
    raise SystemExit("CHANGED: not even a full frame is read as written")
if height["hip"][:2] != [500, 50] or height["knee"][:2] != [900, 50] or nan[1:] != [[False, False, True]] * 3:
    raise SystemExit("CHANGED: the columns of a hidden marker are kept")
PY
