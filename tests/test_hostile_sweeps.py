"""Folders of sweeps from strangers: read back as a table and a report, or one line."""

import json
import os
import shutil

import pytest
from here import swept
from test_summarise import change

from rotctl.report.site import build
from rotctl.results.table import table

GRID = ("duration=0.5", "seed=range(0,2)")
SWEEP = [*GRID, "--quiet", "--out"]
COMMANDS = ("summarise", "report", "sweep")
pytestmark = pytest.mark.usefixtures("here_alone")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return swept(tmp_path_factory.mktemp("made") / "sweep", *GRID)


@pytest.fixture
def sweep(made, tmp_path, monkeypatch):
    """A copy of the sweep, to be harmed; drawn quickly, without pictures."""
    monkeypatch.setattr(build, "MOST_DRAWN", 0)
    return shutil.copytree(made, tmp_path / "sweep")


@pytest.fixture
def every(cli, sweep, tmp_path):
    """Runs every command that reads a sweep's folder: name -> (exit code, stdout, stderr)."""

    def call():
        return {
            "summarise": cli("summarise", sweep),
            "report": cli("report", sweep, "--out", tmp_path / "site"),
            "sweep": cli("sweep", *SWEEP, sweep),
        }

    return call


def pages(site):
    return "".join(p.read_text() for p in site.rglob("*") if p.suffix in (".html", ".md", ".csv"))


def add_line(sweep, line):
    path = sweep / "sweep.jsonl"
    count = path.read_text().count("\n")
    path.write_text(f"{path.read_text()}{line}\n")
    return f"rotctl: {path}: line {count + 1} is not a row of a sweep\n"


# ---------------------------------------------------------------- sweep.jsonl


@pytest.mark.parametrize(
    "line",
    [
        '{"run_id": "x", "values": {"a": "\\ud800"}}',
        '{"run_id": "x", "values": {"\\udfff": 1}}',
        '{"run_id": "x", "values": {"a": NaN}}',
        '{"run_id": "x", "values": {"a": 1e999}}',
        '{"run_id": "x", "values": {"a": ' + "9" * 5000 + "}}",
        '{"run_id": "x", "values": {"a": ' + "[" * 3000 + "}}",
        '{"run_id": "x", "values": {"a": 1, "a": 2}}',
        '{"run_id": "x", "values": [1]}',
        '{"run_id": 3, "values": {}}',
        '{"run_id": "x", "values": {}, "failure": 3}',
        '{"run_id": "x", "values": {}, "more": 3}',
        '{"run_id": "x"}',
        "[]",
        "null",
        "",
    ],
)
def test_a_line_that_rotctl_does_not_write_is_named(every, sweep, line):
    said = add_line(sweep, line)
    assert every() == {
        "summarise": (2, "", said),
        "report": (2, "", said),
        "sweep": (2, "", said),
    }


def test_keys_that_are_called_like_other_columns_are_told_from_them(every, sweep, tmp_path):
    values = {"success": 1, "run_id": 2, "code": 3, "status": 4, "log": 5, "label": 6, "n": 7,
              "seed": 8, "behaviour": 9, "revolutions": 10, "config.revolutions": 11}  # fmt: skip
    add_line(sweep, json.dumps({"run_id": "x", "values": values}))
    keys = table(sweep).keys
    assert {f"config.{key}" for key in ("success", "run_id", "code", "n", "revolutions")} <= set(
        keys
    )
    assert {"seed", "behaviour", "config.config.revolutions"} <= set(keys)
    assert len(set(keys)) == len(keys) == 12
    assert [code for code, _, _ in every().values()] == [0, 0, 0]
    assert "1 run of the sweep is not there" in pages(tmp_path / "site")


def test_more_keys_than_a_table_can_have_are_left_out(cli, sweep):
    values = {f"key_{i}": i for i in range(3000)}
    add_line(sweep, json.dumps({"run_id": "x", "values": values}))
    found = table(sweep)
    assert len(found.keys) == 200
    assert found.notes[0] == "the configs differ in 3003 keys; 200 of them are columns"
    assert cli("summarise", sweep)[0] == 0


# ---------------------------------------------------------------- pipes and links


def test_a_pipe_in_the_place_of_the_manifest_does_not_hang(every, sweep):
    (sweep / "sweep.jsonl").unlink()
    os.mkfifo(sweep / "sweep.jsonl")
    said = f"rotctl: {sweep / 'sweep.jsonl'}: is no plain file\n"
    assert set(every().values()) == {(2, "", said)}


def test_what_an_experiment_links_to_is_not_in_the_report(cli, sweep, tmp_path):
    (tmp_path / "secret").write_text("canary: [unclosed\n")
    os.mkfifo(sweep / "experiment-a.yaml")
    (sweep / "experiment-b.yaml").symlink_to(tmp_path / "secret")
    (sweep / "experiment-c.yaml").write_text("canary: [unclosed\n")
    (sweep / "experiment-d.yaml").mkdir()
    assert cli("report", sweep, "--out", tmp_path / "site")[0] == 0
    text = pages(tmp_path / "site")
    assert "canary" not in text
    for said in (
        "experiment-a.yaml: is no plain file",
        "experiment-b.yaml: is a link; only plain files are read here",
        "experiment-c.yaml:2: is no YAML: while parsing a flow sequence, did not find",
        "experiment-d.yaml: is a folder",
    ):
        assert said in text


@pytest.mark.parametrize(
    ("title", "said"),
    [
        ("2026-13-45", ": source: missing, it cannot be left out"),
        ("9" * 5000, ":1: a number has more than 40 digits"),
    ],
)
def test_odd_titles_leave_the_page_to_be_built(cli, sweep, tmp_path, title, said):
    (sweep / "experiment-x.yaml").write_text(f"title: {title}")
    assert cli("report", sweep, "--out", tmp_path / "site")[0] == 0
    assert f"experiment-x.yaml{said}" in pages(tmp_path / "site")


def test_a_log_that_is_a_link_is_not_read(cli, sweep, tmp_path):
    log = sorted(sweep.glob("*/run.h5"))[0]
    shutil.move(log, tmp_path / "elsewhere.h5")
    log.symlink_to(tmp_path / "elsewhere.h5")
    before = (tmp_path / "elsewhere.h5").read_bytes()
    said = "is a link; only plain files are read here"
    assert table(sweep).notes == [f"{log.parent.name}: damaged: {said}"]
    code, _, stderr = cli("sweep", *SWEEP[:-2], "--out", sweep)
    assert code == 0
    assert f"simulated again: {log}: {said}; kept as run.h5.corrupt" in stderr
    assert not log.is_symlink()
    assert (tmp_path / "elsewhere.h5").read_bytes() == before
    assert cli("inspect", log.with_name("run.h5.corrupt"))[0] == 0  # named, so it is followed


# ---------------------------------------------------------------- what logs say


@pytest.mark.parametrize(
    ("outcome", "said"),
    [
        ({"failure_reason": None}, "outcome does not say failure_reason"),
        ({"success": None}, "outcome does not say success"),
        ({"success": "yes"}, "outcome does not say success"),
        ({"solver_failures": "0"}, "outcome does not say solver_failures"),
        ({"solver_failures": False}, "outcome does not say solver_failures"),
        ({"failure_reason": "\ud800"}, "outcome is not JSON"),
        ({"speed_mean": float("nan")}, "outcome is not JSON"),
        ({"speed_mean": [1.0]}, "outcome has no plain value for 'speed_mean'"),
    ],
)
def test_a_log_without_a_verdict_is_made_again(cli, sweep, outcome, said):
    log = sorted(sweep.glob("*/run.h5"))[0]
    change(log, outcome)
    assert table(sweep).notes == [f"{log.parent.name}: damaged: {said}"]
    seed = json.loads(log.with_name("summary.json").read_text())["seed"]
    code, _, stderr = cli("run", "duration=0.5", f"seed={seed}", "--out", sweep)
    assert code == 0
    assert stderr == f"simulated again, the log there could not be used: {log}: {said}\n"
    change(log, outcome)
    code, _, stderr = cli("sweep", *SWEEP[:-2], "--out", sweep)
    assert code == 0
    assert f"simulated again: {log}: {said}; kept as run.h5.corrupt" in stderr
    assert table(sweep).notes == []


def test_a_run_that_is_there_may_lack_what_is_only_shown(cli, sweep):
    log = sorted(sweep.glob("*/run.h5"))[0]
    change(log, {"revolutions": "many", "behaviour": None, "speed_mean": None})
    seed = json.loads(log.with_name("summary.json").read_text())["seed"]
    code, stdout, _ = cli("run", "duration=0.5", f"seed={seed}", "--out", sweep)
    assert code == 0
    assert "rolled       - rev in 0.5 s" in stdout


def test_attributes_have_no_control_characters(cli, sweep):
    log = sorted(sweep.glob("*/run.h5"))[0]
    change(log, machine="\x1b[31m")
    said = "attribute 'machine' has a control character"
    assert table(sweep).notes == [f"{log.parent.name}: damaged: {said}"]
    assert cli("inspect", log) == (2, "", f"rotctl: {log}: {said}\n")


def test_configs_that_are_none_are_no_columns(every, sweep):
    for text, log in zip(
        ("a: 2026-13-45", "- " * 500), sorted(sweep.glob("*/run.h5")), strict=True
    ):
        change(log, config=text)
    assert [code for code, _, _ in every().values()] == [0, 0, 0]


def test_names_that_are_no_text_are_spelled_out(cli, sweep, tmp_path):
    odd = os.fsencode(sweep) + b"/\xff"
    os.rename(next(sweep.glob("*/run.h5")).parent, odd)
    assert cli("summarise", sweep)[0] == 0
    assert b"\\udcff/run.h5" in (sweep / "summary.csv").read_bytes()
    assert cli("report", sweep, "--out", tmp_path / "site")[0] == 0
