"""A run reaches the disk whole, the same every time, or not at all."""

import errno
import hashlib
import os
import resource
import subprocess
import sys
import time

import numpy as np
import pytest

from rotctl.errors import InputError
from rotctl.log import RunLog, TrajectoryBuffer, encode_run, write_run

MODEL = "<mujoco model='é'/>\n"
ATTRIBUTES = {
    "config": "seed: 3\n",
    "run_id": "0123456789ab",
    "seed": 3,
    "versions": {"rotctl": "0.1.0"},
    "git_commit": "unknown",
    "git_dirty": False,
    "machine": {"cores": 2},
    "wall_time": 1.5,
    "outcome": {"turns": np.float64(2.5), "fell": np.bool_(False)},
}


def buffer(steps=40):
    """A run whose every array has something in it."""
    run = TrajectoryBuffer.allocate(steps=steps, nq=9, nv=8, nu=2, capacity=4, tasks=2, bodies=2)
    rng = np.random.default_rng(0)
    for array in run.arrays().values():
        array[...] = rng.integers(0, 2, array.shape)
    run.add_event(0.25, "push: 50 N, naïve")
    return run


def encoded():
    return encode_run(buffer(), model_xml=MODEL, attributes=ATTRIBUTES)


def write(path, run=None, **attributes):
    write_run(path, run or buffer(), model_xml=MODEL, attributes={**ATTRIBUTES, **attributes})


def test_round_trip(tmp_path):
    run, path = buffer(), tmp_path / "run.h5"
    write(path, run)
    log = RunLog.open(path)
    log.verify()
    for name, array in run.arrays().items():
        assert log[name].dtype == array.dtype
        assert np.array_equal(log[name], array), name
    assert log.model_xml == MODEL
    assert log.events == [(0.25, "push: 50 N, naïve")]
    assert log.outcome == {"turns": 2.5, "fell": False}
    assert log.config_yaml == "seed: 3\n"
    assert log.attributes["versions"] == '{"rotctl": "0.1.0"}'
    assert log.attributes["git_dirty"] is False
    assert log.steps == 40
    assert [entry.name for entry in tmp_path.iterdir()] == ["run.h5"]


def test_a_run_may_be_a_mapping_and_may_be_empty(tmp_path):
    run = TrajectoryBuffer.allocate(steps=0, nq=9, nv=8, nu=0, capacity=0, tasks=0, bodies=1)
    write(tmp_path / "run.h5", run.arrays(), wall_time=np.int64(2))
    log = RunLog.open(tmp_path / "run.h5")
    log.verify()
    assert log.steps == 0
    assert log.events == []
    assert log.attributes["wall_time"] == 2.0


def test_a_config_may_be_longer_than_an_hdf5_object_header(tmp_path):
    write(tmp_path / "run.h5", config="a: é\n" * 30_000)
    assert RunLog.open(tmp_path / "run.h5").config_yaml == "a: é\n" * 30_000


def test_equal_input_gives_equal_bytes(tmp_path):
    write(tmp_path / "first.h5")
    time.sleep(1.1)  # HDF5 counts its time stamps, if it makes any, in seconds
    write(tmp_path / "second.h5")
    first, second = (
        hashlib.sha256((tmp_path / name).read_bytes()).hexdigest()
        for name in ("first.h5", "second.h5")
    )
    assert first == second


def fail(number):
    def raise_it(*_):
        raise OSError(number, os.strerror(number))

    return raise_it


@pytest.mark.parametrize("call", ["fsync", "replace"])
def test_a_full_disk_leaves_nothing(tmp_path, monkeypatch, call):
    monkeypatch.setattr(os, call, fail(errno.ENOSPC))
    path = tmp_path / "run.h5"
    with pytest.raises(InputError) as caught:
        write(path)
    assert str(caught.value) == f"cannot write {path}: No space left on device"
    assert list(tmp_path.iterdir()) == []


def test_a_real_failure_in_the_middle_leaves_nothing(tmp_path):
    path = tmp_path / "run.h5"
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, limits[1]))
    try:
        with pytest.raises(InputError) as caught:
            write(path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert str(caught.value) == f"cannot write {path}: File too large"
    assert list(tmp_path.iterdir()) == []


def test_an_interrupt_leaves_nothing_and_goes_on(tmp_path, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write(tmp_path / "run.h5")
    assert list(tmp_path.iterdir()) == []


def test_a_failure_keeps_the_older_log(tmp_path, monkeypatch):
    path = tmp_path / "run.h5"
    write(path)
    monkeypatch.setattr(os, "fsync", fail(errno.EIO))
    with pytest.raises(InputError, match="Input/output error$"):
        write(path, buffer(steps=2))
    assert RunLog.open(path).steps == 40


def test_a_kill_leaves_only_a_part_which_the_next_write_replaces(tmp_path):
    path = tmp_path / "run.h5"
    script = (
        "import os, sys; from pathlib import Path; from rotctl.log import write_log\n"
        "os.fsync = lambda _: os._exit(9)\n"
        "write_log(Path(sys.argv[1]), bytes(1000))"
    )
    found = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    killed = subprocess.run([sys.executable, "-c", script, path], env=found, check=False)
    assert killed.returncode == 9
    assert [entry.name for entry in tmp_path.iterdir()] == ["run.h5.part"]
    write(path)
    assert [entry.name for entry in tmp_path.iterdir()] == ["run.h5"]
    RunLog.open(path).verify()


def test_a_missing_folder_is_named(tmp_path):
    path = tmp_path / "nowhere" / "run.h5"
    with pytest.raises(InputError) as caught:
        write(path)
    assert str(caught.value) == f"cannot write {path}: No such file or directory"


def test_a_folder_in_the_way_is_named(tmp_path):
    path = tmp_path / "run.h5"
    path.mkdir()
    with pytest.raises(InputError) as caught:
        write(path)
    assert str(caught.value) == f"cannot write {path}: Is a directory"
    assert list(tmp_path.iterdir()) == [path]


def test_an_unwritable_folder_is_named(tmp_path):
    tmp_path.chmod(0o500)
    path, user = tmp_path / "run.h5", os.geteuid()
    os.seteuid(user or 65534)  # root may write anywhere, so be nobody for a moment
    try:
        with pytest.raises(InputError) as caught:
            write(path)
    finally:
        os.seteuid(user)
        tmp_path.chmod(0o700)
    assert str(caught.value) == f"cannot write {path}: Permission denied"


def test_arrays_that_do_not_fit_the_schema_are_named(tmp_path):
    arrays = buffer().arrays()
    arrays["trajectory/com"] = arrays["trajectory/com"][:5]
    with pytest.raises(InputError, match=r"run.h5: trajectory/com has shape \(5, 3\), expected"):
        write(tmp_path / "run.h5", arrays)


def test_a_model_with_a_nul_is_refused():
    with pytest.raises(InputError, match="^model_xml contains a NUL character$"):
        encode_run(buffer(), model_xml="a\0", attributes=ATTRIBUTES)
