"""Summaries: every run a row, rates with honest intervals, nothing averaged in silence."""

import csv
import io
import json
import shutil

import numpy as np
import pandas as pd
import pytest
from here import swept
from scipy.stats import norm

from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError, LogError
from rotctl.log import SCHEMA, RunLog, encode_run
from rotctl.metrics.rates import wilson
from rotctl.results import index
from rotctl.results.code import code_version
from rotctl.results.group_table import markdown
from rotctl.results.groups import grouped
from rotctl.results.lines import lines
from rotctl.results.manifest import Entry, read, write
from rotctl.results.stored_runs import DONE, MISSING, StoredRun, stored_runs
from rotctl.results.table import Table, _order, differing, table, tabulated
from rotctl.runs.run import make, run
from rotctl.settings.writing import to_dict

ARGUMENTS = [
    "behaviour=forward_roll_1_on_head,forward_roll_1_phase",
    "seed=range(0,3)",
    "duration=2",
]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A sweep to be looked at only."""
    return swept(tmp_path_factory.mktemp("made"), *ARGUMENTS)


@pytest.fixture
def sweep(made, tmp_path):
    """A copy of it, to be harmed."""
    return shutil.copytree(made, tmp_path / "sweep")


def change(log, outcome=None, **attributes):
    """Write a log again with other attributes, or another outcome."""
    whole = RunLog.open(log)
    names = ("config", "run_id", "seed", "versions", "machine", "wall_time")
    kept = {name: whole.attributes[name] for name in (*names, "git_commit", "git_dirty")}
    kept["outcome"] = {**whole.outcome, **(outcome or {})}
    arrays = {name: whole[name] for name in SCHEMA if name != "model/mjcf"}
    log.write_bytes(encode_run(arrays, model_xml=whole.model_xml, attributes=kept | attributes))


# ---------------------------------------------------------------- the interval


@pytest.mark.parametrize(
    ("succeeded", "n", "low", "high"),
    [
        # Newcombe (1998), table I, method 3, to the four digits it gives.
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0.0000, 0.1611),
        (1, 29, 0.0061, 0.1718),
        # By the formula's symmetry.
        (20, 20, 0.8389, 1.0000),
    ],
)
def test_wilson_against_published_values(succeeded, n, low, high):
    assert wilson(succeeded, n) == pytest.approx((low, high), abs=5e-5)


def test_wilson_solves_the_score_equation():
    z = norm.ppf(0.975)
    for succeeded, n in [(1, 3), (45, 50), (99, 100)]:
        for bound in wilson(succeeded, n):
            score = (succeeded / n - bound) / np.sqrt(bound * (1 - bound) / n)
            assert abs(score) == pytest.approx(z)


def test_runs_that_are_the_same_make_no_interval_narrower():
    assert wilson(10, 10, 10) == wilson(10, 10)
    assert wilson(10, 10, 1) == wilson(1, 1)
    low, high = wilson(99, 100, 2)
    assert low < wilson(1, 2)[1] < 0.99 < high


def test_wilson_of_all_and_of_none_ends_where_rates_do():
    assert all(wilson(n, n)[1] == 1.0 and wilson(0, n)[0] == 0.0 for n in range(1, 200))


def test_wilson_of_nothing_says_nothing():
    assert wilson(0, 0) == (0.0, 1.0)


# ---------------------------------------------------------------- the table


def test_a_row_a_run_with_the_overridden_keys_as_columns(made):
    found_ = table(made)
    rows = found_.rows
    assert found_.keys == ["behaviour", "config.duration", "seed"]
    assert list(rows.columns[:5]) == ["run_id", "status", *found_.keys]
    assert list(zip(rows["behaviour"], rows["seed"], strict=True)) == [
        (name, seed)
        for name in ("forward_roll_1_on_head", "forward_roll_1_phase")
        for seed in range(3)
    ]
    assert set(rows["status"]) == {"done"}
    assert set(rows["config.duration"]) == {2.0}
    assert found_.notes == []
    for _, row in rows.iterrows():
        summary = json.loads((made / row["run_id"] / "summary.json").read_text())
        assert row["revolutions"] == summary["revolutions"]
        assert row["log"] == f"{row['run_id']}/run.h5"


def test_the_command_prints_markdown_and_writes_csv(sweep, capsys):
    assert main(["summarise", str(sweep)]) == 0
    stdout, stderr = capsys.readouterr()
    lines = stdout.splitlines()
    assert stderr == ""
    assert lines[0].startswith("| behaviour              | n | success [95 %]  |")
    assert set(lines[1]) == set("| -")
    assert lines[2].startswith("| forward_roll_1_on_head | 3 | 100 % [44, 100] |")
    (same,) = [line for line in lines if line.startswith("The same in all runs: ")]
    assert "duration 2, " in same
    assert "config.duration" not in same
    assert "criteria" not in stdout  # words, of which no median is
    assert lines[-2:] == [str(sweep / "summary.csv"), str(sweep / "groups.csv")]
    rows = list(csv.DictReader(io.StringIO((sweep / "summary.csv").read_text())))
    assert len(rows) == 6
    (first, _) = list(csv.DictReader(io.StringIO((sweep / "groups.csv").read_text())))
    assert (first["n"], first["succeeded"], first["success_rate"]) == ("3", "3", "1.0")
    before = (sweep / "summary.csv").read_bytes(), (sweep / "groups.csv").read_bytes()
    assert main(["summarise", str(sweep)]) == 0
    assert ((sweep / "summary.csv").read_bytes(), (sweep / "groups.csv").read_bytes()) == before


def test_by_any_column_and_a_wrong_one_is_named(made, capsys):
    found_ = table(made)
    assert list(grouped(found_, ["seed"]).rows["n"]) == [2, 2, 2]
    assert list(grouped(found_, []).rows["n"]) == [6]
    with pytest.raises(
        InputError, match=r"^--by: no column 'sed'; did you mean seed\? valid: run_"
    ):
        grouped(found_, ["sed"])


def test_quartiles_are_those_of_the_runs(made):
    found_ = table(made)
    (row,) = grouped(found_, []).rows.to_dict("records")
    values = found_.rows["revolutions"]
    assert row["revolutions_q25"] == np.percentile(values, 25)
    assert row["revolutions_median"] == np.median(values)
    assert row["revolutions_q75"] == np.percentile(values, 75)


def test_one_key_stands_in_the_table_and_what_is_the_same_below_it():
    row = {"run_id": "a", "status": "done", "behaviour": "roll", "plant": "varied", "seed": 0}
    rows = pd.DataFrame([row | {"success": True, "code": "", "kind": "rolling", "top": 1.0}])
    found = grouped(Table(rows, ["behaviour", "plant", "seed"], ["kind", "top"], []))
    assert found.metrics == ["top"]
    assert markdown(found).splitlines()[0] == "| behaviour | n | success [95 %]  |"
    assert markdown(found).endswith("The same in all runs: plant varied, top 1.")


def test_what_one_run_has_otherwise_is_not_the_same_in_all_runs():
    """Quartiles do not see one run of nine, and what a run lacks is not what others have."""
    rows = pd.DataFrame({"behaviour": "a", "status": DONE, "success": True, "code": ""}, range(9))
    rows["failures"] = [0] * 8 + [5]
    rows["lean"] = [None] * 6 + [42.14] * 3
    rows["recovered"] = [None] * 7 + [1, 0]
    rows["height"] = [0.5] * 8 + [0.50001]
    measured = ["failures", "lean", "recovered", "height"]
    found = grouped(Table(rows, ["behaviour"], measured, []))
    head, _, told, _, same = markdown(found).splitlines()
    assert head.startswith("| behaviour | n | success [95 %]  | failures | lean ")
    assert told.split("|")[4:-1] == [" 0        ", " 42.1 of 3 ", " 50 % of 2 "]
    assert same == "The same in all runs: height 0.5."
    (row,) = found.rows.to_dict("records")
    assert (row["lean_n"], row["recovered_n"]) == (3, 2)
    assert "failures_n" not in row
    rows["seed"], rows.loc[:1, "status"] = range(9), "not run"  # the first groups have no result
    rows.loc[:1, measured] = None
    text = markdown(grouped(Table(rows, ["behaviour", "seed"], measured, []), ["seed"]))
    assert text.splitlines()[-1] == "The same in all runs: height 0.5."


def test_long_values_that_begin_alike_are_not_told_to_be_the_same():
    rows = [
        {"run_id": f"{i}", "status": DONE, "behaviour": "a", "key": 90 * "x" + end, "success": True}
        for i, end in enumerate("ab")
    ]
    columns = {"code": "", "log": "", "trajectory": ""}
    frame = pd.DataFrame([row | columns for row in rows])
    text = markdown(grouped(Table(frame, ["behaviour", "key"], [], [])))
    assert text.splitlines()[0].split()[:5] == ["|", "behaviour", "|", "key", "|"]
    assert "The same" not in text


def test_criteria_that_the_parts_of_a_chain_bring_along_are_no_column_of_their_own():
    def config(name, rest):
        return {
            "behaviour": {"name": "chain", "parts": [{"behaviour": {"name": name}}]},
            "criteria": {"name": "chain", "parts": [{"name": name, "rest": rest}]},
        }

    assert differing([config("a", 1), config("b", 2)]) == ["behaviour.parts"]
    assert differing([config("a", 1), config("a", 2)]) == ["criteria.parts"]
    three = [config("a", 1), config("a", 2), config("b", 2)]
    assert differing(three) == ["behaviour.parts", "criteria.parts"]


def test_of_stages_those_keys_are_told_that_differ():
    swept = "behaviour.stages.0.poses.a.knee"
    both = [
        to_dict(load([f"behaviour={name}", f"{swept}={knee}"]))
        for name in ("square", "stand")
        for knee in (0.2, 0.3)
    ]
    assert differing(both[:2]) == [swept]
    assert swept in differing(both)
    assert "behaviour.stages" not in differing(both)
    other = {**both[0], "behaviour": {**both[0]["behaviour"], "stages": []}}
    assert differing([both[0], other]) == ["behaviour.stages"]  # of other stages all is told


def test_runs_that_are_the_same_to_the_bit_are_told_and_count_once():
    """Seeds of a start of one state draw nothing; of a log without a row nobody knows."""
    configs = [{"behaviour": {"name": "roll"}, "seed": seed} for seed in range(6)]
    digests = ["a", "a", "a", "b", "", ""]
    made_of = [
        StoredRun(f"{i}", DONE, outcome={"success": True}, config=config, trajectory=digest)
        for i, (config, digest) in enumerate(zip(configs, digests, strict=True))
    ]
    found = grouped(tabulated(made_of, []))
    (row,) = found.rows.to_dict("records")
    assert (row["n"], row["distinct"]) == (6, 4)
    assert (row["success_low"], row["success_high"]) == wilson(4, 4)
    assert found.notes[0].startswith("6 runs, 4 distinct: ")
    assert markdown(found).splitlines()[0] == "| behaviour | n | distinct | success [95 %]  |"
    apart = grouped(tabulated(made_of[2:], []))
    assert apart.notes == []
    assert "distinct" not in markdown(apart)


def test_rows_of_a_sweep_tell_what_was_simulated(made):
    digests = {row.run_id: row.trajectory for row in index.read(made).rows.values()}
    rows = table(made).rows
    assert dict(zip(rows["run_id"], rows["trajectory"], strict=True)) == digests


def test_quartiles_are_of_the_values_that_are_there():
    """Groups of one run to four, with none, some and all of their values, words and infinities."""
    values = [1.5, None, 2, "x", True, None, None, 3.25, 0.1, 0.7, np.inf, -1.0, 2.5]
    names = [0, 1, 2, 2, 2, 3, 3, 4, 4, 4, 4, 5, 5]
    state = ["done"] * 12 + ["not run"]
    rows = pd.DataFrame({"x": names, "m": values, "status": state, "success": True, "code": ""})
    groups = grouped(Table(rows, ["x"], ["m"], []), ["x"]).rows
    for _, group in groups.iterrows():
        there = rows[(rows["x"] == group["x"]) & (rows["status"] == "done")]
        wanted = pd.to_numeric(there["m"], errors="coerce").astype(float)
        found = group[["m_q25", "m_median", "m_q75"]].astype(float)
        np.testing.assert_array_equal(found, wanted.quantile([0.25, 0.5, 0.75]))
    assert list(groups["n"]) == [1, 1, 3, 2, 4, 1]


def test_a_roll_that_fell_counts_and_a_failed_run_is_told(sweep, capsys):
    logs = sorted(sweep.glob("*/run.h5"))
    change(logs[0], {"success": False, "failure_reason": "stalled"})
    entries = read(sweep)
    for log, reason in zip(logs[1:3], ("its worker died", ""), strict=True):
        name = log.parent.name
        entries[name] = Entry(name, entries[name].values, reason)
        log.unlink()
    write(sweep, entries.values())
    found_ = table(sweep)
    assert sorted(found_.rows["status"]) == ["done"] * 4 + ["failed to run", "not run"]
    assert len(found_.rows) == 6
    assert found_.notes == [
        f"{logs[1].parent.name}: failed to run: its worker died",
        "1 run of the sweep is not there; the same command does what is left",
    ]
    groups = grouped(found_, [])
    (row,) = groups.rows.to_dict("records")
    assert (row["n"], row["succeeded"], row["no_result"]) == (4, 3, 2)
    assert "| 4 | 2         | 75 % [30, 95]  |" in markdown(groups)
    assert main(["ls", str(sweep)]) == 0
    listed = [line.split("-  ")[-1] for line in capsys.readouterr().out.splitlines()]
    assert {"not run", "failed to run: its worker died"} <= {line.strip() for line in listed}


def test_a_run_that_is_not_there_is_told_in_its_group(tmp_path):
    """What a behaviour brings along makes columns, and the run has them as its group does."""
    sweep = swept(tmp_path, "behaviour=forward_roll_1,stand", "seed=range(0,2)", "duration=0.5")
    rows = table(sweep).rows
    (sweep / rows["log"][rows["behaviour"] == "stand"].iloc[0]).unlink()
    found = grouped(table(sweep))
    assert "controller" in found.keys
    rows = found.rows.set_index("behaviour")
    assert list(rows.index) == ["forward_roll_1", "stand"]
    assert (rows["n"]["stand"], rows["no_result"]["stand"]) == (1, 1)
    assert rows["controller"]["stand"] == "standing"


def test_runs_that_are_not_put_into_their_groups_are_told():
    """Which group a run without a result is of is looked up for so many sweeps and no more."""
    config = {"behaviour": {"name": "roll"}, "character": {"name": "adult"}, "seed": 0}
    there = StoredRun("there", DONE, outcome={"success": True}, config=config)
    other = {**config, "character": {"name": "baby"}, "behaviour": {"name": "crawl"}}
    another = StoredRun("another", DONE, outcome={"success": True}, config=other)
    lacking = [
        StoredRun(f"{i}", MISSING, values={"behaviour": "roll", f"x.k{i}": i, "seed": 1})
        for i in range(22)
    ]
    (*_, note, missing) = tabulated([there, another, *lacking], []).notes
    assert missing.startswith("22 runs of the sweep are not there")
    assert note == (
        "2 runs without a result stand apart from their groups: groups are looked up for runs of "
        "20 sweeps, and here are 22"
    )
    (note, _) = tabulated([there, another, *lacking[:21]], []).notes
    assert note.startswith("1 run without a result stands apart from its group: groups")
    assert len(tabulated([there, another, *lacking[:20]], []).notes) == 1


def test_rows_whose_logs_are_not_there_are_told(sweep, tmp_path, capsys):
    """Of a sweep without a list of its runs, as of two whose rows were joined."""
    joined = tmp_path / "joined"
    joined.mkdir()
    shutil.copy(sweep / "runs.jsonl", joined)
    told = f"{joined}/runs.jsonl: 6 of its runs had logs that are not there, left out"
    assert main(["summarise", str(joined)]) == 2
    assert capsys.readouterr().err == f"rotctl: {joined}: no runs in it: {told}\n"
    for log in sorted(sweep.glob("*/run.h5"))[:2]:
        shutil.copytree(log.parent, joined / log.parent.name)
    assert main(["summarise", str(joined)]) == 0
    assert capsys.readouterr().err == told.replace("6 of", "4 of") + "\n"
    assert table(sweep).notes == []


def test_a_damaged_log_is_a_row_and_leftovers_are_not(sweep):
    (log, *others) = sorted(sweep.glob("*/run.h5"))
    log.write_bytes(log.read_bytes()[:1000])
    others[0].with_name("run.h5.part").touch()
    others[0].with_name("run.h5.corrupt").touch()
    (sweep / "notes.txt").write_text("not ours")
    found_ = table(sweep)
    assert len(found_.rows) == 6
    (row,) = found_.rows[found_.rows["status"] == "damaged"].to_dict("records")
    assert row["run_id"] == log.parent.name
    assert found_.notes == [f"{log.parent.name}: damaged: truncated or damaged HDF5 file"]
    assert row["behaviour"] in ("forward_roll_1_on_head", "forward_roll_1_phase")


def test_runs_below_deeper_folders_count_once(made, tmp_path):
    for name in ("one", "two"):
        shutil.copytree(made, tmp_path / name)
    runs, copies = stored_runs(tmp_path)
    assert len(runs) == 6
    assert len(copies) == 6
    assert copies[0].endswith("again, counted once")


def test_without_a_sweep_the_keys_are_those_that_differ(tmp_path):
    for overrides in (["seed=1"], ["seed=2", "controller.pose.damping=39"]):
        run(load(["duration=0.5", *overrides]), tmp_path)
    found_ = table(tmp_path)
    assert found_.keys == ["behaviour", "controller.pose.damping", "seed"]
    assert sorted(found_.rows["seed"]) == [1, 2]
    assert len(grouped(found_).rows) == 2


def test_what_some_runs_have_is_named_and_differs_among_those_of_its_name(tmp_path):
    """An end of a roll has no name; its stages have, and its numbers are told once."""
    end = {"after": 8.0, "stages": [{"name": "stand", "poses": {"a": {"knee": 0.1}}}]}
    seat = {"after": 8.0, "stages": [{"name": "squat"}, {"name": "stand"}]}
    configs = [
        {"behaviour": {"name": "roll", "finish": finish, "course": course}, "seed": 0}
        for finish, course in (
            (None, {"name": "circle", "legs": [1]}),
            (end, {"name": "slalom", "legs": [2]}),
            (end | {"after": 1.5}, None),
            (seat, None),
        )
    ]
    made_of = [
        StoredRun(str(i), DONE, outcome={"success": True}, config=config)
        for i, config in enumerate(configs)
    ]
    found = tabulated(made_of, [])
    keys = ["behaviour.finish", "behaviour.finish.after", "behaviour.course"]
    assert found.keys == ["behaviour", *keys, "seed"]
    assert set(found.rows["behaviour.finish"].dropna()) == {"stand", "squat, stand"}
    assert len(grouped(found).rows) == 4
    (line,) = [line for line in lines(made_of, tmp_path) if line.startswith("2 ")]
    assert "  behaviour.finish=stand behaviour.finish.after=1.5  " in line


def test_a_foreign_run_in_a_sweep_is_not_pooled_with_what_it_differs_from(sweep):
    mine = ["behaviour=forward_roll_1_on_head", "duration=0.5", "controller.pose.damping=39"]
    run(load(mine), sweep)
    groups = grouped(table(sweep))
    assert "controller.pose.damping" in groups.keys
    assert sorted(groups.rows["n"]) == [1, 3, 3]


def test_other_code_is_kept_apart_or_said(sweep, capsys):
    log = sorted(sweep.glob("*/run.h5"))[0]
    change(log, git_commit="0123456789", git_dirty=False)
    found_ = table(sweep)
    apart = grouped(found_, [])
    assert apart.keys == ["code"]
    assert sorted(apart.rows["n"]) == [1, 5]
    assert apart.notes[0].startswith(
        "made by 2 versions of the code, kept apart; --mixed averages over them: rotctl "
    )
    together = grouped(found_, [], mixed=True)
    assert list(together.rows["n"]) == [6]
    assert together.notes[0].startswith("made by 2 versions of the code, averaged all the same: ")
    main(["summarise", str(sweep), "--by", "behaviour"])
    assert "made by 2 versions of the code, kept apart" in capsys.readouterr().err


def test_a_log_that_lies_about_its_outcome_is_damaged(sweep):
    log = sorted(sweep.glob("*/run.h5"))[0]
    change(log, versions={"python": "3"})
    assert table(sweep).notes == [
        f"{log.parent.name}: damaged: versions are not those of a rotctl log"
    ]


@pytest.mark.parametrize("inside", [None, "empty"])
def test_no_runs_is_one_line(tmp_path, capsys, inside):
    folder = tmp_path / "out"
    message = f"rotctl: {folder}: no such folder\n"
    if inside:
        folder.mkdir()
        message = f"rotctl: {folder}: no runs in it; rotctl sweep --out {folder} makes some\n"
    assert main(["summarise", str(folder)]) == 2
    assert capsys.readouterr().err == message


def test_text_from_logs_cannot_break_the_table():
    rows = pd.DataFrame([{"status": "done", "success": True, "code": "c", "x": "a|b\nc", "m": 1.0}])
    text = markdown(grouped(Table(rows, ["x"], ["m"], []), ["x"]))
    assert text.splitlines()[2].startswith("| a\\|b c | 1 |")


def test_the_summary_of_a_run_in_memory_is_the_one_in_its_log(tmp_path):
    made = make(load(["duration=0.5"]))
    path = tmp_path / "run.h5"
    path.write_bytes(made.log)
    assert RunLog.open(path).outcome == made.summary


@pytest.mark.parametrize(
    ("outcome", "reason"),
    [
        ({"success": "yes"}, "outcome does not say success"),
        ({"revolutions": [1.0]}, "outcome has no plain value for 'revolutions'"),
        ({"revolutions": 1e300}, "outcome has no plain value for 'revolutions'"),
        ({"revolutions": 1e400}, "outcome is not JSON"),
        ({"revolutions": 2**70}, ""),
    ],
)
def test_an_outcome_that_rotctl_does_not_write_is_damage(sweep, outcome, reason):
    log = sorted(sweep.glob("*/run.h5"))[0]
    change(log, outcome)
    assert table(sweep).notes == ([f"{log.parent.name}: damaged: {reason}"] if reason else [])


def test_rows_stand_by_numbers_then_text_then_what_is_not_there():
    assert sorted([None, "b", 2, "a", 1.5], key=_order) == [1.5, 2, "a", "b", None]


def test_code_is_told_by_versions_and_the_beginning_of_its_commit():
    made = {"versions": {"rotctl": "0.1.0", "mujoco": "4.0.0"}, "git_commit": "0123456789abcdef"}
    told = [code_version(made | {"git_dirty": dirty}) for dirty in (False, True)]
    assert told == [
        "rotctl 0.1.0 (0123456), mujoco 4.0.0",
        "rotctl 0.1.0 (0123456 with changes), mujoco 4.0.0",
    ]
    with pytest.raises(LogError, match="versions are not those of a rotctl log"):
        code_version({"versions": "{}", "git_commit": "", "git_dirty": False})
