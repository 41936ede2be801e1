#!/usr/bin/env bash
# Loaded by pyxdf, a stream that lost two seconds has time stamps that are a second off around the gap.
#
# Expected: removing jitter moves time stamps by the jitter, some milliseconds; a hole in the data stays a hole.
# Happens: a straight line is fitted through all stamps, holes included, unless one is longer than a second and than 500
#   samples: at 100 Hz that is 5 s. A force plate that sends nothing for 0.9 s of 20 is up to 0.46 s off, and no
#   interval is longer than 11 ms; after 4 s without data it is 2.2 s off. The file has the right stamps.
# Seen with: pyxdf 1.17.5, load_xdf as it comes; from a gap of about 2 s on it warns of the sampling rate.
# Means: the force of a landing is matched with the pose of a second before. A wireless sensor that drops packets does
#   this in each recording, and a look at numpy.diff of the stamps cannot show it. dejitter_timestamps=False, or
#   jitter_break_threshold_samples=1 with a threshold in seconds that suits the device.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check pyxdf==1.17.5 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import logging
import struct
from importlib.metadata import version

import numpy as np
import pyxdf

logging.getLogger("pyxdf").setLevel(logging.ERROR)
RATE, SECONDS, LOST_FROM = 100, 20, 10
HEADER = f"""<?xml version="1.0"?><info><name>plate</name><type>Force</type><channel_count>1</channel_count>
<nominal_srate>{RATE}</nominal_srate><channel_format>double64</channel_format></info>"""


def chunk(tag, content):
    return b"\x04" + struct.pack("<IH", len(content) + 2, tag) + content


def write(times):
    """One channel, whose value is the time at which it was measured."""
    data = b"XDF:" + chunk(1, b'<?xml version="1.0"?><info><version>1.0</version></info>')
    data += chunk(2, struct.pack("<I", 1) + HEADER.encode())
    for block in np.array_split(times, len(times) // 50):
        samples = b"".join(b"\x08" + struct.pack("<dd", time, time) for time in block)
        data += chunk(3, struct.pack("<IBB", 1, 1, len(block)) + samples)
    data += chunk(6, struct.pack("<I", 1) + b'<?xml version="1.0"?><info></info>')
    with open("landing.xdf", "wb") as file:
        file.write(data)


def worst(**options):
    """Seconds by which a stamp is off at most, and the longest interval between two."""
    (stream,), _ = pyxdf.load_xdf("landing.xdf", **options)
    stamps, measured = stream["time_stamps"], stream["time_series"][:, 0]
    return float(np.abs(stamps - measured).max()), float(np.diff(stamps).max())


print("pyxdf", version("pyxdf"), "- 20 s at 100 Hz")
CHOICES = {"default": {}, "break at 0.1 s": {"jitter_break_threshold_seconds": 0.1, "jitter_break_threshold_samples": 1}}
CHOICES["no dejitter"] = {"dejitter_timestamps": False}
off = {}
for lost in (0, 0.9, 2, 4):
    times = np.arange(RATE * SECONDS) / RATE
    write(times[(times < LOST_FROM) | (times >= LOST_FROM + lost)])
    for name, options in CHOICES.items():
        off[lost, name], longest = worst(**options)
        print(f"{lost:3.1f} s lost, {name:14s}: stamps up to {off[lost, name]:.3f} s off, longest interval {longest:.4f} s")
right = [error for (lost, name), error in off.items() if lost == 0 or name != "default"]
if max(right) > 0.001:
    raise SystemExit("CHANGED: the stamps that were right are no longer")
if not (0.4 < off[0.9, "default"] < 0.5 and 1 < off[2, "default"] < 1.1 and 2.1 < off[4, "default"] < 2.3):
    raise SystemExit("CHANGED: a gap of some seconds stays where it was")
PY
