"""The checksums that are put into a log's file are those of HDF5."""

import h5py
import numpy as np
import pytest

from rotctl.log.image import fletcher32


@pytest.mark.parametrize("words", [1, 63, 64, 65, 1000, 2**17])
@pytest.mark.parametrize("most", [0, 1, 255, 65535])
def test_checksums_are_those_of_hdf5(words, most):
    rng = np.random.default_rng(words)
    arrays = [
        np.zeros(4 * words, "<u2"),
        np.full(4 * words, most, "<u2"),
        rng.integers(0, most, 4 * words, "<u2", endpoint=True),
    ]
    with h5py.File("a", "w", driver="core", backing_store=False) as file:
        for array, found in zip(arrays, fletcher32(arrays), strict=True):
            name = str(len(file))
            file.create_dataset(name, data=array, chunks=array.shape, fletcher32=True)
            _, chunk = file[name].id.read_direct_chunk((0,))
            assert chunk[: array.nbytes] == array.tobytes()
            assert int.from_bytes(chunk[array.nbytes :], "little") == found
