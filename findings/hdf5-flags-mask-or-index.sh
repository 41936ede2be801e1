#!/usr/bin/env bash
# The flags of an HDF5 file select rows with one xarray engine and pick rows 0 and 1 with the other.
#
# Expected: an array of booleans written by h5py is an array of booleans to xarray, whatever engine opens the file.
# Happens: with engine="h5netcdf" it is bool; with engine="netcdf4", which xarray takes by itself when both are
#   installed, it is int8. force[used] then means "row 1 and row 0, over and over" where it meant "where used": an
#   array of another length, finite, without an error.
# Seen with: xarray 2026.9.0, netCDF4 1.7.5.1.post1, h5netcdf 1.8.2, h5py 3.16.0. HDF5 has no boolean: h5py stores an enum
#   over int8, h5netcdf knows the custom, the netCDF library sees the integers.
# Means: a mean contact force over "the contacts in use" is that of the first two slots on the colleague's machine that
#   has one more package. Write flags as uint8 and cast on reading, or name the engine.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check \
    xarray==2026.9.0 netCDF4==1.7.5.1.post1 h5netcdf==1.8.2 h5py==3.16.0 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import h5py
import numpy as np
import xarray

with h5py.File("contacts.h5", "w") as file:
    file["force"] = np.array([10.0, 0.0, 30.0, 40.0])
    file["used"] = np.array([True, False, True, True])

print(*(f"{name} {version(name)}" for name in ("xarray", "netCDF4", "h5netcdf", "h5py")))
seen = {}
for label, choice in (("h5netcdf", {"engine": "h5netcdf", "phony_dims": "sort"}), ("netcdf4", {"engine": "netcdf4"}), ("none named", {})):
    with xarray.open_dataset("contacts.h5", **choice) as data:
        used, force = data["used"].values, data["force"].values
        seen[label] = str(used.dtype), force[used].tolist()
    print(f"engine {label:10s}: used is {seen[label][0]:5s} force[used] = {seen[label][1]}")
masked, picked = ("bool", [10.0, 30.0, 40.0]), ("int8", [0.0, 10.0, 0.0, 0.0])
if seen != {"h5netcdf": masked, "netcdf4": picked, "none named": picked}:
    raise SystemExit("CHANGED: the engines agree on what a boolean dataset is")
PY
