#!/usr/bin/env bash
# Attach a dimension scale the way HDF5 does, and PyTables can no longer walk the file.
#
# Expected: PyTables warns of attributes that it does not know, as it does of DIMENSION_LIST on the labelled array, and reads
#   the data all the same.
# Happens: the scale's own back reference, REFERENCE_LIST (a compound with an object reference), is no warning but a
#   KeyError: 'Reference', out of walk_nodes and out of every access to the scale. The labelled array itself can be read.
#   Without REFERENCE_LIST all is read, and xarray has the same names: netCDF4 and h5netcdf go by DIMENSION_LIST alone.
# Seen with: tables 3.11.1, h5py 3.16.0, xarray 2026.9.0, h5netcdf 1.8.2, numpy 2.4.6.
# Means: a file that is to be read by xarray and by PyTables gets its DIMENSION_LIST by hand instead of attach_scale.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check \
    tables==3.11.1 h5py==3.16.0 xarray==2026.9.0 h5netcdf==1.8.2 numpy==2.4.6
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import h5py
import numpy as np
import tables
import xarray

with h5py.File("a.h5", "w") as file:
    file["time"], file["height"] = np.arange(4.0), np.ones(4)
    file["time"].make_scale("time")
    file["height"].dims[0].attach_scale(file["time"])


def walked():
    with tables.open_file("a.h5") as file:
        try:
            return f"{len(list(file.walk_nodes('/', 'Leaf')))} arrays"
        except KeyError as error:
            return f"KeyError: {error}"


print(*(f"{name} {version(name)}" for name in ("tables", "h5py", "xarray", "h5netcdf")))
as_attached = walked()
with h5py.File("a.h5", "r+") as file:
    del file["time"].attrs["REFERENCE_LIST"]
without = walked()
with xarray.open_dataset("a.h5", engine="h5netcdf") as data:
    axes = data["height"].dims
print(f"as attached: {as_attached}\nwithout REFERENCE_LIST: {without}; xarray's axes of height: {axes}")
if (as_attached, without, axes) != ("KeyError: 'Reference'", "2 arrays", ("time",)):
    raise SystemExit("CHANGED: PyTables opens a scale with its references, or xarray needs them")
PY
