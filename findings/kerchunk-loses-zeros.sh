#!/usr/bin/env bash
# Seen through kerchunk every 0 of an HDF5 file is missing: NaN.
#
# Expected: references into an HDF5 file give xarray the same values as the file itself.
# Happens: each value that is 0 arrives as NaN; whole numbers and flags are then floats and objects. Opened directly the
#   same file has its zeros.
# Seen with: kerchunk 0.2.10, zarr 3.1.6, xarray 2026.9.0, h5py 3.16.0. kerchunk copies the dataset's fill value, 0 unless set,
#   into the reference, and xarray takes a Zarr (version 2) fill value for the mark of a missing value.
# Means: "no contact", "no torque", "not fallen" become "unknown", and nanmean quietly leaves them out: the mean contact
#   force is that of the frames with contact. Open with mask_and_scale=False.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check \
    kerchunk==0.2.10 zarr==3.1.6 xarray==2026.9.0 h5py==3.16.0 h5netcdf==1.8.2 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import h5py
import kerchunk.hdf
import numpy as np
import xarray

force = np.arange(4000.0)
force[::2] = 0.0  # in the air
with h5py.File("run.h5", "w") as file:
    file.create_dataset("force", data=force, chunks=(1000,))
    file.create_dataset("contacts", data=(force > 0).astype(int), chunks=(1000,))

print(*(f"{name} {version(name)}" for name in ("kerchunk", "zarr", "xarray", "h5py")))
references = kerchunk.hdf.SingleHdf5ToZarr("run.h5").translate()
seen = {}
for label, source, more in (
    ("the file", "run.h5", {"engine": "h5netcdf", "phony_dims": "sort"}),
    ("references", references, {"engine": "kerchunk"}),
    ("unmasked", references, {"engine": "kerchunk", "mask_and_scale": False}),
):
    with xarray.open_dataset(source, **more) as data:
        values, counts = data["force"].values, data["contacts"].values
    seen[label] = int(np.isnan(values).sum()), float(np.nanmean(values)), str(counts.dtype)
    print(f"{label:10s}: {seen[label][0]} NaN, mean force {seen[label][1]:.1f}, contacts are {seen[label][2]}")
if seen["the file"] != (0, 1000.0, "int64") or seen["unmasked"] != (0, 1000.0, "int64") or seen["references"][0] != 2000:
    raise SystemExit("CHANGED: zeros survive the way through kerchunk")
PY
