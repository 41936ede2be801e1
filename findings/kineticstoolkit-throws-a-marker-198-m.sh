#!/usr/bin/env bash
# A marker leaves the cameras half a second before the end of a clip: filled by Kinetics Toolkit, it flies 198 m away.
#
# Expected: filling missing samples interpolates, between what was seen before and after. Before the first and after the last there is nothing to fill
#   from: such samples stay NaN, or the last place is held. resample() of the same class does not extrapolate unless it is told to.
# Happens: fill_missing_samples() extrapolates at both ends, and says nothing. With method "cubic" a marker that swings by 0.3 m is
#   198 m away half a second after it was seen last, and 15 m a fifth of a second before it was seen first; with "quadratic" it is 3.6 m. With "linear",
#   which is what it does untold, it goes on at the speed between the last two frames, noise included, to -0.8 m. Only "nearest" holds
#   the place. A limit of missing samples that is shorter than the end keeps it NaN. "cubic" fills a gap in the middle to within 5 mm.
# Seen with: kineticstoolkit 0.17.0. What is asked of scipy's interp1d there is fill_value="extrapolate".
# Means: the usual cubic filling ruins means, ranges, filters and pictures of clips whose markers come and go at the ends, as in a roll through the
#   volume, while a straight line is off by little enough to be believed. Give a limit, or cut what was never seen.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check kineticstoolkit==0.17.0 numpy==2.4.6
cd "$work"
MPLBACKEND=agg "$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import kineticstoolkit.lab as ktk
import numpy as np

TIMES = np.arange(200) / 100.0  # s
SWING = 0.3 * np.sin(2 * np.pi * TIMES) + 0.001 * np.random.default_rng(0).normal(size=TIMES.size)  # m: a hertz, a millimetre of noise
HEAD, MIDDLE, TAIL = slice(0, 20), slice(80, 90), slice(150, 200)


def clip(*hidden):
    points = np.stack([SWING, np.zeros_like(SWING), np.zeros_like(SWING), np.ones_like(SWING)], axis=1)
    for part in hidden:
        points[part, :3] = np.nan
    return ktk.TimeSeries(time=TIMES).add_data("wrist", points)


def filled(method, limit, *hidden):
    return clip(*hidden).fill_missing_samples(limit, method=method).data["wrist"][:, 0]


print("kineticstoolkit", version("kineticstoolkit"), f"; right is {SWING[0]:.2f} m at the beginning and {SWING[-1]:.2f} at the end")
ends = {}
for method in ("linear", "quadratic", "cubic", "nearest"):
    x = filled(method, 0, HEAD, MIDDLE, TAIL)
    ends[method] = x[0], x[-1]
    middle = np.abs(x[MIDDLE] - SWING[MIDDLE]).max()
    print(f"{method}: x is {x[0]:.2f} m at the beginning and {x[-1]:.2f} at the end; {1e3 * middle:.1f} mm off in the middle")
    limited = filled(method, 10, HEAD, MIDDLE, TAIL)
    if not np.isnan(limited[HEAD]).all() or not np.isnan(limited[TAIL]).all() or np.isnan(limited[MIDDLE]).any():
        raise SystemExit("CHANGED: a limit keeps other samples")
resampled = clip(HEAD, TAIL).resample(TIMES, "cubic").data["wrist"][:, 0]
print(f"resample(): {np.isnan(resampled).sum()} of {TIMES.size} samples are NaN")
if not np.isnan(resampled[HEAD]).all() or not np.isnan(resampled[TAIL]).all():
    raise SystemExit("CHANGED: resample() extrapolates")
if min(abs(ends["cubic"][1]), 10 * abs(ends["cubic"][0])) < 100 or abs(ends["quadratic"][1]) < 2 or abs(ends["linear"][1]) < 0.6:
    raise SystemExit("CHANGED: the ends are filled otherwise")
if ends["nearest"] != (SWING[20], SWING[149]):
    raise SystemExit("CHANGED: nearest does not hold the place")
PY
