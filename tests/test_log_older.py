"""A log of schema 2, written by the code of its time: it opens, and pictures come out of it."""

import lzma
from pathlib import Path

import h5py
import numpy as np
import pytest

from rotctl.cli.main import main
from rotctl.errors import LogError
from rotctl.log import SCHEMA, RunLog
from rotctl.log.schema import SCHEMA_VERSION, names_of
from rotctl.report import stored_model
from rotctl.report.signals import linear_rates, signals
from rotctl.suggestion import meant

NEWER = {
    "trajectory/ground_height",
    "contacts/force_peak",
    "contacts/ground_force",
    "contacts/ground_force_peak",
    "contacts/penetration",
}
ALL = slice(None)


@pytest.fixture
def path(tmp_path):
    packed = Path(__file__).with_name("schema_2.h5.xz").read_bytes()
    (tmp_path / "run.h5").write_bytes(lzma.decompress(packed))
    return tmp_path / "run.h5"


def test_it_opens_and_is_whole(path):
    log = RunLog.open(path)
    log.verify()
    assert (log.attributes["schema_version"], log.steps) == (2, 6)
    assert log.outcome["behaviour"] == "forward_roll_1"
    assert set(SCHEMA) - set(log.names) >= NEWER
    assert names_of(2) == log.names
    assert names_of(SCHEMA_VERSION) == tuple(SCHEMA)
    for name in log.names:
        assert name in log
        assert len(log[name].shape) == len(SCHEMA[name].shape)


@pytest.mark.parametrize("name", sorted(NEWER))
def test_what_it_does_not_have_is_said(path, name):
    log = RunLog.open(path)
    assert name not in log
    for ask in (log.__getitem__, log.units, log.description):
        with pytest.raises(LogError) as caught:
            ask(name)
        assert str(caught.value) == (
            f"{path}: no dataset {name!r}; {meant(name, log.names)}"
            f"valid names: {', '.join(log.names)}"
        )


def test_damage_is_noticed_in_it_too(path):
    with h5py.File(path, "r+") as file:
        file["trajectory/qpos"][3, 7] += 1e-9
    with pytest.raises(LogError, match="does not match its SHA-256"):
        RunLog.open(path).verify()


@pytest.mark.parametrize("change", ["without", "with"])
def test_it_has_the_datasets_of_its_version_and_no_others(path, change):
    with h5py.File(path, "r+") as file:
        if change == "without":
            del file["contacts/used"]
        else:
            file["contacts/penetration"] = np.zeros(6)
    message = "missing dataset 'contacts/used'"
    if change == "with":
        message = "unknown dataset 'contacts/penetration'"
    with pytest.raises(LogError, match=f": {message}$"):
        RunLog.open(path)


def test_its_signals(path):
    """Forces are those of the contacts that have a slot; what is not in it is not a number."""
    log = RunLog.open(path)
    run = signals(log, ALL)
    forces = log["contacts/force_realised"].astype(float).sum(axis=1)
    assert np.abs(forces).max() > 100.0
    np.testing.assert_allclose(run.force, np.linalg.norm(forces, axis=1))
    assert np.isnan(run.height).all()
    assert np.isnan(run.force_peak).all()
    model = stored_model.load(log)
    weight = model.body_subtreemass[1] * model.opt.gravity
    np.testing.assert_allclose(linear_rates(log, ALL, weight).realised, forces + weight)


@pytest.mark.parametrize(("command", "made"), [("plot", "plot.png"), ("replay", "replay.html")])
def test_pictures_of_it(path, command, made, capsys):
    assert main([command, str(path)]) == 0
    assert capsys.readouterr() == (f"{path.with_name(made)}\n", "")
    assert path.with_name(made).stat().st_size > 50_000


def test_inspect_shows_what_it_has(path, capsys):
    assert main(["inspect", str(path)]) == 0
    said = capsys.readouterr().out
    assert "  schema 2\n" in said
    assert "contacts/force_realised" in said
    assert not any(f"{name} " in said for name in NEWER)
    assert said.endswith("\nintegrity  complete, checksums match\n")
