"""Names for the axes of a log's arrays, for readers of netCDF: dimension scales in the root.

Either every axis has one or none: a file with some of them labelled is one that xarray refuses.
They repeat what the log says elsewhere, so they are no part of its content. A dataset names its
scales (DIMENSION_LIST), a scale not its datasets (REFERENCE_LIST): nobody asks, and PyTables
cannot open what has one.
"""

from collections.abc import Mapping
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from rotctl.log.schema import CONSTANTS, SCHEMA

# Size of the schema: name of the axis, and which dataset has its coordinates.
_NAMES = {
    "steps": ("time", "trajectory/time"),
    "nq": ("q", ""),
    "nv": ("v", ""),
    "nu": ("joint", "model/joint"),
    "capacity": ("slot", ""),
    "events": ("event", ""),
    "tasks": ("task", "model/task"),
    "bodies": ("body", "model/body"),
}
_LABELS = {
    "xyz": (b"x", b"y", b"z"),
    "axis": (b"forward", b"left", b"up"),
    "force_moment": (b"fx", b"fy", b"fz", b"mx", b"my", b"mz"),
}
_REFERENCES = h5py.h5t.vlen_create(h5py.h5t.STD_REF_OBJ)
NAMES = (*(name for name, _ in _NAMES.values()), *CONSTANTS)


def write_scales(
    file: h5py.File, arrays: Mapping[str, NDArray[Any]], sizes: Mapping[str, int]
) -> None:
    """Label every axis of a log whose datasets are there; `coordinates` are written later."""
    scales = {}
    for dim in (*_NAMES, *CONSTANTS):
        name, source = _NAMES.get(dim, (dim, ""))
        scale = file.create_dataset(
            name, data=_coordinates(dim, arrays.get(source), sizes), track_times=False
        )
        h5py.h5ds.set_scale(scale.id, name.encode())
        scales[dim] = np.empty(1, dtype=object)
        scales[dim][0] = np.array([scale.ref], dtype=h5py.ref_dtype)
    for path, spec in SCHEMA.items():
        if spec.shape:
            axes = np.concatenate([scales[dim] for dim in spec.shape])
            shape = h5py.h5s.create_simple((len(axes),))
            h5py.h5a.create(file[path].id, b"DIMENSION_LIST", _REFERENCES, shape).write(axes)


def coordinates(arrays: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Scale -> what is along its axis, of those that a log's arrays tell."""
    return {name: arrays[source] for name, source in _NAMES.values() if source}


def labels(arrays: Mapping[str, Any]) -> dict[str, Any]:
    """Scale -> what is along its axis where that is no number from 0; to check those of a log."""
    told = {name: arrays[source] for name, source in _NAMES.values() if source in arrays}
    return {**told, **{name: np.array(along) for name, along in _LABELS.items()}}


def _coordinates(dim: str, source: NDArray[Any] | None, sizes: Mapping[str, int]) -> NDArray[Any]:
    """What is along an axis: times and names where there are some, else numbers from 0."""
    if source is not None:
        return source
    if dim in _LABELS:
        return np.array(_LABELS[dim])
    return np.arange(CONSTANTS.get(dim, sizes.get(dim, 0)), dtype="<i4")
