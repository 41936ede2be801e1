"""A log's file before its data are in it, and the places of what is stored as it is in memory.

To open a dataset and to close it takes HDF5 longer than to fill it. But contiguous data, and one
chunk that is not compressed, have their place in the file as soon as it is made: their bytes go
there, and HDF5's checksum after those of a chunk.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import h5py
import numpy as np
from numpy.typing import NDArray

_LANES = 64  # words of 16 bits that are summed side by side


class Place(NamedTuple):
    """Where a dataset's data begin in the file, and whether a checksum follows them."""

    begin: int
    checked: bool


@dataclass(frozen=True)
class Image:
    """A file and the places in it.

    Attributes:
        content: of the file.
        places: dataset -> where its data are, if they are stored as they are.
    """

    content: bytes
    places: Mapping[str, Place]

    def filled(self, arrays: Mapping[str, NDArray[Any]]) -> bytes:
        """The file with those of the arrays in it that have a place."""
        content = bytearray(self.content)
        checked = [name for name, place in self.places.items() if place.checked]
        sums = dict(zip(checked, fletcher32([arrays[name] for name in checked]), strict=True))
        for name, (begin, _) in self.places.items():
            array = arrays[name]
            end = begin + array.nbytes
            content[begin:end] = array.reshape(-1).view(np.uint8).data
            if name in sums:
                content[end : end + 4] = sums[name].to_bytes(4, "little")
        return bytes(content)


def place_of(dataset: h5py.Dataset) -> Place | None:
    """Where the data of a dataset are that is in one piece; None where HDF5 changes them."""
    if dataset.chunks is None:
        begin = dataset.id.get_offset()
        return None if begin is None else Place(begin, checked=False)
    if dataset.chunks != dataset.shape or dataset.compression or dataset.shuffle:
        return None
    return Place(dataset.id.get_chunk_info(0).byte_offset, checked=dataset.fletcher32)


def fletcher32(arrays: Sequence[NDArray[Any]]) -> list[int]:
    """The checksum that HDF5's filter of that name has of the bytes of each array.

    Two sums over words w of 16 bits, both modulo 65535: of w, and of w times the number of words
    from there to the end. HDF5 takes the first byte of a word as the higher one, which modulo
    65535 is 256 times the word as it is here.

    Args:
        arrays: of an even number of bytes, at least 2 and at most 2 MiB, little-endian.
    """
    if not arrays:
        return []
    counts = [array.nbytes // 2 for array in arrays]
    rows = [-(-count // _LANES) for count in counts]
    begins = np.cumsum([0, *rows[:-1]])
    words = np.zeros(sum(rows) * _LANES, dtype="<u2")
    for array, begin, count in zip(arrays, (begins * _LANES).tolist(), counts, strict=True):
        words[begin : begin + count] = array.reshape(-1).view("<u2")
    wide = words.reshape(-1, _LANES).astype(np.uint32)
    across = np.einsum("ij->i", wide).astype(np.int64)
    within = np.einsum("ij,j->i", wide, np.arange(_LANES, dtype=np.uint32)).astype(np.int64)
    before = np.arange(len(across)) - np.repeat(begins, rows)  # rows of the same array
    ahead = np.repeat(counts, rows) - _LANES * before
    first = np.add.reduceat(across, begins)
    second = np.add.reduceat(ahead * across - within, begins)
    return [
        _folded(high) << 16 | _folded(low)
        for low, high in zip(first.tolist(), second.tolist(), strict=True)
    ]


def _folded(total: int) -> int:
    """A sum as HDF5's loop leaves it: 0 is of nothing but zeros, else it is 65535."""
    return (256 * total % 65535 or 65535) if total else 0
