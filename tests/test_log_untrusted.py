"""Every way in which a log from a stranger can be hostile, and the one line that refuses it."""

import os

import h5py
import numpy as np
import pytest
from test_log_writer import encoded, write

from rotctl.errors import LogError
from rotctl.log import SCHEMA, RunLog

QPOS = "trajectory/qpos"


@pytest.fixture(scope="module")
def content():
    return encoded()


@pytest.fixture
def path(tmp_path, content):
    (tmp_path / "run.h5").write_bytes(content)
    return tmp_path / "run.h5"


def replace(file, name, make):
    """Exchanges a dataset for what ``make`` creates; the unit stays right."""
    shape, units = file[name].shape, file[name].attrs["units"]
    del file[name]
    make(file, shape).attrs["units"] = units


def soft_link(file):
    del file[QPOS]
    file[QPOS] = h5py.SoftLink("/trajectory/qvel")


def external_link(file):
    del file[QPOS]
    file[QPOS] = h5py.ExternalLink("/etc/other.h5", "/x")


def linked_group(file):
    file.move("trajectory", "elsewhere")
    file["trajectory"] = h5py.SoftLink("/elsewhere")


def external_storage(file):
    replace(
        file,
        QPOS,
        lambda f, shape: f.create_dataset(
            QPOS, shape, "f8", external=[("/etc/hostname", 0, h5py.h5f.UNLIMITED)]
        ),
    )


def virtual(file):
    def make(f, shape):
        layout = h5py.VirtualLayout(shape, "f8")
        layout[...] = h5py.VirtualSource("/etc/other.h5", "x", shape)
        return f.create_virtual_dataset(QPOS, layout)

    replace(file, QPOS, make)


def huge(file):
    replace(
        file,
        QPOS,
        lambda f, shape: f.create_dataset(QPOS, (shape[0], 10**13), "f8", chunks=(1, 1000)),
    )


def huge_chunks(file):
    replace(
        file,
        QPOS,
        lambda f, shape: f.create_dataset(
            QPOS, shape, "f8", chunks=(2**14, 2**14 + 1), maxshape=(None, None)
        ),
    )


def foreign_filter(file):
    replace(file, QPOS, lambda f, shape: f.create_dataset(QPOS, shape, "f8", compression="lzf"))


def objects(file):
    replace(file, QPOS, lambda f, shape: f.create_dataset(QPOS, shape, h5py.vlen_dtype(np.float64)))


def references(file):
    replace(file, QPOS, lambda f, shape: f.create_dataset(QPOS, shape, h5py.ref_dtype))


def variable_length_model(file):
    replace(
        file,
        "model/mjcf",
        lambda f, _: f.create_dataset("model/mjcf", data="<mujoco/>", dtype=h5py.string_dtype()),
    )


def huge_model(file):
    replace(file, "model/mjcf", lambda f, _: f.create_dataset("model/mjcf", (), "S20000000"))


def compound(file):
    replace(file, QPOS, lambda f, shape: f.create_dataset(QPOS, shape, [("a", "f4"), ("b", "f4")]))


def null_dataspace(file):
    replace(file, QPOS, lambda f, _: f.create_dataset(QPOS, data=h5py.Empty("f8")))


def group_for_dataset(file):
    del file[QPOS]
    file.create_group(QPOS)


def named_type(file):
    file["trajectory/evil"] = np.dtype("f8")


def attribute(name, value):
    def change(file):
        file.attrs[name] = value

    return change


def dataset_unit(value):
    def change(file):
        file[QPOS].attrs["units"] = value

    return change


def without(*names):
    def change(file):
        for name in names:
            if name in file.attrs:
                del file.attrs[name]
            else:
                del file[name]

    return change


def added(name):
    def change(file):
        file[name] = 1.0

    return change


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (soft_link, "'trajectory/qpos' is a soft link"),
        (external_link, "'trajectory/qpos' is an external link"),
        (linked_group, "unknown object 'elsewhere'"),
        (external_storage, "'trajectory/qpos' is stored outside the file"),
        (virtual, "'trajectory/qpos' is a virtual dataset"),
        (huge, "declares more than 2147483648 bytes of data"),
        (huge_chunks, "'trajectory/qpos' has absurdly large chunks"),
        (foreign_filter, "'trajectory/qpos' needs a foreign filter"),
        (objects, "trajectory/qpos has type object, expected float64"),
        (references, "trajectory/qpos has type object, expected float64"),
        (variable_length_model, "model/mjcf has type object, expected bytes"),
        (huge_model, "model/mjcf is larger than 16777216 bytes"),
        (
            compound,
            "trajectory/qpos has type [('a', '<f4'), ('b', '<f4')], expected float64",
        ),
        (null_dataspace, "trajectory/qpos has shape None, expected (steps, nq)"),
        (group_for_dataset, "unknown object 'trajectory/qpos'"),
        (named_type, "unknown object 'trajectory/evil'"),
        (added("trajectory/evil"), "unknown dataset 'trajectory/evil'"),
        (added("evil\n"), "unknown object 'evil\\n'"),
        (lambda file: file.create_group("evil"), "unknown object 'evil'"),
        (without(QPOS), "missing dataset 'trajectory/qpos'"),
        (without("solver"), "missing dataset 'solver/status'"),
        (without("schema_version"), "not a rotctl log (no schema_version)"),
        (
            attribute("schema_version", "1"),
            "not a rotctl log (schema_version is not a number)",
        ),
        (attribute("schema_version", 5), "schema version 5, this rotctl reads 2 to 4"),
        (attribute("schema_version", 1), "schema version 1, this rotctl reads 2 to 4"),
        (attribute("schema_version", 2), "unknown dataset 'command/axes'"),
        (without("complete"), "incomplete, the run was cut off while it was written"),
        (attribute("complete", False), "incomplete, the run was cut off while it was written"),
        (without("seed"), "missing attribute 'seed'"),
        (attribute("evil", 1), "unknown attribute 'evil'"),
        (attribute("seed", "3"), "attribute 'seed' is not of type int"),
        (attribute("seed", [1, 2]), "attribute 'seed' is not a plain value"),
        (attribute("config", np.bytes_(b"x")), "attribute 'config' is not of type str"),
        (attribute("config", h5py.Empty("f8")), "attribute 'config' is not a plain value"),
        (dataset_unit("mm"), "trajectory/qpos has unit 'mm', expected 'm, rad, quaternion'"),
    ],
)
def test_a_hostile_log_is_refused(path, change, message):
    with h5py.File(path, "r+") as file:
        change(file)
    with pytest.raises(LogError) as caught:
        RunLog.open(path)
    assert str(caught.value) == f"{path}: {message}"


def test_a_file_that_swells_is_refused(path):
    """Chunks that were never written take no room in the file, and 200 MB in memory."""
    steps, capacity = RunLog.open(path).sizes["steps"], 100_000
    with h5py.File(path, "r+") as file:
        for name in (n for n, spec in SCHEMA.items() if "capacity" in spec.shape):
            dtype, beyond = file[name].dtype, file[name].shape[2:]
            replace(
                file,
                name,
                lambda f, _, name=name, dtype=dtype, beyond=beyond: f.create_dataset(
                    name, (steps, capacity, *beyond), dtype, chunks=(1, 1000, *beyond)
                ),
            )
    with pytest.raises(LogError) as caught:
        RunLog.open(path)
    size = path.stat().st_size
    assert size < 1_000_000
    assert str(caught.value).startswith(f"{path}: declares ")
    assert str(caught.value).endswith(f" bytes of data, but has {size} bytes")


def test_text_that_is_none_is_refused(path):
    """h5py hands bytes that are no UTF-8 on as halves of surrogate pairs: no page can hold them."""
    content = path.read_bytes()
    assert content.count(b"0123456789ab") == 1
    path.write_bytes(content.replace(b"0123456789ab", b"0123456789a\xff"))
    with pytest.raises(LogError) as caught:
        RunLog.open(path)
    assert str(caught.value) == f"{path}: attribute 'run_id' has a control character"


def test_a_pipe_or_a_link_in_the_place_of_a_log(path, tmp_path):
    (tmp_path / "link.h5").symlink_to(path)
    assert RunLog.open(tmp_path / "link.h5").steps
    os.mkfifo(tmp_path / "pipe.h5")
    for name, linked, said in (
        ("link.h5", False, "is a link; only plain files are read here"),
        ("pipe.h5", True, "is no plain file"),
    ):
        with pytest.raises(LogError) as caught:
            RunLog.open(tmp_path / name, linked=linked)
        assert str(caught.value) == f"{tmp_path / name}: {said}"


def test_a_linked_group_under_its_right_name_is_refused(path):
    with h5py.File(path, "r+") as file:
        file.move("trajectory", "solver/inner")
        file["trajectory"] = h5py.SoftLink("/solver/inner")
    with pytest.raises(LogError):
        RunLog.open(path)


def test_a_foreign_hdf5_file_is_refused(tmp_path):
    path = tmp_path / "foreign.h5"
    with h5py.File(path, "w") as file:
        file["data"] = np.zeros(3)
    with pytest.raises(LogError) as caught:
        RunLog.open(path)
    assert str(caught.value) == f"{path}: not a rotctl log (no schema_version)"


def test_a_dataset_that_vanishes_after_open_is_named(path):
    log = RunLog.open(path)
    with h5py.File(path, "r+") as file:
        del file[QPOS]
    with pytest.raises(LogError, match="'trajectory/qpos' cannot be found$"):
        log[QPOS]


def test_an_external_link_is_not_even_touched(path, tmp_path):
    """A link that appears after ``open`` is refused too, though its target is a good dataset."""
    log = RunLog.open(path)
    write(tmp_path / "other.h5")
    with h5py.File(path, "r+") as file:
        del file[QPOS]
        file[QPOS] = h5py.ExternalLink(str(tmp_path / "other.h5"), QPOS)
    with pytest.raises(LogError, match="'trajectory/qpos' is an external link$"):
        log[QPOS]
