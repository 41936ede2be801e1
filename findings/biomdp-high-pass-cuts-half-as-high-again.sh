#!/usr/bin/env bash
# Muscle signals freed from what is below 20 Hz by biomdp have lost what is below 31 Hz.
#
# Expected: filter_butter filters forwards and backwards and moves the cut-off so that the two passes together let half of the power through at fc; its source
#   names the factor of 0.802 of Winter's book. For a low-pass filter it moves up, for a high-pass filter, the other of its two kinds, down.
# Happens: both are divided by 0.802. The low-pass filter has a gain of 0.71 at fc. The high-pass filter has 0.29 there, which is a twelfth of the power, and 0.71 at
#   1.55 times fc, whatever fc is; without any correction it would be half as far off. filter_butter_bandpass of the same module corrects nothing: at either of
#   its ends the gain is 0.5.
# Seen with: biomdp 0.11.2, scipy 1.17.1. Winter's factor is for low-pass filters; its documentation has "low" and "high" side by side and speaks of fc for both.
# Means: amplitudes of muscle signals, of which a good part lies between 20 and 60 Hz, come out too small, and not the same for all muscles. A result of this
#   package is compared with those of papers that tell the same cut-off. Give 0.64 times the frequency that is wanted, or use scipy's sosfiltfilt.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check biomdp==0.11.2 xarray==2026.9.0 pandas==3.1.1 scipy==1.17.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from biomdp.filter_butter import filter_butter, filter_butter_bandpass

RATE = 2000  # Hz
time = np.arange(20 * RATE) / RATE
middle = slice(5 * RATE, 15 * RATE)


def gain(tone, **band):
    """What is left of a tone, as a share, away from both ends of the recording."""
    signal = np.sin(2 * np.pi * tone * time)
    filtered = filter_butter_bandpass(signal, RATE, **band) if "fclow" in band else filter_butter(signal, RATE, **band)
    return float(filtered[middle].std() / signal[middle].std())


print("biomdp", version("biomdp"), "- gain of a tone; half of the power is 0.707")
found = {}
for kind in ("low", "high"):
    for cut in (5, 20):
        for tone in (0.8 * cut, cut, 1.25 * cut, 1.55 * cut):
            found[kind, cut, tone / cut] = gain(tone, fc=cut, order=2, kind=kind)
        print(f"{kind}-pass, fc {cut:2} Hz:", ", ".join(f"{tone * cut:5.2f} Hz {share:.2f}" for (k, c, tone), share in found.items() if (k, c) == (kind, cut)))
ends = [gain(tone, fclow=20, fchigh=400) for tone in (20, 400)]
print("band from 20 to 400 Hz, at its ends:", *(round(share, 2) for share in ends))
for cut in (5, 20):
    if abs(found["low", cut, 1.0] - 0.707) > 0.01:
        raise SystemExit("CHANGED: the low-pass filter has another gain at fc")
    if abs(found["high", cut, 1.0] - 0.29) > 0.01 or abs(found["high", cut, 1.55] - 0.707) > 0.01:
        raise SystemExit("CHANGED: the high-pass filter cuts elsewhere")
if max(abs(share - 0.5) for share in ends) > 0.01:
    raise SystemExit("CHANGED: the band-pass filter has another gain at its ends")
PY
