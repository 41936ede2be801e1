"""How the datasets of a log are stored: units, checksums, chunks, and no room for what is empty."""

import h5py
from test_log_writer import write

from rotctl.log import SCHEMA, RunLog, TrajectoryBuffer


def test_every_dataset_has_unit_description_and_checksum(tmp_path):
    write(tmp_path / "run.h5")
    with h5py.File(tmp_path / "run.h5") as file:
        for name, spec in SCHEMA.items():
            assert file[name].attrs["units"] == spec.unit
            assert file[name].attrs["description"] == spec.description
            if file[name].shape:
                assert file[name].fletcher32
                plain = spec.dtype == "<f8"  # gzip gains little there, and takes long
                assert file[name].shuffle != plain
                assert file[name].compression == (None if plain else "gzip")


def test_chunks_are_whole_rows_of_about_a_mebibyte(tmp_path):
    run = TrajectoryBuffer.allocate(steps=3000, nq=100, nv=8, nu=2, capacity=4, tasks=2, bodies=2)
    write(tmp_path / "run.h5", run)
    with h5py.File(tmp_path / "run.h5") as file:
        assert file["trajectory/qpos"].chunks == (1310, 100)
        assert file["trajectory/time"].chunks == (3000,)


def test_slots_that_nobody_filled_take_no_room(tmp_path):
    run = TrajectoryBuffer.allocate(
        steps=50, nq=9, nv=8, nu=2, capacity=100, tasks=2, bodies=2
    ).arrays()
    run["contacts/position"][3, 20, 1] = -0.0
    run["contacts/body"][5, 2] = 0
    run["contacts/normal"][7, 99] = 1.0
    write(tmp_path / "run.h5", run)
    with h5py.File(tmp_path / "run.h5") as file:
        stored = {name: file[name].id.get_num_chunks() for name in SCHEMA if file[name].chunks}
    log = RunLog.open(tmp_path / "run.h5")
    log.verify()
    assert all(log[name].tobytes() == array.tobytes() for name, array in run.items())
    chunks = ("position", 2), ("body", 1), ("normal", 7), ("force_peak", 0), ("count", 0)
    assert [stored[f"contacts/{name}"] for name, _ in chunks] == [count for _, count in chunks]
