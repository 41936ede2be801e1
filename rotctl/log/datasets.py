"""The datasets of a log: how each is stored, made without data, and filled."""

from functools import lru_cache
from math import prod
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from rotctl.log.attributes import write_attribute
from rotctl.log.conformity import check_layout
from rotctl.log.image import Image, place_of
from rotctl.log.scales import coordinates, write_scales
from rotctl.log.schema import GROUPS, SCHEMA

_CHUNK_BYTES = 2**20
_CHUNK_SLOTS = 16  # of contacts: a roll has hardly ever more, and what is empty is not stored
# What has a row a step and a value where nobody has written: slots of contacts, and whole numbers.
_PACKED = {n for n, spec in SCHEMA.items() if "steps" in spec.shape and spec.dtype != "<f8"}
_GZIP_LEVEL = 1  # of which 4 spares a hundredth more, for a third of the time


@lru_cache(maxsize=8)
def empty(layout: tuple[tuple[str, "np.dtype[Any]", tuple[int, ...], bool], ...]) -> Image:
    """A file without data: to make its datasets takes twice as long as to fill them.

    Args:
        layout: name, type, shape and whether it is UTF-8, of every dataset.

    Raises:
        LogError: they do not fit the schema.
    """
    shapes = {name: (dtype, shape) for name, dtype, shape, _ in layout}
    sizes = check_layout(shapes)
    with h5py.File("empty", "w", driver="core", backing_store=False) as file:
        groups = {name: file.create_group(name) for name in GROUPS}
        none = {}
        for name, spec in SCHEMA.items():
            group, _, leaf = name.partition("/")
            dtype, shape = shapes[name]
            storage = _storage(name, dtype, shape)
            dataset = groups[group].create_dataset(leaf, shape, dtype, track_times=False, **storage)
            write_attribute(dataset, "units", spec.unit)
            write_attribute(dataset, "description", spec.description)
            none[name] = np.zeros(shape, dtype)
            if prod(shape) and name not in _PACKED and storage.get("chunks", shape) == shape:
                dataset[...] = none[name]  # room for what is stored as it is
        write_scales(file, none, sizes)
        names = [name for name in (*SCHEMA, *coordinates(none)) if name not in _PACKED]
        places = {name: place_of(file[name]) for name in names if file[name].size}
        file.flush()
        content: bytes = file.id.get_file_image()
    return Image(content, {name: place for name, place in places.items() if place})


def _storage(name: str, dtype: "np.dtype[Any]", shape: tuple[int, ...]) -> dict[str, Any]:
    """Whole rows in chunks of about 1 MiB; HDF5 cannot chunk scalar or empty datasets.

    Double precision is stored as it is: the digits of a simulation look random, and gzip would
    spare a tenth of them for half of the time that a log takes. Slots of contacts are in chunks
    of their own, as most are empty.
    """
    if not shape or not prod(shape):
        return {}
    row = shape[1:]
    if name in _PACKED and row:
        row = (min(row[0], _CHUNK_SLOTS), *row[1:])
    rows = min(shape[0], max(1, _CHUNK_BYTES // (dtype.itemsize * prod(row))))
    checked = {"chunks": (rows, *row), "fletcher32": True}
    if dtype == np.float64:
        return checked
    packed = {"compression": "gzip", "compression_opts": _GZIP_LEVEL, "shuffle": True}
    blank = {"fillvalue": SCHEMA[name].fill} if name in _PACKED else {}
    return {**checked, **packed, **blank}


def fill(file: h5py.h5f.FileID, name: str, array: NDArray[Any]) -> None:
    """Write an array into its dataset, less what reads the same where nobody has written."""
    part = h5py.h5s.ALL
    if name in _PACKED and array.size:
        slots = _slots_used(array, SCHEMA[name].fill)
        if not slots:
            return
        if array.ndim > 1:
            part = h5py.h5s.create_simple(array.shape)
            part.select_hyperslab((0,) * array.ndim, (len(array), slots, *array.shape[2:]))
    if array.size:
        h5py.h5d.open(file, name.encode()).write(part, part, array)


def _slots_used(array: NDArray[Any], fill: int) -> int:
    """How many slots of (steps, slots, ...) hold something, rounded up to chunks; 1 of (steps,)."""
    bits = array.view(f"i{array.itemsize}")  # a zero with a sign is something
    if array.ndim == 1:
        return int((bits != fill).any())
    starts = range(0, array.shape[1], _CHUNK_SLOTS)
    used = [first for first in starts if (bits[:, first : first + _CHUNK_SLOTS] != fill).any()]
    return min(used[-1] + _CHUNK_SLOTS, array.shape[1]) if used else 0
