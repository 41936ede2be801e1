"""What a log gives back, and how damage shows."""

import h5py
import numpy as np
import pytest
from test_log_writer import buffer, encoded, write

from rotctl.errors import LogError
from rotctl.log import SCHEMA, RunLog


@pytest.fixture(scope="module")
def content():
    return encoded()


@pytest.fixture
def path(tmp_path, content):
    (tmp_path / "run.h5").write_bytes(content)
    return tmp_path / "run.h5"


def refused(path):
    with pytest.raises(LogError) as caught:
        RunLog.open(path)
    prefix = f"{path}: "
    assert str(caught.value).startswith(prefix)
    return str(caught.value).removeprefix(prefix)


def test_units_and_descriptions(path):
    log = RunLog.open(path)
    for name, spec in SCHEMA.items():
        assert log.units(name) == spec.unit
        assert log.description(name) == spec.description


@pytest.mark.parametrize("ask", [RunLog.__getitem__, RunLog.units, RunLog.description])
def test_an_unknown_name_lists_the_valid_ones(path, ask):
    with pytest.raises(LogError) as caught:
        ask(RunLog.open(path), "trajectory/qpso")
    assert str(caught.value) == (
        f"{path}: no dataset 'trajectory/qpso'; did you mean trajectory/qpos? "
        f"valid names: {', '.join(SCHEMA)}"
    )


def test_a_log_holds_no_file_open(path):
    log = RunLog.open(path)
    with h5py.File(path, "r+"):  # would fail under another handle
        pass
    path.unlink()
    with pytest.raises(LogError, match="no such file"):
        log["trajectory/qpos"]


def test_a_log_that_somebody_else_here_holds_open_with_locks(path):
    with h5py.File(path) as file:
        length = len(file["trajectory/time"])
        assert len(RunLog.open(path)["trajectory/time"]) == length


def test_a_file_that_was_exchanged_under_the_log_is_refused(path):
    log = RunLog.open(path)
    write(path, buffer(steps=3))
    with pytest.raises(LogError, match=r"expected \(steps, nq\) with steps = 40"):
        log["trajectory/qpos"]


@pytest.mark.parametrize("outcome", ["{", "[" * 200_000, "[1]"])
def test_an_outcome_that_is_no_json_object_is_refused(tmp_path, outcome):
    write(tmp_path / "run.h5", outcome=outcome)
    log = RunLog.open(tmp_path / "run.h5")
    with pytest.raises(LogError, match="outcome is not"):
        log.outcome  # noqa: B018


def test_a_missing_file(tmp_path):
    assert refused(tmp_path / "run.h5") == "no such file"
    assert refused(tmp_path) == "is a folder"


def test_a_file_that_is_not_hdf5(tmp_path):
    (tmp_path / "run.h5").write_bytes(b"time,qpos\n")
    assert refused(tmp_path / "run.h5") == "not an HDF5 file"


@pytest.mark.parametrize("fraction", [0.02, 0.1, 0.5, 0.9, 0.999])
def test_a_truncated_file(path, fraction):
    whole = path.read_bytes()
    path.write_bytes(whole[: int(fraction * len(whole))])
    assert refused(path) == "truncated or damaged HDF5 file"


def test_an_empty_file(path):
    path.write_bytes(b"")
    assert refused(path) == "not an HDF5 file"


def flip(path, offset):
    content = bytearray(path.read_bytes())
    content[offset] ^= 0x10
    path.write_bytes(content)


def test_a_flipped_bit_in_compressed_data(path):
    with h5py.File(path) as file:
        offset = file["trajectory/qpos"].id.get_chunk_info(0).byte_offset
    flip(path, offset + 20)
    log = RunLog.open(path)
    with pytest.raises(LogError, match="truncated or damaged HDF5 file$"):
        log.verify()


def test_a_flipped_bit_in_the_model_which_has_no_checksum_of_its_own(path):
    with h5py.File(path) as file:
        offset = file["model/mjcf"].id.get_offset()
    flip(path, offset + 3)
    log = RunLog.open(path)
    with pytest.raises(LogError, match="damaged, its content does not match its SHA-256$"):
        log.verify()


def test_a_changed_attribute_is_caught(path):
    with h5py.File(path, "r+") as file:
        file.attrs["outcome"] = '{"turns": 100}'
    with pytest.raises(LogError, match="damaged, its content does not match its SHA-256$"):
        RunLog.open(path).verify()


@pytest.mark.parametrize(("axis", "label"), [("joint", b"nobody"), ("time", 9.0), ("xyz", b"q")])
def test_a_changed_label_is_caught(path, axis, label):
    """Who reads a log by names, as xarray does, takes the joint of that name."""
    with h5py.File(path, "r+") as file:
        file[axis][0] = label
    with pytest.raises(LogError, match=f"damaged, its axis '{axis}' is labelled otherwise$"):
        RunLog.open(path).verify()


def test_random_damage_is_caught_or_harmless(path):
    """Whatever bit flips, the log is refused or says exactly what it said before."""
    whole = path.read_bytes()
    before = {name: RunLog.open(path)[name] for name in SCHEMA}
    rng = np.random.default_rng(1)
    caught = 0
    for offset in rng.integers(0, len(whole), 60):
        path.write_bytes(whole)
        flip(path, offset)
        try:
            log = RunLog.open(path)
            log.verify()
        except LogError:
            caught += 1
        else:
            assert all(np.array_equal(log[name], before[name]) for name in SCHEMA)
    assert caught


def test_text_that_is_not_utf8(path):
    with h5py.File(path, "r+") as file:
        file["events/text"][0] = np.bytes_(b"\xff\xfe")
    log = RunLog.open(path)
    with pytest.raises(LogError, match="damaged, text is not UTF-8$"):
        log.events  # noqa: B018
