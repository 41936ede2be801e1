#!/usr/bin/env bash
# Label the time axis of an HDF5 file and xarray can no longer open it.
#
# Expected: attaching a dimension scale to the first axis of a dataset adds a time coordinate; the other axes stay
#   anonymous, as all of them were before.
# Happens: a file without any scale opens (axes phony_dim_0, phony_dim_1). The same file with time attached to the first
#   axis of a two-dimensional dataset does not: h5netcdf refuses a "mixing of labeled and unlabeled dimensions", and
#   netCDF4 ends in an AttributeError about None. h5py and HDF5's own tools see nothing wrong.
# Seen with: xarray 2026.9.0, netCDF4 1.7.5.1.post1, h5netcdf 1.8.2, h5py 3.16.0. The netCDF data model has a name for
#   every axis or works in a mode where it makes up all of them.
# Means: a half-done improvement to a log's metadata locks out the readers it was meant for. Scales on every axis (joints
#   and components too) or on none.
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


def write(name, labelled):
    """A log of four frames of three joints, with as many axes of qpos labelled."""
    with h5py.File(name, "w") as file:
        file["time"], file["joint"], file["qpos"] = np.arange(4.0), np.arange(3), np.zeros((4, 3))
        for axis, scale in enumerate(("time", "joint")[:labelled]):
            file[scale].make_scale(scale)
            file["qpos"].dims[axis].attach_scale(file[scale])


print(*(f"{name} {version(name)}" for name in ("xarray", "netCDF4", "h5netcdf", "h5py")))
opens = {}
for labelled in (0, 1, 2):
    name = f"{labelled}.h5"
    write(name, labelled)
    for engine, more in (("h5netcdf", {"phony_dims": "sort"}), ("netcdf4", {})):
        try:
            with xarray.open_dataset(name, engine=engine, **more) as data:
                said = str(dict(data["qpos"].sizes))
                opens[labelled, engine] = True
        except (ValueError, AttributeError) as error:
            said = f"{type(error).__name__}: {error}"
            opens[labelled, engine] = False
        print(f"{labelled} of 2 axes labelled, {engine:8s}: {said}")
if [opens[labelled, engine] for labelled in (0, 1, 2) for engine in ("h5netcdf", "netcdf4")] != [True, True, False, False, True, True]:
    raise SystemExit("CHANGED: a file with some axes labelled opens, or one with none or all does not")
PY
