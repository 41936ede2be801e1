#!/usr/bin/env bash
# Turn by 90 degrees in a recording's first two seconds and imufusion's heading is 0 after it; spin once beyond the sensor's range and all turns before are gone.
#
# Expected: without a magnetometer the heading is unknown up to a constant, and 0 at the first sample. From there on the gyroscope carries it, while
#   a high gain lets inclination settle. A spin beyond the range costs the part of the turn that was cut off, and the heading before it counts on.
# Happens: as long as the filter starts up, which is three seconds, the heading is set to 0 at every sample. A turn of 90 degrees from 1 to 2 s has heading 0 for
#   ever, one from 2.5 to 3.5 s has 46, from 3 s on 90. With a gyroscope_range one sample above 98 % of it starts the filter anew: a turn of 90
#   degrees at 4 s is 0 from 7 s on, where a single sample of 1990 of 2000 degrees/s came, and so is one at 8 s. With gyroscope_range=0, after
#   skip_startup(), or with a magnetometer, the turns are there.
# Seen with: imufusion 1.3.3, Ahrs.update_no_magnetometer at 100 Hz. Its documentation tells of three seconds in which the gain goes down from 10, and that
#   a rate beyond the range starts that again; the heading is not spoken of.
# Means: a log roll or a twist is where rates pass the range of a sensor, and it starts soon after the recording does. Directions before and after no longer
#   belong together, with sensors on several limbs each at another moment. Stand still for three seconds first, leave gyroscope_range at 0, or look at
#   get_flags() in every sample.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check imufusion==1.3.3 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import imufusion
import numpy as np

RATE = 100  # Hz
SPIN = 1990.0  # degrees/s, for one sample


def heading(turn, spin=None, most=0.0, skip=False, north=False):
    """Headings of a level sensor over 12 s, by hand and of the filter; it turns by 90 degrees in the second that begins at `turn`."""
    filter_, settings = imufusion.Ahrs(), imufusion.AhrsSettings()
    settings.sample_rate, settings.gyroscope_range = RATE, most
    filter_.set_settings(settings)
    if skip:
        filter_.skip_startup()
    truth, told = [0.0], []
    for sample in range(12 * RATE):
        rate = SPIN if sample == spin else 90.0 if turn * RATE <= sample < (turn + 1) * RATE else 0.0
        truth.append(truth[-1] + rate / RATE)
        rates, up = np.array([0.0, 0.0, rate]), np.array([0.0, 0.0, 1.0])
        if north:
            way = np.radians(truth[-1])
            filter_.update(rates, up, np.array([np.cos(way), -np.sin(way), 0.0]))
        else:
            filter_.update_no_magnetometer(rates, up)
        told.append(imufusion.quaternion_to_euler(filter_.get_quaternion())[2])
    return truth[-1], float(told[-1])


print("imufusion", version("imufusion"))
cases = {
    "turn at 1 s": ({"turn": 1}, 0.0),
    "turn at 2.5 s": ({"turn": 2.5}, 45.9),
    "turn at 3 s": ({"turn": 3}, 90.0),
    "turn at 1 s, startup skipped": ({"turn": 1, "skip": True}, 90.0),
    "turn at 1 s, with a magnetometer": ({"turn": 1, "north": True}, 90.0),
    "turn at 4 s, spin at 7 s": ({"turn": 4, "spin": 7 * RATE}, 109.7),
    "turn at 4 s, spin at 7 s, range of 2000": ({"turn": 4, "spin": 7 * RATE, "most": 2000.0}, 0.0),
    "turn at 8 s, spin at 7 s, range of 2000": ({"turn": 8, "spin": 7 * RATE, "most": 2000.0}, 0.0),
}
for name, (motion, seen) in cases.items():
    truth, told = heading(**motion)
    print(f"{name}: {truth:.1f} degrees, heading {told:.1f}")
    if abs(told - seen) > 0.1:
        raise SystemExit("CHANGED: the heading is another")
PY
