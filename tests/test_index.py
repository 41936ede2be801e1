"""The rows of a sweep: what is done without a log, what a kill leaves, what a stranger may say."""

import json
import os
import zlib

import pytest
from here import Here, swept

from rotctl.cli.main import main
from rotctl.log import RunLog
from rotctl.results import index
from rotctl.results.table import table
from rotctl.settings.documents import DEEPEST
from rotctl.sweep.keep import Keep
from rotctl.sweep.keep import read as read_keep
from rotctl.sweep.launch import Tally, launch
from rotctl.sweep.messages import at_the_end, at_the_start
from rotctl.sweep.plan import Plan, plan, planned
from rotctl.sweep.points import points

GRID = ("duration=0.5", "seed=range(0,3)")


def runs_of(*grid):
    return planned(points([list(grid)]))


def sweep(out, *grid, keep=Keep()):  # noqa: B008
    out.mkdir(exist_ok=True)
    runs, engine = runs_of(*grid), Here()
    there = plan(runs, out, keep=keep)
    return launch(there, runs, out, engine, 0), there, engine


def rows(out):
    return index.read(out).rows


def checked(data):
    """A line with a checksum that fits."""
    body = b'", ' + json.dumps(data).encode()[1:]
    return b'{"crc": "%08x' % zlib.crc32(body) + body + b"\n"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Rows alone, to be looked at only."""
    return swept(tmp_path_factory.mktemp("made") / "rows", *GRID, "--keep", "rows")


@pytest.fixture
def harmed(made, tmp_path):
    """A copy of them to be harmed: its folder and the lines of its index."""
    (tmp_path / "runs.jsonl").write_bytes((made / "runs.jsonl").read_bytes())
    return tmp_path, (made / "runs.jsonl").read_bytes().splitlines(keepends=True)


# ---------------------------------------------------------------- what is kept


def test_the_table_of_rows_is_the_table_of_logs(made, tmp_path):
    logs = table(swept(tmp_path, *GRID)).rows.drop(columns=["log", "real_time_factor"])
    found = table(made).rows
    assert list(found["log"]) == ["", "", ""]
    assert found.drop(columns=["log", "real_time_factor"]).equals(logs)
    assert sorted(os.listdir(made)) == ["runs.jsonl", "sweep.jsonl", "sweep.lock"]


@pytest.mark.parametrize(("keep", "kept"), [("sample:3", 3), ("failures", 2), ("rows", 0)])
def test_whose_logs_are_kept(tmp_path, keep, kept):
    """Two of the four are too short for a whole revolution."""
    sweep(tmp_path, "duration=0.5,2", "seed=range(0,2)", keep=read_keep(keep))
    logs = [RunLog.open(path) for path in tmp_path.glob("*/run.h5")]
    assert (len(rows(tmp_path)), len(logs)) == (4, kept)
    if keep == "failures":
        assert not any(log.outcome["success"] for log in logs)


def test_rows_suffice_until_logs_are_asked_for(tmp_path):
    sweep(tmp_path, *GRID, keep=Keep("rows"))
    before = rows(tmp_path)
    assert sweep(tmp_path, *GRID, keep=Keep("rows"))[2].asked == 0
    assert sweep(tmp_path, *GRID)[2].asked == 3
    assert {name: row.trajectory for name, row in rows(tmp_path).items()} == {
        name: row.trajectory for name, row in before.items()
    }
    assert (
        sweep(tmp_path, *GRID)[2].asked == sweep(tmp_path, *GRID, keep=Keep("rows"))[2].asked == 0
    )


def test_the_index_is_made_again_out_of_logs(tmp_path):
    sweep(tmp_path, *GRID)
    before = rows(tmp_path)
    (tmp_path / "runs.jsonl").unlink()
    _, there, engine = sweep(tmp_path, *GRID)
    assert (engine.asked, len(there.unlisted)) == (0, 3)
    assert rows(tmp_path) == before
    assert not sweep(tmp_path, *GRID)[1].unlisted


@pytest.mark.exact
def test_a_run_without_a_log_can_be_had_again(made, tmp_path, capsys):
    name, row = next(iter(rows(made).items()))
    arguments = ["run", "--again", str(made / name), "--out", str(tmp_path)]
    assert main(arguments) == 0
    assert f"the same bits as in the sweep: run {name}" in capsys.readouterr().err
    assert RunLog.open(tmp_path / name / "run.h5").verify() == row.trajectory


def test_other_bits_are_told(harmed, capsys):
    folder, lines = harmed
    data = json.loads(lines[-1])
    del data["crc"]
    data["trajectory"] = "0" * 64
    (folder / "runs.jsonl").write_bytes(b"".join([*lines[:-1], checked(data)]))
    arguments = ["run", "--again", str(folder / data["run_id"]), "--out", str(folder / "runs")]
    assert main([*arguments, "--quiet"]) == 1
    assert capsys.readouterr().err.startswith(
        f"rotctl: other bits than in the sweep: run {data['run_id']}, made by rotctl "
    )


# ---------------------------------------------------------------- kills and strangers


@pytest.mark.parametrize("cut", [1, 30, 300])
def test_a_line_that_was_cut_off_is_no_row(harmed, cut):
    folder, lines = harmed
    whole = b"".join(lines)
    (folder / "runs.jsonl").write_bytes(whole[:-cut])
    assert len(rows(folder)) == 2
    _, there, engine = sweep(folder, *GRID, keep=Keep("rows"))
    assert (engine.asked, len(there.done)) == (1, 2)
    assert (len(rows(folder)), index.read(folder).damaged) == (3, 0)


def test_a_flipped_bit_is_told_and_its_run_made_again(harmed):
    folder, lines = harmed
    middle = len(lines[-1]) // 2
    flipped = lines[-1][:middle] + bytes([lines[-1][middle] ^ 1]) + lines[-1][middle + 1 :]
    (folder / "runs.jsonl").write_bytes(b"".join([*lines[:-1], flipped]))
    assert table(folder).notes == [f"{folder}/runs.jsonl: 1 line damaged, left out"]
    _, there, engine = sweep(folder, *GRID, keep=Keep("rows"))
    assert engine.asked == 1
    told = at_the_start(there, folder, "1 worker", 3, 3)
    assert told.splitlines() == [
        f"{folder}/runs.jsonl: 1 line damaged, left out",
        f"1 run to do in {folder}, 2 are there already; on 1 worker",
    ]


def test_one_run_that_is_there_is_told_as_one(tmp_path):
    there = Plan(done={"a": {"success": True}}, other_code={"older code": 1})
    assert at_the_start(there, tmp_path, "1 worker", 1, 1).splitlines() == [
        "1 of the runs there was made by older code; --strict redoes it",
        f"0 runs to do in {tmp_path}, 1 is there already; on 1 worker",
    ]
    assert at_the_end(Tally(1, 0, {}), there, tmp_path).splitlines()[0] == (
        "1 run: 1 succeeded, 0 did not, 0 failed to run, 1 of them was there before"
    )


def test_lines_that_were_no_runs_make_none_again(harmed):
    folder, lines = harmed
    (folder / "runs.jsonl").write_bytes(b"".join([b"no row\n", *lines, b"nor this\n"]))
    _, there, engine = sweep(folder, *GRID, keep=Keep("rows"))
    assert engine.asked == 0
    assert at_the_start(there, folder, "1 worker", 3, 3).splitlines() == [
        f"{folder}/runs.jsonl: 2 lines damaged, left out",
        f"0 runs to do in {folder}, 3 are there already; on 1 worker",
    ]


@pytest.mark.parametrize(
    "change",
    [
        {"run_id": "../../etc"},
        {"run_id": 3},
        {"seed": "1"},
        {"config": "nothing"},
        {"config": ["a"]},
        {"outcome": [1]},
        {"columns": "nothing"},
        {"trajectory": "x"},
        {"log": [1]},
        {"log": ["1", "2"]},
        {"wall_time": "1"},
        {"wall_time": None},
        {"origin": "nothing"},
        {"is": 3},
    ],
)
def test_a_row_that_rotctl_does_not_write_is_none(harmed, change):
    folder, lines = harmed
    data = json.loads(lines[-1])
    del data["crc"]
    line = checked({**data, **change})
    (folder / "runs.jsonl").write_bytes(b"".join([*lines[:-1], line]))
    found = index.read(folder)
    assert (len(found.rows), found.damaged) == (2, 1)


@pytest.mark.parametrize("text", ["[" * 100_000, '{"a": ' * 5000, "NaN", '{"is": 1e999}'])
def test_json_that_is_none_does_no_harm(harmed, text):
    folder, lines = harmed
    body = b'", ' + text.encode()
    line = b'{"crc": "%08x' % zlib.crc32(body) + body + b"\n"
    (folder / "runs.jsonl").write_bytes(b"".join([line, *lines]))
    assert (len(rows(folder)), index.read(folder).damaged) == (3, 1)


@pytest.mark.parametrize("kind", ["pipe", "link", "folder"])
def test_what_is_no_plain_file_is_refused(harmed, capsys, kind):
    folder, _ = harmed
    path = folder / "runs.jsonl"
    path.rename(folder / "other")
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "link":
        path.symlink_to(folder / "other")
    else:
        path.mkdir()
    reason = {
        "pipe": "is no plain file",
        "link": "is a link; only plain files are read here",
        "folder": "is a folder",
    }[kind]
    for command in (["sweep", *GRID, "--out", folder, "--quiet"], ["summarise", folder]):
        assert main(list(map(str, command))) == 2
        if kind != "folder" or command[0] == "sweep":
            assert capsys.readouterr().err == f"rotctl: {path}: {reason}\n"


def test_two_indices_joined_are_one(made, tmp_path):
    other = swept(tmp_path / "other", "duration=0.5", "seed=range(3,5)", "--keep", "rows")
    joined = (made / "runs.jsonl").read_bytes() + (other / "runs.jsonl").read_bytes()
    (tmp_path / "runs.jsonl").write_bytes(joined)
    assert rows(tmp_path) == {**rows(made), **rows(other)}


@pytest.mark.parametrize(("keys", "levels"), [("x", 3000), ("xy", 40)])
def test_parts_that_name_parts_stay_as_small_as_a_config(tmp_path, keys, levels):
    """One in the other they would be deeper, or larger, than any reader bears."""
    lines = [checked({"name": "z0", "is": {"a": 1}})]
    for level in range(1, levels):
        inner = {key: {"=": f"z{level - 1}"} for key in keys}
        lines.append(checked({"name": f"z{level}", "is": inner}))
    (tmp_path / "runs.jsonl").write_bytes(b"".join(lines))
    found = index.read(tmp_path)
    assert found.damaged > levels // 2
    assert len(found.named) + found.damaged == levels


def test_configs_are_no_deeper_than_documents_may_be():
    nested = 1
    for _ in range(DEEPEST):
        nested = {"a": nested}
    index.require_size(nested)
    with pytest.raises(ValueError, match="without end"):
        index.require_size([nested])
