"""A log for other readers of HDF5: names for its axes, types that all of them know."""

import h5py
import numpy as np
from test_log_writer import ATTRIBUTES, buffer

from rotctl.log import SCHEMA, RunLog, write_run


def _written(folder):
    path = folder / "run.h5"
    write_run(path, buffer(), model_xml="<mujoco/>", attributes=ATTRIBUTES)
    return path


def test_every_axis_has_a_name(tmp_path):
    """As netCDF has them: xarray refuses a file in which some axes have one and some have none."""
    path = _written(tmp_path)
    with h5py.File(path) as file:
        for name, spec in SCHEMA.items():
            dataset = file[name]
            scales = [list(dim.values()) for dim in dataset.dims]
            assert [len(of_one) for of_one in scales] == [1] * len(spec.shape)
            for (scale,), size in zip(scales, dataset.shape, strict=True):
                assert scale.is_scale
                assert scale.parent == file
                assert scale.shape == (size,)
        assert np.array_equal(file["time"], file["trajectory/time"])
        assert np.array_equal(file["joint"], file["model/joint"])
        assert file["xyz"][:].tolist() == [b"x", b"y", b"z"]


def test_truth_values_and_texts_are_of_types_that_all_readers_know(tmp_path):
    path = _written(tmp_path)
    with h5py.File(path) as file:
        kinds = {file[name].dtype.kind for name in SCHEMA} | {
            type_.kind for name in file.attrs if (type_ := file.attrs.get_id(name).dtype)
        }
        assert kinds <= set("iufSO")
        assert file["contacts/used"].dtype == np.uint8
        text = file["model/mjcf"].id.get_type()
        assert (text.is_variable_str(), text.get_cset()) == (False, h5py.h5t.CSET_ASCII)
    log = RunLog.open(path)
    assert log["contacts/used"].dtype == bool
    assert log.attributes["complete"] is True
    assert type(log.attributes["git_dirty"]) is bool
    log.verify()


def test_a_log_is_a_mapping(tmp_path):
    log = RunLog.open(_written(tmp_path))
    assert list(log) == list(SCHEMA) == list(log.keys())
    assert len(log) == len(SCHEMA)
    assert dict(log)["trajectory/qpos"].shape == log["trajectory/qpos"].shape
    assert log.get("no/such") is None
