"""Bounds on motion files from strangers, and the numbers in their lines."""

import zipfile
from dataclasses import dataclass
from io import BytesIO
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from rotctl import files
from rotctl.errors import InputError
from rotctl.maths.rotations import Array

MAX_BYTES = 32_000_000  # minutes of capture
MAX_ARCHIVE = 100_000_000  # of arrays, packed
MAX_ARRAY = 200_000_000
LARGEST = 1e6  # no angle and no length in any unit is as large


def text_of(path: Path) -> str:
    """The text of a file of at most `MAX_BYTES`.

    Raises:
        InputError: `<path>: <reason>`.
    """
    return files.text(path, MAX_BYTES, linked=True)


def numbers(where: str, words: list[str], count: int) -> list[float]:
    """Exactly `count` numbers.

    Raises:
        InputError: something else; `where` is the file and the line.
    """
    if len(words) != count:
        raise InputError(f"{where}: {len(words)} values, {count} expected")
    for word in words:
        try:
            good = abs(float(word)) < LARGEST  # not so for nan
        except ValueError:
            good = False
        if not good:
            raise InputError(f"{where}: {word!r:.40} is no number")
    return [float(word) for word in words]


def arrays_of(path: Path) -> "Arrays":
    """The arrays of an .npz file, none of which is read yet.

    Raises:
        InputError: it is no .npz.
    """
    content = files.read(path, MAX_ARCHIVE, linked=True)
    try:
        archive = zipfile.ZipFile(BytesIO(content))
    except (zipfile.BadZipFile, ValueError, NotImplementedError):
        raise InputError(f"{path}: is no .npz") from None
    names = archive.namelist()
    return Arrays(path, archive, {name.removesuffix(".npy"): name for name in names[:1000]})


@dataclass(frozen=True)
class Arrays:
    """Arrays by name: of numbers or texts, of bounded size; no objects, which could run code."""

    path: Path
    _archive: zipfile.ZipFile
    _members: dict[str, str]

    def __contains__(self, name: str) -> bool:
        return name in self._members

    @property
    def names(self) -> str:
        """What there is, for messages."""
        return f"{', '.join(self._members):.300}"

    def numbers(self, name: str, *shape: int | None) -> Array:
        """An array of finite numbers; of a size where `shape` has one, None is any.

        Raises:
            InputError: it is missing or something else.
        """
        found = self._read(name)
        if found.dtype.kind not in "iuf":
            raise InputError(f"{self.path}: {name} holds no numbers")
        fits = len(found.shape) == len(shape) and all(
            size is None or size == there for size, there in zip(shape, found.shape, strict=True)
        )
        if not fits:
            sizes = " x ".join("any" if size is None else str(size) for size in shape)
            raise InputError(
                f"{self.path}: {name} is {found.shape}, expected {sizes or 'a number'}"
            )
        numbers = found.astype(np.float64)
        if not (np.abs(numbers) < LARGEST).all():  # not so for nan
            raise InputError(f"{self.path}: {name} holds what is no number")
        return np.asarray(numbers)

    def number(self, name: str) -> float:
        """A single number, whether in a list of one or not."""
        found = self._read(name)
        if found.size != 1 or found.dtype.kind not in "iuf":
            raise InputError(f"{self.path}: {name} is not one number")
        return float(found.reshape(-1)[0])

    def texts(self, name: str) -> list[str]:
        """A list of texts; empty where it is none."""
        found = self._read(name)
        return [str(text) for text in found.reshape(-1)[:1000]] if found.dtype.kind == "U" else []

    def _read(self, name: str) -> "np.ndarray[Any, Any]":
        if name not in self._members:
            raise InputError(f"{self.path}: has no {name}; it has: {self.names}")
        try:
            with self._archive.open(self._members[name]) as member:
                content = member.read(MAX_ARRAY + 1)
            if len(content) > MAX_ARRAY:
                raise InputError(f"{self.path}: {name} is larger than {MAX_ARRAY / 1e6:g} MB")
            _require_whole(content)
            return np.asarray(np.lib.format.read_array(BytesIO(content), allow_pickle=False))
        except InputError:
            raise
        except Exception:  # whatever zlib, zipfile and numpy say of a damaged array
            raise InputError(f"{self.path}: {name} is damaged, or holds Python objects") from None


def _require_whole(content: bytes) -> None:
    """Refuse a header that promises more than follows, before memory is taken for it."""
    stream = BytesIO(content)
    version = np.lib.format.read_magic(stream)
    read = (
        np.lib.format.read_array_header_1_0
        if version[0] == 1
        else np.lib.format.read_array_header_2_0
    )
    shape, _, dtype = read(stream)
    if dtype.hasobject or prod(shape) * dtype.itemsize > len(content):
        raise ValueError
