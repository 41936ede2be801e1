#!/usr/bin/env bash
# A DataArray of fifteen markers over time, low-passed by biomdp: each marker is mixed with its neighbours, and not smoothed in time.
#
# Expected: xarray names its dimensions so that their order is of no account. filter_butter takes such an array, fills its gaps along "time" and reads the rate off
#   the coordinate of "time"; so it filters along "time", whether that is the first dimension or the last.
# Happens: gaps go along "time" and the filter along the last dimension, whichever that is. With (time, marker) fifteen heights at one moment are taken for fifteen
#   samples: each marker is drawn to those beside it in the list, up to 1.18 m off, and jumps by up to 45 mm from frame to frame where a filter in time leaves 6. With
#   (marker, time), the same numbers, all is right to a centimetre. With less than ten markers there is an error of scipy, about padding. filter_butter_bandpass does
#   likewise, and makes nothing of what all markers have in common.
# Seen with: biomdp 0.11.2, xarray 2026.9.0, scipy 1.17.1. Its documentation has "array_like, numpy, pandas or dataarray" and nothing of an order; columns of a pandas table,
#   which is (time, marker), are filtered in time.
# Means: time comes first in DataArray(table), and in netCDF files to which samples are appended. Shapes, names and gaps come back as they were, and a picture of one pose looks
#   plausible where neighbours in the list are neighbours on the body. Call transpose(..., "time") before, and compare one marker with its raw one.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check biomdp==0.11.2 xarray==2026.9.0 pandas==3.1.1 scipy==1.17.1 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
import xarray as xr
from biomdp.filter_butter import filter_butter, filter_butter_bandpass

MARKERS = 15
time = np.arange(400) / 200  # s
heights = 0.1 * (7 * np.arange(MARKERS) % MARKERS)  # m, neighbours in the list are none on the body
true = heights + 0.05 * np.sin(2 * np.pi * time)[:, None]
noise = 0.01 * np.random.default_rng(0).normal(size=true.shape)
clip = xr.DataArray(true + noise, dims=("time", "marker"), coords={"time": time})
inside = slice(40, -40)


def off(filtered):
    """Greatest distance from the motion without noise, away from the ends [m]."""
    return float(np.abs(filtered.transpose("time", "marker").values - true)[inside].max())


print("biomdp", version("biomdp"), "xarray", version("xarray"), "scipy", version("scipy"))
time_first = off(filter_butter(clip, fc=6))
time_last = off(filter_butter(clip.transpose("marker", "time"), fc=6))
table = filter_butter(clip.to_pandas(), fr=200, fc=6)
in_table = float(np.abs(table.values - true)[inside].max())
print(f"greatest error: (time, marker) {time_first:.3f} m, (marker, time) {time_last:.3f} m, pandas, which is (time, marker), {in_table:.3f} m; raw {np.abs(noise).max():.3f} m")
steps = float(np.abs(np.diff(filter_butter(clip, fc=6).values, axis=0)).max())
smooth = float(np.abs(np.diff(table.values, axis=0)).max())
print(f"greatest step of a marker from frame to frame: (time, marker) {1000 * steps:.1f} mm, pandas {1000 * smooth:.1f} mm")
beats = 0.05 * np.sin(2 * np.pi * 10 * time)[:, None] * np.ones(MARKERS)
beating = xr.DataArray(beats, dims=("time", "marker"), coords={"time": time})
band = [float(np.abs(filter_butter_bandpass(a, fr=200, fclow=5, fchigh=20, order=1)).max()) for a in (beating, beating.transpose("marker", "time"))]
print(f"10 Hz of 50 mm within a band of 5 to 20 Hz: (time, marker) {1000 * band[0]:.1f} mm, (marker, time) {1000 * band[1]:.1f} mm")
try:
    filter_butter(clip[:, :9], fc=6)
    few = "taken"
except ValueError as error:
    few = str(error)
print("nine markers, (time, marker):", few)
if time_first < 0.3 or time_last > 0.02 or abs(in_table - time_last) > 1e-9:
    raise SystemExit("CHANGED: the order of dimensions is of no account")
if steps < 3 * smooth or band[0] > 0.2 * band[1]:
    raise SystemExit("CHANGED: what is left in time is another")
if "padlen" not in few:
    raise SystemExit("CHANGED: nine markers are taken, or refused otherwise")
PY
