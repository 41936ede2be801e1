"""`rotctl verify`: what repeats is said to, and of what does not, where and why."""

import json
import os
import re
from dataclasses import replace

import numpy as np
import pytest
from logs import changed

from rotctl.cli.main import main
from rotctl.config.loading import load, recorded
from rotctl.errors import InputError, LogError
from rotctl.log import RunLog
from rotctl.runs import repetition as verifying
from rotctl.runs.repetition import repeat
from rotctl.runs.run import make
from rotctl.runs.scenario import build
from rotctl.runs.summary import judged_again

ROWS = 30


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    return logged(tmp_path_factory.mktemp("log"), "duration=0.5")


@pytest.fixture(autouse=True)
def clean(monkeypatch):
    """As if this were committed code: else each run's code might be any."""
    found = verifying.origin
    monkeypatch.setattr(verifying, "origin", lambda scenario: {**found(scenario), **COMMIT})


COMMIT = {"git_commit": 40 * "a", "git_dirty": False}


def logged(folder, *overrides):
    (folder / "made.h5").write_bytes(make(load(list(overrides))).log)
    return changed(RunLog.open(folder / "made.h5"), folder, **COMMIT)


def said(capsys, *arguments):
    code = main(["verify", *map(str, arguments)])
    stdout, stderr = capsys.readouterr()
    assert stderr == ""
    return code, stdout


def with_row(log, folder, name, row):
    """The log with one row of a dataset a little different."""
    array = log[name].copy()
    array[row] += np.array(1e-6, array.dtype)
    return changed(log, folder, {name: array})


def with_bit(log, folder, name, row):
    """The log with the last bit of one number another."""
    array = log[name].copy()
    numbers = array.reshape(len(array), -1)
    numbers[row, 0] = np.nextafter(numbers[row, 0], np.array(9, array.dtype))
    return changed(log, folder, {name: array})


# ---------------------------------------------------------------- the same


def test_a_log_of_this_code_repeats(log, capsys):
    before = sorted(os.listdir(log.path.parent))
    assert said(capsys, log.path) == (
        0,
        f"{log.path}: same bits: {ROWS} steps, the model, events and outcome\n",
    )
    assert sorted(os.listdir(log.path.parent)) == before


@pytest.mark.parametrize(
    "overrides",
    [
        ["behaviour=uneven_terrain", "seed=5", "duration=0.3"],
        ["physics=lockstep", "behaviour=sideways_roll", "duration=0.3"],
        ["start.speed_x=[1e12,1e12]", "duration=1"],  # breaks down before the first row
        ["start.speed_x=[2000,2000]", "duration=1"],  # and after some
    ],
    ids=" ".join,
)
def test_so_does_any_other(overrides, tmp_path):
    log = logged(tmp_path, *overrides)
    assert recorded(log) == load(overrides)
    found = repeat(log)
    assert found.same
    assert found.physics is None
    assert found.differs == {}


def test_other_code_that_gives_the_same_bits_is_named(log, tmp_path, capsys):
    other = changed(log, tmp_path, git_commit=40 * "b", git_dirty=True)
    assert said(capsys, other.path) == (
        0,
        f"{other.path}: same bits: {ROWS} steps, the model, events and outcome\n"
        "                 there                        here\n"
        "  code           bbbbbbbbbbbb with changes    aaaaaaaaaaaa\n",
    )


# ---------------------------------------------------------------- not the same


def test_torques_that_are_a_little_different(log, tmp_path, capsys):
    other = with_row(log, tmp_path, "trajectory/ctrl", 12)
    assert said(capsys, other.path) == (
        1,
        f"{other.path}: same up to t = 0.200 s, step 12 of {ROWS}, then other: trajectory/ctrl\n"
        "  the log's torques, on its model, lead to its states up to step 13\n"
        "  code, versions and C library are the same\n",
    )


def test_what_no_state_follows_from_leaves_physics_in_peace(log, tmp_path, capsys):
    other = with_bit(log, tmp_path, "contacts/force_predicted", 7)
    assert said(capsys, other.path) == (
        1,
        f"{other.path}: same up to t = 0.117 s, step 7 of {ROWS}, then other: "
        "contacts/force_predicted\n"
        "  the log's torques, on its model, lead to all of its states\n"
        "  code, versions and C library are the same\n",
    )


def test_many_datasets_are_counted(log, tmp_path, capsys):
    names = [f"trajectory/{name}" for name in ("qpos", "qvel", "ctrl", "com", "phase")]
    arrays = {name: log[name] + 1.0 for name in names}
    other = changed(log, tmp_path, arrays)
    assert said(capsys, other.path)[1].splitlines()[0] == (
        f"{other.path}: same up to t = 0.000 s, step 0 of {ROWS}, then other: "
        "trajectory/qpos, trajectory/qvel, trajectory/ctrl and 2 more"
    )


@pytest.mark.parametrize("kind", ["push", "wind"])
def test_what_disturbs_a_run_is_repeated_with_it(kind, tmp_path):
    log = logged(tmp_path, f"disturbance={kind}", "duration=1.7")
    assert log["disturbance/wrench"].any()
    assert repeat(log).same
    found = repeat(with_bit(log, tmp_path, "trajectory/phase", 7))
    assert (found.parted, found.physics) == (7, log.steps)


@pytest.mark.parametrize(("name", "value"), [("nan", np.nan), ("minus zero", -0.0)])
def test_bits_are_compared_not_values(name, value, log, tmp_path):
    blend = log["trajectory/blend"].copy()
    blend[3] = value
    found = repeat(changed(log, tmp_path, {"trajectory/blend": blend}))
    assert (found.parted, found.first) == (3, ("trajectory/blend",))


def test_rows_that_are_missing_or_too_many(log, tmp_path, capsys):
    long = changed(log, tmp_path, config=log.config_yaml.replace("duration: 0.5", "duration: 900"))
    first, *_ = said(capsys, long.path)[1].splitlines()
    assert first == (
        f"{long.path}: same up to t = 0.500 s, step {ROWS} of {ROWS}, then it goes on here"
    )
    short = changed(log, tmp_path, config=log.config_yaml.replace("duration: 0.5", "duration: 0.4"))
    first, *_ = said(capsys, short.path)[1].splitlines()
    assert first == f"{short.path}: same up to t = 0.400 s, step 24 of {ROWS}, then it ends here"


def test_a_long_run_is_not_asked_for_by_a_short_log(log, tmp_path):
    steps = []
    long = changed(log, tmp_path, config=log.config_yaml.replace("duration: 0.5", "duration: 3600"))
    repeat(long, lambda: steps.append(1))
    assert len(steps) == ROWS + 1


def test_an_outcome_that_the_rows_do_not_have(log, tmp_path, capsys):
    outcome = json.dumps({**log.outcome, "success": not log.outcome["success"], "more": 1})
    other = changed(log, tmp_path, outcome=outcome)
    assert said(capsys, other.path) == (
        1,
        f"{other.path}: same up to the end, then other: outcome success, outcome more\n"
        "  code, versions and C library are the same\n",
    )


def test_a_time_in_the_outcome_may_be_any(log, tmp_path):
    outcome = json.dumps({**log.outcome, "real_time_factor": 1e-3})
    assert repeat(changed(log, tmp_path, outcome=outcome)).same


def test_a_seed_that_is_not_the_one_of_the_config(log, tmp_path, capsys):
    code, stdout = said(capsys, changed(log, tmp_path, seed=5).path)
    assert code == 1
    assert stdout.splitlines()[0].endswith("then other: seed")


def test_another_model(log, tmp_path, capsys):
    other = changed(log, tmp_path, model_xml=log.model_xml.replace("9.94", "9.95"))
    assert said(capsys, other.path)[1].splitlines()[0] == (
        f"{other.path}: same up to the end, then other: model/mjcf"
    )


def test_versions_and_code_are_named_as_the_reason(log, tmp_path, capsys):
    versions = json.loads(log.attributes["versions"]) | {"mujoco": "3.9.9"}
    blend = log["trajectory/blend"] + 1.0
    other = changed(log, tmp_path, {"trajectory/blend": blend}, versions=json.dumps(versions))
    here = json.loads(log.attributes["versions"])["mujoco"]
    assert said(capsys, other.path) == (
        1,
        f"{other.path}: other code or versions, same up to t = 0.000 s, step 0 of {ROWS}, then "
        "other: trajectory/blend\n"
        "  the log's torques, on its model, lead to all of its states\n"
        "                 there                        here\n"
        f"  mujoco         3.9.9                        {here}\n",
    )


def test_a_c_library_is_named_as_the_reason(log, tmp_path, capsys):
    machine = json.loads(log.attributes["machine"]) | {"libm": "0" * 8}
    blend = log["trajectory/blend"] + 1.0
    other = changed(log, tmp_path, {"trajectory/blend": blend}, machine=json.dumps(machine))
    first, _, _, last = said(capsys, other.path)[1].splitlines()
    assert first.startswith(
        f"{other.path}: a C library that rounds otherwise, same up to t = 0.000"
    )
    assert re.fullmatch(r"  libm           00000000                     [0-9a-f]{8}", last)


def test_changes_nobody_knows_are_named_only_where_bits_differ(log, tmp_path, monkeypatch, capsys):
    dirty = {"git_commit": 40 * "a", "git_dirty": True}
    found = verifying.origin
    monkeypatch.setattr(verifying, "origin", lambda scenario: {**found(scenario), **dirty})
    other = changed(log, tmp_path, **dirty)
    assert said(capsys, other.path)[1].count("\n") == 1
    other = with_row(other, tmp_path, "trajectory/phase", 2)
    assert said(capsys, other.path)[1].splitlines()[-1] == (
        "  code           aaaaaaaaaaaa with changes    aaaaaaaaaaaa with changes"
    )


def test_json(log, tmp_path, capsys):
    other = with_row(log, tmp_path, "trajectory/ctrl", 12)
    code, stdout = said(capsys, other.path, "--json")
    assert (code, stdout.count("\n")) == (1, 1)
    assert json.loads(stdout) == {
        "same": False,
        "steps": ROWS,
        "parted": 12,
        "time": 0.2,
        "first": ["trajectory/ctrl"],
        "whole": [],
        "physics": 13,
        "differs": {},
    }


# ---------------------------------------------------------------- logs that cannot be repeated


@pytest.mark.parametrize(
    ("config", "message"),
    [
        ("seed: 1\n", "behaviour: missing, it cannot be left out"),
        (None, "controller.solver='foo' is unknown; valid: boxqp, osqp, qpsolvers:<name> (for "
         "example qpsolvers:daqp)"),
    ],
)  # fmt: skip
def test_a_config_of_other_code_is_one_line(config, message, log, tmp_path, capsys):
    config = config or log.config_yaml.replace("solver: boxqp", "solver: foo")
    other = changed(log, tmp_path, config=config)
    assert main(["verify", str(other.path)]) == 2
    assert capsys.readouterr() == (
        "",
        f"rotctl: {other.path}: its config makes no run here: {message}\n",
    )


def test_a_damaged_log_is_not_compared(log, tmp_path):
    damaged = tmp_path / "run.h5"
    content = bytearray(log.path.read_bytes())
    place = content.find(log["trajectory/ctrl"][:3].tobytes())
    content[place] ^= 1
    damaged.write_bytes(content)
    with pytest.raises(LogError):
        repeat(RunLog.open(damaged))


# ---------------------------------------------------------------- run --again


def test_a_log_is_run_again(log, tmp_path, capsys):
    assert main(["run", "--again", str(log.path), "--out", str(tmp_path), "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    again = RunLog.open(tmp_path / summary["run_id"] / "run.h5")
    assert again.attributes["run_id"] == log.attributes["run_id"]
    assert again["trajectory/qpos"].tobytes() == log["trajectory/qpos"].tobytes()


def test_again_takes_no_overrides(log, tmp_path, capsys):
    arguments = ["run", "--again", str(log.path), "seed=3", "--out", str(tmp_path)]
    assert main(arguments) == 2
    assert capsys.readouterr().err == (
        "rotctl: --again repeats a run as it was: leave out 'seed=3'\n"
    )
    assert os.listdir(tmp_path) == []


def test_every_choice_comes_back_from_its_log(log, tmp_path):
    for overrides in (["physics=lockstep", "terrain=hazards"], ["behaviour=stairs", "seed=7"]):
        config = replace(load(overrides), duration=0.1)
        assert recorded(logged(tmp_path, *overrides, "duration=0.1")) == config


def test_what_is_refused_of_a_new_run_is_repeated_and_judged_of_an_older_one(
    tmp_path, monkeypatch, capsys
):
    """It was made when nobody asked whether its finish comes before it is over."""
    asked = ["behaviour=forward_roll", "+finish=stand", "duration=0.1"]
    with pytest.raises(InputError, match="it is never told to end"):
        logged(tmp_path, *asked)
    with monkeypatch.context() as patched:
        patched.setattr("rotctl.runs.scenario.require_sense", lambda config, known: None)
        older = logged(tmp_path, *asked)
    assert repeat(older).same
    assert judged_again(older, recorded(older))["behaviour"] == "forward_roll"
    arguments = ["run", "--again", str(older.path), "--out", str(tmp_path / "out")]
    assert (main(arguments), capsys.readouterr().err) == (0, "")


@pytest.mark.parametrize(
    ("overrides", "brings", "key"),
    [
        ("behaviour=forward_roll", {"pace": {"easing": 0.1}}, "behaviour.pace.easing"),
        ("excursion=root", {"correction_time": 0.1}, "excursion.correction_time"),
    ],
)
def test_a_choice_that_brings_other_numbers_by_now_leaves_its_older_logs_in_peace(
    tmp_path, monkeypatch, overrides, brings, key
):
    """Of a new run a number that acts on nothing is refused, unless the choice has it."""
    older = logged(tmp_path, overrides, "duration=0.1")
    monkeypatch.setattr("rotctl.config.sense.brought", lambda group, name: brings)
    with pytest.raises(InputError, match=f"{key}=.*: acts on nothing"):
        build(recorded(older))
    assert repeat(older).same
