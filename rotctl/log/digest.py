"""One SHA-256 over everything that a log says, equal at the writer and at the reader."""

import json
from collections.abc import Iterator, Mapping
from functools import lru_cache
from hashlib import sha256
from math import prod
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rotctl.log.schema import ATTRIBUTES, SCHEMA

if TYPE_CHECKING:
    from hashlib import _Hash as Hash

_NOT_CONTENT = ("content_sha256", "complete")
_BLOCK_BYTES = 2**24


def simulated(arrays: Mapping[str, NDArray[Any]]) -> "Hash":
    """Hashes all datasets in schema order, the model included: what a repetition has again.

    Args:
        arrays: schema path -> array or open dataset, all that a log of this version has.
    """
    digest = sha256()
    for name in filter(arrays.__contains__, SCHEMA):
        array = arrays[name]
        digest.update(_heading(name, array.dtype, array.shape))
        for block in _blocks(array):
            digest.update(np.ascontiguousarray(block).data)
    return digest


@lru_cache(maxsize=500)
def _heading(name: str, dtype: "np.dtype[Any]", shape: tuple[int, ...]) -> bytes:
    kind = np.dtype(bool).str if SCHEMA[name].dtype == "?" else dtype.str  # not as stored
    return f"{name} {kind} {shape}\n".encode()


def content_sha256(simulated: "Hash", attributes: Mapping[str, bool | int | float | str]) -> str:
    """Hashes all root attributes after the datasets.

    Args:
        simulated: see there; it is left as it is.
        attributes: root attribute -> value; ``content_sha256`` and ``complete`` are left out.

    Returns:
        64 hexadecimal digits.
    """
    digest = simulated.copy()
    content = {name: attributes[name] for name in ATTRIBUTES if name not in _NOT_CONTENT}
    digest.update(json.dumps(content).encode())
    return digest.hexdigest()


def _blocks(array: Any) -> Iterator[NDArray[Any]]:
    """The array's rows, some at a time."""
    if array.ndim == 0 or array.size == 0:
        yield np.asarray(array[()])
        return
    if isinstance(array, np.ndarray) and array.nbytes <= _BLOCK_BYTES:
        yield array
        return
    rows = max(1, _BLOCK_BYTES // (array.dtype.itemsize * prod(array.shape[1:])))
    for first in range(0, len(array), rows):
        yield np.asarray(array[first : first + rows])
