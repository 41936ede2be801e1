"""An HDF5 file from a stranger -> objects that are safe to read.

Only hard links are walked, only data inside the file is read, and only through filters that HDF5
itself brings. Sizes are judged from declared shapes, before anything is allocated.
"""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from math import prod
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from rotctl import files
from rotctl.errors import InputError, LogError
from rotctl.log import scales
from rotctl.log.schema import ATTRIBUTES, GROUPS, OLDEST_READ, SCHEMA_VERSION
from rotctl.settings.documents import UNPRINTABLE

_FILTERS = {h5py.h5z.FILTER_DEFLATE, h5py.h5z.FILTER_SHUFFLE, h5py.h5z.FILTER_FLETCHER32}

SMALL_BYTES = 2**26  # of data that any file may declare
# Times a file's size, beyond that: empty slots of contacts take no room, and 1024 of them beside a
# row of the smallest character are 100 times that row.
MOST_PACKED = 128
MAX_CHUNK_BYTES = 2**26

# What h5py raises, in our experience of damaged files.
_DAMAGE = (OSError, RuntimeError, KeyError, ValueError, TypeError, OverflowError, MemoryError)


@contextmanager
def opened(path: Path, *, linked: bool) -> Iterator[h5py.File]:
    """Opens a file for reading; whatever goes wrong inside becomes one line with its path.

    Args:
        linked: see `rotctl.files.opened`.

    Raises:
        LogError: ``<path>: <reason>``.
    """
    try:
        files.opened(path, linked=linked).close()
    except InputError as error:
        raise LogError(str(error)) from None
    if not h5py.is_hdf5(path):
        raise LogError(f"{path}: not an HDF5 file")
    try:
        with _file(path) as file:
            yield file
    except LogError as error:
        raise LogError(f"{path}: {error}") from error
    except _DAMAGE as error:
        raise LogError(f"{path}: truncated or damaged HDF5 file") from error


def _file(path: Path) -> h5py.File:
    """Logs appear whole and never change, and many network file systems cannot lock.

    What this process has open with locks, as h5py does by itself, opens in the same way alone.
    """
    try:
        return h5py.File(path, "r", locking=False)
    except OSError:
        return h5py.File(path, "r")


def root_attributes(file: h5py.File) -> dict[str, bool | int | float | str]:
    """Returns the root attributes, all of them and no others, each of its type.

    Raises:
        LogError: the file is foreign, of another version, incomplete or tampered with.
    """
    if "schema_version" not in file.attrs:
        raise LogError("not a rotctl log (no schema_version)")
    version = attribute(file, "schema_version")
    if type(version) is not int:
        raise LogError("not a rotctl log (schema_version is not a number)")
    if not OLDEST_READ <= version <= SCHEMA_VERSION:
        raise LogError(
            f"schema version {version}, this rotctl reads {OLDEST_READ} to {SCHEMA_VERSION}"
        )
    if "complete" not in file.attrs or _truth(attribute(file, "complete")) is not True:
        raise LogError("incomplete, the run was cut off while it was written")
    for name in file.attrs:
        if name not in ATTRIBUTES:
            raise LogError(f"unknown attribute {name!r}")
    attributes = {}
    for name, kind in ATTRIBUTES.items():
        if name not in file.attrs:
            raise LogError(f"missing attribute {name!r}")
        found = attribute(file, name)
        attributes[name] = _truth(found) if kind is bool else found
        if type(attributes[name]) is not kind:
            raise LogError(f"attribute {name!r} is not of type {kind.__name__}")
    return attributes


def _truth(value: bool | int | float | str) -> bool | int | float | str:
    """A truth value that is stored as 0 or 1."""
    return bool(value) if type(value) is int and value in (0, 1) else value


def attribute(owner: h5py.Group | h5py.Dataset, name: str) -> bool | int | float | str:
    """Reads one scalar attribute; arrays, references and compounds are refused unread.

    Raises:
        LogError: it is no scalar number, truth value or text.
    """
    identifier = owner.attrs.get_id(name)
    dtype = identifier.dtype
    simple = dtype.kind in "biuf" or h5py.check_string_dtype(dtype) is not None
    if not simple or identifier.shape != ():
        raise LogError(f"attribute {name!r} is not a plain value")
    value = owner.attrs[name]
    plain: bool | int | float | str = value.item() if isinstance(value, np.generic) else value
    if isinstance(plain, str) and UNPRINTABLE.search(plain):  # or no UTF-8: h5py lets it through
        raise LogError(f"attribute {name!r} has a control character")
    return plain


def datasets(file: h5py.File) -> dict[str, h5py.Dataset]:
    """Returns all datasets by path; refuses links, foreign groups and unsafe storage.

    Raises:
        LogError: the file holds something that a log does not.
    """
    found = {}
    for group_name in file:
        group = _child(file, group_name)
        if group_name in scales.NAMES and isinstance(group, h5py.Dataset):
            continue  # says again what is in a group, see `scale`
        if group_name not in GROUPS or not isinstance(group, h5py.Group):
            raise LogError(f"unknown object {group_name!r}")
        for name in group:
            found[f"{group_name}/{name}"] = dataset(file, group_name, name)
    return found


def require_no_bomb(size: int, datasets: Iterable[h5py.Dataset]) -> None:
    """Refuses data that would take far more memory than the file takes on the disk.

    Args:
        size: of the file [bytes].

    Raises:
        LogError: it would; no run that rotctl has logged comes near.
    """
    total = sum(d.dtype.itemsize * prod(d.shape or ()) for d in datasets)
    if total > SMALL_BYTES + MOST_PACKED * size:
        raise LogError(f"declares {total} bytes of data, but has {size} bytes")


def _child(group: h5py.Group, name: str) -> Any:
    """Returns a member of ``group`` that lives in this very file."""
    path = f"{group.name}/{name}".lstrip("/")
    link = group.get(name, getlink=True)
    if link is None:
        raise LogError(f"{path!r} cannot be found")
    if not isinstance(link, h5py.HardLink):
        kind = "an external" if isinstance(link, h5py.ExternalLink) else "a soft"
        raise LogError(f"{path!r} is {kind} link")
    return group[name]


def dataset(file: h5py.File, group_name: str, name: str) -> h5py.Dataset:
    """Returns a dataset whose bytes are inside the file and need no plugin to be read.

    Raises:
        LogError: it is something else.
    """
    return _safe(_child(_child(file, group_name), name), f"{group_name}/{name}")


def scale(file: h5py.File, name: str) -> h5py.Dataset | None:
    """Returns what is along an axis, of a log that says it.

    Raises:
        LogError: as for `dataset`.
    """
    return _safe(_child(file, name), name) if name in file else None


def _safe(found: Any, path: str) -> h5py.Dataset:
    if not isinstance(found, h5py.Dataset):
        raise LogError(f"unknown object {path!r}")
    if found.is_virtual:
        raise LogError(f"{path!r} is a virtual dataset")
    if found.external:
        raise LogError(f"{path!r} is stored outside the file")
    creation = found.id.get_create_plist()
    filters = {creation.get_filter(i)[0] for i in range(creation.get_nfilters())}
    if not filters <= _FILTERS:
        raise LogError(f"{path!r} needs a foreign filter")
    if found.chunks and prod(found.chunks) * found.dtype.itemsize > MAX_CHUNK_BYTES:
        raise LogError(f"{path!r} has absurdly large chunks")
    return found
