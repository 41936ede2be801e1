#!/usr/bin/env bash
# Put ten runs side by side in a virtual dataset of HDF5 and delete one: it becomes a run in which everything is 0.
#
# Expected: reading what lies in a file that is not there is an error, as with HDF5's external links, which are the same thing for whole datasets.
# Happens: the part of a missing file reads as the fill value of the virtual dataset, and that is 0 unless one is given. So does the part of a file
#   that lost its dataset. The shape is that of all runs, and neither an error nor an attribute tells; virtual_sources() names the files
#   whether they are there or not.
# Seen with: h5py 3.16.0 with HDF5 2.0.0; the user guide of HDF5 says so of virtual datasets.
# Means: copy the overview without one of its runs, or write it before a run is done, and a mean success, height or score over all has zeros in
#   it: a success rate is too low by that run, a largest torque or a number of falls is right by chance. Give fillvalue=NaN, which shows,
#   or -1 for whole numbers, and test that the sources exist.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check h5py==3.16.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
import os

import h5py
import numpy as np

RUNS, SAMPLES = 10, 4
NAMES = [f"run{run}.h5" for run in range(RUNS)]


def mean_height(overview):
    """Of the head over all runs and samples, and the least of a run."""
    with h5py.File(overview) as file:
        heights = file["height"][:].mean(axis=1)
    return float(heights.mean()), float(heights.min())


for name in NAMES:
    with h5py.File(name, "w") as file:
        file["height"] = np.full(SAMPLES, 1.6)
for overview, fill in (("plain.h5", None), ("nan.h5", np.nan)):
    layout = h5py.VirtualLayout((RUNS, SAMPLES), "f8")
    for run, name in enumerate(NAMES):
        layout[run] = h5py.VirtualSource(name, "height", (SAMPLES,))
    with h5py.File(overview, "w") as file:
        file.create_virtual_dataset("height", layout, fillvalue=fill)
        file["link to run 3"] = h5py.ExternalLink(NAMES[3], "height")
print("h5py", h5py.__version__, "HDF5", h5py.version.hdf5_version)
whole = mean_height("plain.h5")
print("all runs there: mean and least height", whole)


def loses(how):
    """What is read after run 3 is gone in one way: without and with a fill value, and by an external link."""
    try:
        with h5py.File("plain.h5") as file:
            link = str(file["link to run 3"][:])
    except KeyError as error:
        link = type(error).__name__
    seen = mean_height("plain.h5"), mean_height("nan.h5"), link
    print(f"{how}: mean and least height {seen[0]}, with fillvalue=NaN {seen[1]}, external link: {seen[2]}")
    return seen


with h5py.File(NAMES[3], "a") as file:
    file.move("height", "head")
renamed = loses("dataset of run 3 renamed")
os.remove(NAMES[3])
removed = loses("file of run 3 removed")
if np.abs(np.array(whole) - 1.6).max() > 1e-12:
    raise SystemExit("CHANGED: runs that are there are read in another way")
for plain, nan, link in (renamed, removed):
    if plain[1] != 0.0 or abs(plain[0] - 1.6 * (RUNS - 1) / RUNS) > 1e-12 or not np.isnan(nan[0]) or link != "KeyError":
        raise SystemExit("CHANGED: a missing run is no longer a run of zeros")
PY
