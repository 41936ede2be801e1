"""Criteria are no part of what is simulated: a run has one id, and as many verdicts as wanted."""

import csv
import io
import json
import shutil

import h5py
import mujoco
import pytest
from here import Here, swept, without_processes
from sweep_cli import logs

from rotctl.choices.listing import choices
from rotctl.cli.main import main
from rotctl.config.identity import run_id
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.log import RunLog
from rotctl.metrics.criteria import kinds
from rotctl.results.index import read
from rotctl.runs.run import make, run
from rotctl.runs.scenario import model_of
from rotctl.sweep.criteria import criteria
from rotctl.sweep.judging import judge
from rotctl.sweep.plan import planned
from rotctl.sweep.points import points

GRID = ("duration=2", "seed=range(0,2)")
STRICT = "criteria.stall_time=0.1"  # [s] nobody rolls a tenth of a revolution in as little


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A sweep to be looked at only."""
    return swept(tmp_path_factory.mktemp("made") / "sweep", *GRID)


def identity(*overrides):
    config = load(list(overrides))
    return run_id(config, model_of(config))


def simulated(log):
    return RunLog.open(log).verify()


def test_criteria_are_not_in_the_run_id_and_all_else_is():
    assert identity("seed=1") == identity("seed=1", STRICT)
    assert identity("behaviour=stand") == identity("behaviour=stand", "criteria=landing")
    assert identity("seed=1") != identity("seed=2")


@pytest.mark.parametrize("strict", [STRICT, "criteria.travel=[5,6]"])
def test_the_verdict_is_the_one_that_a_run_with_those_criteria_gets(made, tmp_path, strict):
    found = judge(made, criteria([strict]), Here())
    for row in found.table.rows.to_dict("records"):
        truth = run(load(["duration=2", f"seed={row['seed']}", strict]), tmp_path).summary
        assert (row["success"], row["failure_reason"]) == (False, truth["failure_reason"])
        assert row["success_before"]
        assert row["revolutions"] == truth["revolutions"]
    assert (found.lost, found.won) == (2, 0)


def test_the_command_leaves_logs_and_rows_as_they_are(made, capsys, monkeypatch):
    without_processes(monkeypatch)
    before = {log: log.read_bytes() for log in logs(made)}, (made / "runs.jsonl").read_bytes()
    assert main(["judge", str(made), STRICT]) == 0
    stdout, stderr = capsys.readouterr()
    assert "\nby these criteria: 2 no longer a success, 0 newly one\n" in stdout
    assert stderr == ""
    assert ({log: log.read_bytes() for log in logs(made)}, (made / "runs.jsonl").read_bytes()) == (
        before
    )
    rows = list(csv.DictReader(io.StringIO((made / "judged.csv").read_text())))
    assert [(row["success"], row["success_before"]) for row in rows] == [("False", "True")] * 2


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        (["seed=1"], "seed=1: judge takes criteria=CHOICE and criteria.KEY=VALUE alone"),
        ([], "no criteria; such as criteria=landing or criteria.stall_time=2, or --metric"),
        (["--metric", "revolutions=1"], "metric revolutions: there is a column of that name"),
        (["--metric", "seed=1"], "metric seed: a key of the config has that name; rename it"),
        (["--metric", "start=1"], "metric start: a key of the config has that name; rename it"),
        (["--metric", "duration=1"], "metric duration: a key of the config has that name"),
        (["--metric", "code=1"], "metric code: there is a column of that name already"),
        (["--metric", "n=1"], "metric n: there is a column of that name already"),
        (["--metric", "success_before=1"], "metric success_before: there is a column of that"),
        (["--metric", "top=max(kom)"], "metric top: no array 'kom' in a log; did you mean com? "),
        (["--metric", "top=com[:, 9]"], "metric top: index 9 is out of bounds for axis 1"),
        (["--metric", "top=com"], "metric top: gives 120 x 3 values; make one of them"),
        (["--metric", "a=1", "--metric", "a =2"], "--metric a: given twice, 1 and 2; rename one"),
        (["--metrics", "no.yaml"], "no.yaml: no such file"),
        (["criteria=none"], 'criteria="none": no such choice; valid: '),
        (
            ["criteria.no=1"],
            "no run can be judged: criteria=rolling: unknown key 'criteria.no'; valid ",
        ),
    ],
)
def test_what_it_does_not_take_is_one_line(made, capsys, monkeypatch, overrides, said):
    without_processes(monkeypatch)
    assert main(["judge", str(made), *overrides]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


def test_runs_that_cannot_be_judged_are_told(tmp_path, capsys, monkeypatch):
    swept(tmp_path, *GRID, "--keep", "sample:1")
    without_processes(monkeypatch)
    assert main(["judge", str(tmp_path), STRICT]) == 0
    assert "1 run not judged: its log was not kept; rotctl sweep" in capsys.readouterr().err
    assert main(["judge", str(tmp_path), "criteria=standing"]) == 2
    stderr = capsys.readouterr().err
    assert "no run can be judged: " in stderr
    assert "criteria=standing does not judge behaviour=forward_roll_1" in stderr


def test_of_runs_of_many_kinds_the_criteria_of_each_are_told(tmp_path, capsys, monkeypatch):
    swept(tmp_path, "behaviour=forward_roll_1,stand", "duration=1", "seed=2000")
    without_processes(monkeypatch)
    rolling, standing = (
        f"criteria={name}: unknown key 'criteria.tilt'; valid keys under criteria: "
        f"{', '.join(load([f'criteria={name}', *more]).criteria.__dict__)}"
        for name, *more in (("rolling",), ("standing", "behaviour=stand"))
    )
    assert main(["judge", str(tmp_path), "criteria.tilt=3"]) == 2
    said = f"rotctl: {tmp_path}: no run can be judged: "
    first, second = (f"{said}{a}; {b}\n" for a, b in ((rolling, standing), (standing, rolling)))
    assert capsys.readouterr().err in (first, second)  # by their ids


def test_of_runs_of_very_many_kinds_the_first_criteria_are_told(tmp_path, capsys, monkeypatch):
    kinds = "forward_roll_1,stand,back_flip,turn_over,handstand"
    swept(tmp_path, f"behaviour={kinds}", "duration=0.2", "seed=2000")
    without_processes(monkeypatch)
    assert main(["judge", str(tmp_path), "criteria.no=3"]) == 2
    said = capsys.readouterr().err
    assert said.count("unknown key 'criteria.no'") == 3
    assert said.endswith("; and 2 more\n")


def test_a_sweep_with_other_criteria_judges_what_is_there(tmp_path):
    swept(tmp_path, *GRID)
    before = [simulated(log) for log in logs(tmp_path)]
    swept(tmp_path, *GRID, STRICT)
    assert [simulated(log) for log in logs(tmp_path)] == before
    for log in logs(tmp_path):
        outcome = RunLog.open(log).outcome
        assert not outcome["success"]
        assert json.loads(log.with_name("summary.json").read_text()) == outcome
        assert dict(read(tmp_path).rows[log.parent.name].outcome) == outcome


def test_a_run_with_other_criteria_is_judged_and_not_simulated(tmp_path):
    first = run(load(["duration=2", "seed=1"]), tmp_path)
    second = run(load(["duration=2", "seed=1", STRICT]), tmp_path)
    assert (first.summary["success"], second.summary["success"]) == (True, False)
    assert second.already_there
    assert first.trajectory == second.trajectory == simulated(second.folder / "run.h5")


@pytest.mark.parametrize(
    "body",
    [
        ["plant=randomised", "disturbance=push"],
        ["disturbance=load", "disturbance.time=0.5", "disturbance.mass=20"],
    ],
)
def test_judged_again_it_has_the_same_measures(body, tmp_path):
    """Forces in body weights are of who was simulated, and a load is no part of that body."""
    given = ["duration=2", "seed=2001", *body]
    first = run(load(given), tmp_path)
    second = run(load([*given, STRICT]), tmp_path)
    verdict = ("success", "failure_reason")
    assert all(first.summary[key] != second.summary[key] for key in verdict)
    assert {k: v for k, v in first.summary.items() if k not in verdict} == {
        k: v for k, v in second.summary.items() if k not in verdict
    }
    log = RunLog.open(first.folder / "run.h5")
    weight = mujoco.MjModel.from_xml_string(log.model_xml).body_subtreemass[1] * 9.81
    assert first.summary["force_peak"] * weight == pytest.approx(first.summary["ground_force_peak"])


def test_points_that_differ_in_criteria_alone_are_refused():
    with pytest.raises(InputError, match="two points differ in their criteria alone"):
        planned(points([["seed=1", "criteria.stall_time=1,2"]]))


def test_a_column_means_the_same_whoever_judges():
    found = {}
    for kind in kinds.KINDS:
        for column in kind.COLUMNS:
            assert found.setdefault(column.name, column) == column


def test_criteria_that_fit_no_run_leave_the_table_as_it_was(tmp_path, capsys):
    swept(tmp_path, *GRID)
    (tmp_path / "judged.csv").write_text("before\n")
    capsys.readouterr()
    assert main(["judge", str(tmp_path), "criteria=landing"]) == 2
    assert "no run can be judged: " in capsys.readouterr().err
    assert (tmp_path / "judged.csv").read_text() == "before\n"


def test_metrics_of_ones_own_are_columns(made, tmp_path, capsys, monkeypatch):
    without_processes(monkeypatch)
    texts = tmp_path / "mine.yaml"
    texts.write_text("top: max(com[:, 2])\nin_air: mean(count == 0)\n")
    given = ["--metrics", str(texts), "--metric", "late=time[119] if 0 else 0"]
    assert main(["judge", str(made), *given]) == 2  # an expression has no `if`
    assert "metric late: IfExp is not allowed" in capsys.readouterr().err
    given[-1] = "late = first(com[:, 2] > 99)"
    assert main(["judge", str(made), *given]) == 0
    stdout, stderr = capsys.readouterr()
    assert "by these criteria" not in stdout, "none were given"
    assert "top" in stdout
    assert stderr == "2 runs: metric late: is nan, an empty cell\n"
    rows = list(csv.DictReader(io.StringIO((made / "judged.csv").read_text())))
    for row in rows:
        log = RunLog.open(made / row["log"])
        assert float(row["top"]) == log["trajectory/com"][:, 2].max()
        assert float(row["in_air"]) == pytest.approx(float(row["airborne"]))
        assert row["late"] == ""
    assert len(rows) == 2


def test_the_command_line_goes_before_a_file_of_metrics(made, tmp_path, monkeypatch):
    without_processes(monkeypatch)
    (tmp_path / "mine.yaml").write_text("a: '1'\nb: '2'\n")
    given = ["--metric", "a=3", "--metrics", str(tmp_path / "mine.yaml")]
    assert main(["judge", str(made), *given]) == 0
    rows = csv.DictReader(io.StringIO((made / "judged.csv").read_text()))
    assert {(float(row["a"]), float(row["b"])) for row in rows} == {(3.0, 2.0)}


def test_a_metric_that_is_infinite_is_told(made, capsys, monkeypatch):
    without_processes(monkeypatch)
    assert main(["judge", str(made), "--metric", "late=1/0"]) == 0
    assert capsys.readouterr().err == "2 runs: metric late: is inf, an empty cell\n"


def test_a_metric_that_some_runs_lack_is_told(tmp_path, capsys, monkeypatch):
    swept(tmp_path, "seed=1", "duration=1,2")
    without_processes(monkeypatch)
    assert main(["judge", str(tmp_path), "--metric", "late=com[100, 2]"]) == 0
    assert "1 run: metric late: index 100 is out of bounds" in capsys.readouterr().err


@pytest.mark.parametrize("text", ["- a", "top: 3", "top: [max(com)]", "x"])
def test_a_file_that_is_none_of_metrics(made, tmp_path, capsys, text):
    path = tmp_path / "mine.yaml"
    path.write_text(text)
    assert main(["judge", str(made), "--metrics", str(path)]) == 2
    assert "must be NAME: EXPRESSION, one a line" in capsys.readouterr().err


def test_a_folder_that_is_not_there_is_told_first(tmp_path, capsys):
    assert main(["judge", str(tmp_path / "none")]) == 2
    assert capsys.readouterr().err == f"rotctl: {tmp_path / 'none'}: no such folder\n"


@pytest.mark.parametrize("behaviour", ["back_flip", "dive_forward", "get_up", "forward_roll"])
def test_all_criteria_judge_a_short_run_or_refuse_it(behaviour):
    """A dive's look at points that a flip does not watch, say."""
    said, judged = [], []
    for name in choices("criteria"):
        config = load([f"behaviour={behaviour}", f"criteria={name}", "duration=0.1"])
        try:
            judged.append(make(config).summary["criteria"])
        except InputError as error:
            said.append(f"criteria={name} " in str(error))
    assert judged
    assert said
    assert all(said)


def test_a_flip_is_no_dive():
    with pytest.raises(InputError) as caught:
        make(load(["behaviour=back_flip", "criteria=dive", "duration=0.1"]))
    assert str(caught.value) == (
        "criteria=dive judges a dive by tasks of the law watch, and behaviour=back_flip has none "
        "of the name hand nor foot nor head nor pelvis"
    )


def test_a_chain_is_judged_by_what_its_parts_have_by_themselves(tmp_path):
    """`criteria=chain` names no parts: they came with the behaviour."""
    grid = ("behaviour=chain", "behaviour.parts=[stand,back_flip]", "duration=0.5")
    folder = swept(tmp_path / "sweep", *grid)
    (row,) = judge(folder, criteria(["criteria=chain"]), Here()).table.rows.to_dict("records")
    assert row["failure_reason"].startswith("part 1 of 3, stand: the run ends at 0.50 s, ")
    less = criteria(["criteria=chain", "criteria.parts.0.rest=0.1"])
    (row,) = judge(folder, less, Here()).table.rows.to_dict("records")
    assert row["failure_reason"] == "part 2 of 3, square, has not begun"


def test_a_log_that_was_changed_is_not_judged(made, tmp_path):
    folder = tmp_path / "sweep"
    shutil.copytree(made, folder)
    first, second = logs(folder)
    with h5py.File(first, "r+") as file:
        file["trajectory/com"][5, 2] += 0.1
    table = judge(folder, criteria([STRICT]), Here()).table
    assert table.rows.set_index("run_id")["status"].to_dict() == {
        first.parent.name: "not judged",
        second.parent.name: "done",
    }
    (note,) = table.notes
    assert note.endswith("damaged, its content does not match its SHA-256")
