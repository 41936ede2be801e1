#!/usr/bin/env bash
# One gap in a Zarr log with a Delta filter, and the rest of its chunk is gaps.
#
# Expected: Delta stores differences to the sample before, so that smooth signals compress well, and gives back what was stored; its documentation
#   warns of integers that are too small for the differences, and a lossy filter would have a name for its error.
# Happens: on floating-point numbers, which it takes as well, differences are summed up again as numbers. Behind a NaN all samples up to the end of the
#   chunk are NaN: of a second at 1000 Hz with one gap a third of the way, 667 are lost. Behind an infinity, too. Of a force with noise and
#   no gap a part comes back with other last digits. Without the filter every sample is as it was.
# Seen with: zarr 3.1.6, numcodecs 0.16.6, chunks of 1000. Issue 765 of numcodecs asks for another way with NaN.
# Means: gaps are what markers and sensors have. As all is well again with the next chunk, it looks like a sensor that failed for a while, and how much is
#   lost hangs on the chunks. The samples are not in the file any more. Logs that are to be the same to the bit are not. Filter integers, by counts of a
#   resolution, or use a shuffle, which only moves bytes.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check zarr==3.1.6 numcodecs==0.16.6 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numcodecs
import numpy as np
import zarr

SAMPLES = 1000  # of a second, one chunk


def back(signal, filters):
    """The signal, written and read again."""
    array = zarr.create_array("log.zarr", shape=signal.shape, chunks=(SAMPLES,), dtype="f8", filters=filters, zarr_format=2, overwrite=True)
    array[:] = signal
    return zarr.open_array("log.zarr", mode="r")[:]


time = np.arange(2 * SAMPLES) / SAMPLES
angle = np.sin(3.0 * time)
angle[333] = np.nan
force = 80.0 * np.sin(20.0 * time) + np.random.default_rng(0).normal(scale=2.0, size=time.size)  # N, along the ground, with noise
delta = [numcodecs.Delta(dtype="f8")]
print("zarr", version("zarr"), "numcodecs", version("numcodecs"))
if any(not np.array_equal(back(signal, None), signal, equal_nan=True) for signal in (angle, force)):
    raise SystemExit("CHANGED: without a filter samples differ, too")
read = back(angle, delta)
lost = int(np.isnan(read[:SAMPLES]).sum()), int(np.isnan(read[SAMPLES:]).sum())
print(f"one NaN of {SAMPLES}: {lost[0]} NaN in its chunk, {lost[1]} in the next one")
if lost != (SAMPLES - 333, 0) or np.nanmax(np.abs(read - angle)) > 1e-12:
    raise SystemExit("CHANGED: what is lost behind a NaN")
angle[333] = np.inf
unknown = int((~np.isfinite(back(angle, delta)[:SAMPLES])).sum())
read = back(force, delta)
other = int((read != force).sum())
print(f"one infinity: {unknown} samples of its chunk are not finite; of {force.size} forces without a gap {other} differ, by up to {np.abs(read - force).max():.1e} N")
if unknown != SAMPLES - 333 or not other or np.abs(read - force).max() > 1e-9:
    raise SystemExit("CHANGED: what is lost behind an infinity, or of forces")
PY
