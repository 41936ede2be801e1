#!/usr/bin/env bash
# Append a run to a Zarr store with xarray, and the joints of all earlier runs change names.
#
# Expected: to_zarr(append_dim="seed") goes by names, as everything in xarray does: a run that lists its joints in another order is put in
#   order, as concat of the same two does, or refused, as one of another length is.
# Happens: the numbers are appended by position, and each coordinate without the appended dimension is written over by that of the last run.
#   What was the hip of earlier runs is now their ankle. A joint that did not exist before takes over the numbers of the one in its
#   place. Nothing is said.
# Seen with: xarray 2026.9.0, zarr 3.1.6; xarray's issue 11101 tells of pressure levels.
# Means: a log that grows run by run is right up to the first run of a model with its limbs in another order, or of a reader that sorts them,
#   and after it all of it is wrong, not only the new run. No copy of the old names is left in the store. Compare the coordinates before each append,
#   or give each run its own group.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check xarray==2026.9.0 zarr==3.1.6 numpy==2.4.6 pandas==2.3.3
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import numpy as np
import xarray as xr
import zarr


def run(seed, peaks):  # peak torques by joint, N m
    names, torques = zip(*peaks.items())
    return xr.Dataset({"peak": (("seed", "joint"), [list(torques)])}, coords={"seed": [seed], "joint": np.array(names)})


runs = [run(0, {"hip": 100, "knee": 60, "ankle": 30}), run(1, {"ankle": 31, "hip": 101, "knee": 61}), run(2, {"hip": 102, "knee": 62, "wrist": 5})]
print("xarray", xr.__version__, "zarr", zarr.__version__)
runs[0].to_zarr("log.zarr")
stored = []
for one in runs[1:]:
    one.to_zarr("log.zarr", append_dim="seed")
    stored.append(xr.open_zarr("log.zarr").load()["peak"])
in_memory = xr.concat(runs[:2], "seed", join="outer")["peak"]
print("concat of the first two runs:", in_memory.to_pandas(), "appended to the store:", stored[0].to_pandas(), "and the third:", stored[1].to_pandas(), sep="\n")
ankle = [int(x.sel(seed=0, joint="ankle")) for x in (in_memory, stored[0])]
if ankle != [30, 100] or int(stored[1].sel(seed=0, joint="wrist")) != 30:
    raise SystemExit("CHANGED: earlier runs keep the names of their joints")
try:
    run(3, {"hip": 103, "knee": 63}).to_zarr("log.zarr", append_dim="seed")
except ValueError:
    print("a run of two joints: refused")
else:
    raise SystemExit("CHANGED: another number of joints is no longer refused")
PY
