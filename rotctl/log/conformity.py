"""Whether datasets are those of the schema: the check that the writer and the reader share."""

from collections.abc import Mapping
from math import prod
from typing import Any

import numpy as np

from rotctl.errors import LogError
from rotctl.log.schema import (
    CONSTANTS,
    MAX_TOTAL_BYTES,
    MODEL_PATH,
    SCHEMA,
    SCHEMA_VERSION,
    DatasetSpec,
    names_of,
)

MAX_MODEL_BYTES = 16 * 2**20


def check_dataset(
    name: str, dtype: "np.dtype[Any]", shape: tuple[int, ...] | None, sizes: Mapping[str, int]
) -> dict[str, int]:
    """Checks one dataset against its spec and the sizes that are known so far.

    Args:
        name: path in ``SCHEMA``.
        dtype: its type.
        shape: its shape; None for HDF5's null dataspace.
        sizes: symbolic dimension -> size, as bound by other datasets.

    Returns:
        ``sizes`` and what this dataset adds to them.

    Raises:
        LogError: wrong type, rank or size.
    """
    spec = SCHEMA[name]
    expected = np.dtype(spec.dtype)
    if expected.kind == "b" and dtype == np.uint8:  # as it is stored; up to schema 3 as an enum
        dtype = expected
    any_length = expected.itemsize == 0 and dtype.kind == expected.kind
    if dtype != expected and not any_length:
        raise LogError(f"{name} has type {dtype}, expected {expected.name}")
    if shape is None or len(shape) != len(spec.shape):
        raise LogError(f"{name} has shape {shape}, expected {_shape_text(spec)}")
    bound = dict(sizes)
    for dim, size in zip(spec.shape, shape, strict=True):
        wanted = CONSTANTS[dim] if dim in CONSTANTS else bound.setdefault(dim, size)
        if size != wanted:
            raise LogError(
                f"{name} has shape {shape}, expected {_shape_text(spec)}"
                + ("" if dim in CONSTANTS else f" with {dim} = {wanted}")
            )
    return bound


def check_layout(
    layout: Mapping[str, tuple["np.dtype[Any]", tuple[int, ...] | None]],
    version: int = SCHEMA_VERSION,
) -> dict[str, int]:
    """Checks the datasets of a whole log, from types and shapes alone.

    Args:
        layout: name -> (type, shape).
        version: of the log's schema.

    Returns:
        Symbolic dimension -> size.

    Raises:
        LogError: a dataset is missing, unknown, misshapen, or the log is absurdly large.
    """
    names = names_of(version)
    for name in layout:
        if name not in names:
            raise LogError(f"unknown dataset {name!r}")
    sizes: dict[str, int] = {}
    total = 0
    for name in names:
        if name not in layout:
            raise LogError(f"missing dataset {name!r}")
        dtype, shape = layout[name]
        sizes = check_dataset(name, dtype, shape, sizes)
        total += dtype.itemsize * prod(shape or ())
    if layout[MODEL_PATH][0].itemsize > MAX_MODEL_BYTES:
        raise LogError(f"{MODEL_PATH} is larger than {MAX_MODEL_BYTES} bytes")
    if total > MAX_TOTAL_BYTES:
        raise LogError(f"declares more than {MAX_TOTAL_BYTES} bytes of data")
    return sizes


def _shape_text(spec: DatasetSpec) -> str:
    return "(" + ", ".join(str(CONSTANTS.get(dim, dim)) for dim in spec.shape) + ")"
