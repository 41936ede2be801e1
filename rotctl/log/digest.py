"""One SHA-256 over everything that a log says, equal at the writer and at the reader."""

import json
from collections.abc import Iterator, Mapping
from hashlib import sha256
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rotctl.log.schema import ATTRIBUTES, SCHEMA

_NOT_CONTENT = ("content_sha256", "complete")
_BLOCK_BYTES = 2**24


def content_sha256(
    arrays: Mapping[str, NDArray[Any]], attributes: Mapping[str, bool | int | float | str]
) -> str:
    """Hashes all datasets in schema order (the model included), then all root attributes.

    Args:
        arrays: schema path -> array or open dataset, all that a log of this version has.
        attributes: root attribute -> value; ``content_sha256`` and ``complete`` are left out.

    Returns:
        64 hexadecimal digits.
    """
    digest = sha256()
    for name in filter(arrays.__contains__, SCHEMA):
        array = arrays[name]
        digest.update(f"{name} {array.dtype.str} {array.shape}\n".encode())
        for block in _blocks(array):
            digest.update(block.tobytes())
    content = {name: attributes[name] for name in ATTRIBUTES if name not in _NOT_CONTENT}
    digest.update(json.dumps(content).encode())
    return digest.hexdigest()


def _blocks(array: Any) -> Iterator[NDArray[Any]]:
    """The array's rows, some at a time."""
    if array.ndim == 0 or array.size == 0:
        yield np.asarray(array[()])
        return
    rows = max(1, _BLOCK_BYTES // (array.dtype.itemsize * prod(array.shape[1:])))
    for first in range(0, len(array), rows):
        yield np.asarray(array[first : first + rows])
