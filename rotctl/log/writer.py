"""A finished run -> one HDF5 file that is either whole or not there.

The file is made in memory and reaches the disk as plain bytes: a kill before the rename leaves
at most a ``.part``, and a full disk is an ordinary ``OSError``, not an HDF5 one.
"""

import json
from collections.abc import Mapping
from functools import lru_cache
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np
from numpy.typing import NDArray

from rotctl import files
from rotctl.errors import InputError
from rotctl.log.buffer import TrajectoryBuffer
from rotctl.log.digest import content_sha256, simulated
from rotctl.log.image import Image, place_of
from rotctl.log.scales import coordinates, write_scales
from rotctl.log.schema import (
    ATTRIBUTES,
    GROUPS,
    MODEL_PATH,
    SCHEMA,
    SCHEMA_VERSION,
    WRITER_ATTRIBUTES,
    check_layout,
)

if TYPE_CHECKING:
    from hashlib import _Hash as Hash

_CHUNK_BYTES = 2**20
_CHUNK_SLOTS = (
    16  # of contacts, beyond which a roll has hardly ever one: what is empty is not stored
)
# What has a row a step and a value where nobody has written: slots of contacts, and whole numbers.
_PACKED = {n for n, spec in SCHEMA.items() if "steps" in spec.shape and spec.dtype != "<f8"}
_GZIP_LEVEL = 1  # of which 4 spares a hundredth more, for a third of the time


def write_run(
    path: str | Path,
    run: TrajectoryBuffer | Mapping[str, NDArray[Any]],
    *,
    model_xml: str,
    attributes: Mapping[str, Any],
) -> None:
    """Writes one run to ``path``, atomically and durably.

    Args:
        path: the final file; its folder must exist. An older file there is replaced.
        run: the buffer, or schema path -> array without the model.
        model_xml: self-contained MJCF.
        attributes: ``config``, ``run_id``, ``seed``, ``versions``, ``git_commit``, ``git_dirty``,
            ``machine``, ``wall_time`` [s], ``outcome``. Mappings are stored as JSON.

    Raises:
        InputError: ``cannot write <path>: <reason>``; nothing is left behind.
    """
    try:
        content = encode_run(run, model_xml=model_xml, attributes=attributes)
    except InputError as error:
        raise InputError(f"cannot write {path}: {error}") from error
    write_log(path, content)


def write_log(path: str | Path, content: bytes) -> None:
    """Writes the bytes that `encode_run` made, atomically and durably.

    Raises:
        InputError: ``cannot write <path>: <reason>``; nothing is left behind.
    """
    files.replace(Path(path), content, durable=True)


def whole(
    run: TrajectoryBuffer | Mapping[str, NDArray[Any]], model_xml: str
) -> dict[str, NDArray[Any]]:
    """Returns all arrays of a run, its model with them; arguments as for ``write_run``.

    Raises:
        InputError: the model's text cannot be stored.
    """
    arrays = dict(run.arrays() if isinstance(run, TrajectoryBuffer) else run)
    return {**arrays, MODEL_PATH: np.array(_utf8("model_xml", model_xml))}


def encode_run(
    run: TrajectoryBuffer | Mapping[str, NDArray[Any]],
    *,
    model_xml: str,
    attributes: Mapping[str, Any],
    digest: "Hash | None" = None,
) -> bytes:
    """Returns the HDF5 file of a run; equal input gives equal bytes.

    Args:
        run: as for ``write_run``.
        model_xml: as for ``write_run``.
        attributes: as for ``write_run``.
        digest: of ``whole(run, model_xml)``, where it is there already; see ``simulated``.

    Raises:
        InputError: an array, an attribute or the model does not fit the schema.
    """
    arrays = whole(run, model_xml)
    stored = {name: _stored(array) for name, array in arrays.items()}
    image = _empty(
        tuple((name, a.dtype, a.shape, a.dtype.metadata is not None) for name, a in stored.items())
    )
    stored |= coordinates(arrays)
    root = _root_attributes(attributes)
    root["content_sha256"] = content_sha256(digest or simulated(arrays), root)
    opened = h5py.h5f.open_file_image(image.filled(stored), h5py.h5f.FILE_IMAGE_OPEN_RW)
    with h5py.File(opened) as file:
        for name, array in stored.items():
            if name not in image.places:
                _fill(opened, name, array)
        top = file["/"]
        for name, value in {**root, "complete": True}.items():
            _write_attribute(top, name, value)
        file.flush()
        content: bytes = opened.get_file_image()
    return content


def _fill(file: h5py.h5f.FileID, name: str, array: NDArray[Any]) -> None:
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


def _stored(array: NDArray[Any]) -> NDArray[Any]:
    """An array as HDF5 takes it."""
    if array.dtype.kind == "S" and not array.tobytes().isascii():
        array = array.astype(h5py.string_dtype("utf-8", array.dtype.itemsize))
    if array.dtype == bool:  # HDF5 has none, and few know h5py's enum
        array = array.view(np.uint8)
    return np.require(array, requirements="C")


@lru_cache(maxsize=8)
def _empty(layout: tuple[tuple[str, "np.dtype[Any]", tuple[int, ...], bool], ...]) -> Image:
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
            _write_attribute(dataset, "units", spec.unit)
            _write_attribute(dataset, "description", spec.description)
            none[name] = np.zeros(shape, dtype)
            if prod(shape) and name not in _PACKED and storage.get("chunks", shape) == shape:
                dataset[...] = none[name]  # room for what is stored as it is
        write_scales(file, none, sizes)
        names = [name for name in (*SCHEMA, *coordinates(none)) if name not in _PACKED]
        places = {name: place_of(file[name]) for name in names if file[name].size}
        file.flush()
        content: bytes = file.id.get_file_image()
    return Image(content, {name: place for name, place in places.items() if place})


_SCALAR = h5py.h5s.create(h5py.h5s.SCALAR)
_TYPES: dict[type, tuple[h5py.h5t.TypeID, type]] = {  # in a file, and in memory
    str: (h5py.h5t.py_create(h5py.string_dtype("utf-8"), logical=True), object),
    bool: (h5py.h5t.NATIVE_UINT8, np.uint8),
    int: (h5py.h5t.NATIVE_INT64, np.int64),
    float: (h5py.h5t.NATIVE_DOUBLE, np.float64),
}


def _write_attribute(
    owner: h5py.Dataset | h5py.Group, name: str, value: bool | int | float | str
) -> None:
    """As `owner.attrs[name] = value`, in two thirds of its time; a log has over a hundred."""
    stored, held = _TYPES[type(value)]
    attribute = h5py.h5a.create(owner.id, name.encode(), stored, _SCALAR)
    attribute.write(np.array(value, dtype=held))


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
    fill = {"fillvalue": SCHEMA[name].fill} if name in _PACKED else {}
    packed = {"compression": "gzip", "compression_opts": _GZIP_LEVEL, "shuffle": True}
    return {**checked, **packed, **fill}


def _root_attributes(given: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the caller's attributes as plain values, in schema order, with the version."""
    wanted = [name for name in ATTRIBUTES if name not in WRITER_ATTRIBUTES]
    for name in given:
        if name not in wanted:
            raise InputError(f"unknown attribute {name!r}; valid names: {', '.join(wanted)}")
    plain: dict[str, Any] = {"schema_version": SCHEMA_VERSION}
    for name in wanted:
        if name not in given:
            raise InputError(f"missing attribute {name!r}")
        plain[name] = _plain(name, given[name])
    return plain


def _plain(name: str, value: Any) -> bool | int | float | str:
    plain: Any = value.item() if isinstance(value, np.generic) else value
    if isinstance(plain, Mapping):
        plain = json.dumps(dict(plain), default=_json_scalar)
    kind, given = ATTRIBUTES[name], type(plain)
    if given is not kind and (given, kind) != (int, float):
        raise InputError(f"attribute {name!r} must be {kind.__name__}, got {given.__name__}")
    if kind is str:
        _utf8(f"attribute {name!r}", plain)
    if kind is int and not -(2**63) <= plain < 2**63:
        raise InputError(f"attribute {name!r} must fit in 64 bits, got {plain}")
    checked: bool | int | float | str = kind(plain)
    return checked


def _json_scalar(value: Any) -> Any:
    if isinstance(value, np.generic):
        return value.item()
    raise InputError(f"cannot store a {type(value).__name__} as JSON")


def _utf8(name: str, text: str) -> bytes:
    """Returns the bytes of a text that HDF5 can give back unchanged."""
    try:
        encoded = text.encode("utf-8")
    except UnicodeEncodeError as error:
        raise InputError(f"{name} is not valid Unicode text") from error
    if b"\0" in encoded:
        raise InputError(f"{name} contains a NUL character")
    return encoded
