"""A tree of plain values and arrays as two texts that are safe inside an HTML page.

The arrays lie one after the other in one gzipped block; in the tree stands where. Floats are
rounded to what can be seen, which halves the block. Equal trees give equal texts.
"""

import gzip
import json
import math
from base64 import b64encode
from typing import Any

import numpy as np

_TYPES = {"f": ("f4", "<f4"), "i": ("i4", "<i4"), "u": ("i4", "<i4"), "b": ("u1", "u1")}
_GRAIN = 2.0**-11  # 0.5 mm, 0.5 ms, 0.03 deg, 0.0005 body weights: less than a pixel
_ALIGNMENT = 4  # [bytes] JavaScript's typed arrays must begin at a multiple of their size


def pack(tree: Any) -> tuple[str, str]:
    """Pack a tree of dicts, lists, scalars and NumPy arrays.

    Returns:
        JSON in which every array is ``{"$array": [type, offset, length]}``, and the block in
        base64. Numbers that are not finite become null outside of arrays.
    """
    block = bytearray()
    text = json.dumps(_packed(tree, block), separators=(",", ":"), allow_nan=False)
    zipped = gzip.compress(bytes(block), compresslevel=9, mtime=0)
    return _inert(text), b64encode(zipped).decode("ascii")


def _packed(value: Any, block: bytearray) -> Any:
    if isinstance(value, dict):
        return {str(key): _packed(item, block) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_packed(item, block) for item in value]
    if isinstance(value, np.ndarray):
        return {"$array": _appended(value, block)}
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value


def _appended(array: np.ndarray[Any, Any], block: bytearray) -> list[Any]:
    name, dtype = _TYPES[array.dtype.kind]
    block += bytes(-len(block) % _ALIGNMENT)
    offset = len(block)
    with np.errstate(over="ignore", invalid="ignore"):  # a run that broke down: infinity will do
        seen = np.round(array / _GRAIN) * _GRAIN if name == "f4" else array
        block += np.ascontiguousarray(seen, dtype=dtype).tobytes()
    return [name, offset, array.size]


def _inert(text: str) -> str:
    """JSON without the characters that could end a script element or open a comment."""
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")
