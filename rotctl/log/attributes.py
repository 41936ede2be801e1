"""The attributes of a log: a caller's values as HDF5 takes them, and how they are written."""

import json
from collections.abc import Mapping
from typing import Any

import h5py
import numpy as np

from rotctl.errors import InputError
from rotctl.log.schema import ATTRIBUTES, SCHEMA_VERSION, WRITER_ATTRIBUTES

_SCALAR = h5py.h5s.create(h5py.h5s.SCALAR)
_TYPES: dict[type, tuple[h5py.h5t.TypeID, type]] = {  # in a file, and in memory
    str: (h5py.h5t.py_create(h5py.string_dtype("utf-8"), logical=True), object),
    bool: (h5py.h5t.NATIVE_UINT8, np.uint8),
    int: (h5py.h5t.NATIVE_INT64, np.int64),
    float: (h5py.h5t.NATIVE_DOUBLE, np.float64),
}


def root_attributes(given: Mapping[str, Any]) -> dict[str, Any]:
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
        utf8(f"attribute {name!r}", plain)
    if kind is int and not -(2**63) <= plain < 2**63:
        raise InputError(f"attribute {name!r} must fit in 64 bits, got {plain}")
    checked: bool | int | float | str = kind(plain)
    return checked


def _json_scalar(value: Any) -> Any:
    if isinstance(value, np.generic):
        return value.item()
    raise InputError(f"cannot store a {type(value).__name__} as JSON")


def utf8(name: str, text: str) -> bytes:
    """Returns the bytes of a text that HDF5 can give back unchanged."""
    try:
        encoded = text.encode("utf-8")
    except UnicodeEncodeError as error:
        raise InputError(f"{name} is not valid Unicode text") from error
    if b"\0" in encoded:
        raise InputError(f"{name} contains a NUL character")
    return encoded


def write_attribute(
    owner: h5py.Dataset | h5py.Group, name: str, value: bool | int | float | str
) -> None:
    """As `owner.attrs[name] = value`, in two thirds of its time; a log has over a hundred."""
    stored, held = _TYPES[type(value)]
    attribute = h5py.h5a.create(owner.id, name.encode(), stored, _SCALAR)
    attribute.write(np.array(value, dtype=held))
