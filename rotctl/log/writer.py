"""A finished run -> one HDF5 file that is either whole or not there.

The file is made in memory and reaches the disk as plain bytes: a kill before the rename leaves
at most a ``.part``, and a full disk is an ordinary ``OSError``, not an HDF5 one.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np
from numpy.typing import NDArray

from rotctl import files
from rotctl.errors import InputError
from rotctl.log.attributes import root_attributes, utf8, write_attribute
from rotctl.log.buffer import TrajectoryBuffer
from rotctl.log.datasets import empty, fill
from rotctl.log.digest import content_sha256, simulated
from rotctl.log.scales import coordinates
from rotctl.log.schema import MODEL_PATH

if TYPE_CHECKING:
    from hashlib import _Hash as Hash


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
    return {**arrays, MODEL_PATH: np.array(utf8("model_xml", model_xml))}


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
    image = empty(
        tuple((name, a.dtype, a.shape, a.dtype.metadata is not None) for name, a in stored.items())
    )
    stored |= coordinates(arrays)
    root = root_attributes(attributes)
    root["content_sha256"] = content_sha256(digest or simulated(arrays), root)
    opened = h5py.h5f.open_file_image(image.filled(stored), h5py.h5f.FILE_IMAGE_OPEN_RW)
    with h5py.File(opened) as file:
        for name, array in stored.items():
            if name not in image.places:
                fill(opened, name, array)
        top = file["/"]
        for name, value in {**root, "complete": True}.items():
            write_attribute(top, name, value)
        file.flush()
        content: bytes = opened.get_file_image()
    return content


def _stored(array: NDArray[Any]) -> NDArray[Any]:
    """An array as HDF5 takes it."""
    if array.dtype.kind == "S" and not array.tobytes().isascii():
        array = array.astype(h5py.string_dtype("utf-8", array.dtype.itemsize))
    if array.dtype == bool:  # HDF5 has none, and few know h5py's enum
        array = array.view(np.uint8)
    return np.require(array, requirements="C")
