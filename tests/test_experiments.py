"""Experiments: every one that we ship can be read and planned."""

import re

import pytest
from here import swept

from rotctl.choices.config_folders import shipped
from rotctl.choices.overrides import parsed
from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.metrics.criteria.kinds import COLUMNS
from rotctl.metrics.measured import SUCCESS_RATE
from rotctl.results.experiments import copies, experiment, matrix, names, read
from rotctl.results.table import TAKEN
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.runs.summary import numbers, summarise
from rotctl.sweep.claimed import require_claims
from rotctl.sweep.plan import planned
from rotctl.sweep.points import points

TABLE_1 = {  # [rev/s], [m/s]
    "forward_roll_1": (1.3, 1.2),
    "forward_roll_2": (0.9, 1.2),
    "forward_roll_3": (1.5, 1.8),
    "backward_roll_1": (1.3, 1.0),
    "backward_roll_2": (1.0, 1.2),
    "sideways_roll": (1.0, 1.5),
    "uneven_terrain": (0.9, 1.1),
    "incline": (1.8, 1.5),
    "decline": (0.4, 1.0),
    "stairs": (0.6, 0.3),
}


@pytest.mark.parametrize("name", names())
def test_each_experiment_plans(name):
    found = list(points(matrix([f"+experiment={name}", "seed=0"])))  # any other differs in it alone
    assert found
    seeds = list(parsed(f"seed={experiment(name).seeds}").value().range())
    assert 0 <= min(seeds) <= max(seeds) < 1_000_000  # judging seeds
    assert len({claim.id for claim in experiment(name).claims}) == len(experiment(name).claims)


@pytest.mark.parametrize("name", names())
def test_claims_are_about_runs_that_are_made_and_quantities_that_are_measured(name):
    found = experiment(name)
    grids = " ".join(override for grid in found.matrix for override in grid)
    for claim in found.claims:
        assert claim.metric in {SUCCESS_RATE, *COLUMNS}
        for key, value in claim.where.items():
            chosen = rf"\+{key.removeprefix('behaviour.')}"  # as +course=circle is
            assert re.search(rf"(\b{key}|{chosen})=\S*(?<![\w.-]){value}\b", grids), claim.id


@pytest.mark.parametrize("name", names())
def test_claims_of_what_we_ship_can_be_tested(name):
    given = [f"+experiment={name}", "seed=0"]
    require_claims(given, planned(points(matrix(given))))


OWN = """
title: Mine
source: me
matrix: [["behaviour=stand,stand_step", "duration=0.3"]]
seeds: range(0,2)
claims:
  - {id: a, metric: METRIC, expected: 1.0, tolerance: 0.5, source: me, where: {WHERE}}
"""


@pytest.mark.parametrize(
    ("metric", "where", "further", "message"),
    [
        ("lean_mots", "", [],
         "metric: no 'lean_mots' is measured, and one of your own has no claims: rotctl judge DIR "
         "--metric tells it; did you mean lean_most? valid: "),
        ("lean_most", "behaviour: stnad", [],
         "where: no run of its grid has behaviour stnad; did you mean stand? valid: "
         "stand, stand_step"),
        ("lean_most", "behaviour: stnad", ["behaviour=stand_step"],
         "where: no run of its grid has behaviour stnad; did you mean stand? valid: "
         "stand, stand_step"),
        ("lean_most", "behavior: stand", [],
         "where: no run of its grid has the key 'behavior'; did you mean behaviour? valid: "),
        ("lean_most", "duration: 0.4", [], "where: no run of its grid has duration 0.4; "),
        ("lean_most", "seed: 2", [], "where: no run of its grid has seed 2; valid: 0, 1"),
        ("lean_most", "behaviour: stand, controller: stepping", [],
         "where: no run of its grid has behaviour stand, controller stepping"),
        ("recovered", "", [], "metric: no run that it is about has a number of 'recovered'; "
         "valid: success_rate, duration, lean_end, lean_most, other_contact, real_time_factor, "),
        ("speed_mean", "behaviour: stand", ["behaviour=stand_step"],
         "metric: no run that it is about has a number of 'speed_mean'; did you mean speed_end? "),
        ("disturbed_at", "", ["disturbance=push", "disturbance.time=0"], ""),
        ("lean_most", "behaviour: stand, duration: 0.3", [], ""),
        ("lean_most", "behaviour: stand, seed: 1", ["behaviour=stand_step"], ""),
    ],
)  # fmt: skip
def test_a_claim_that_nobody_can_test_is_refused_before_the_sweep(
    tmp_path, monkeypatch, capsys, metric, where, further, message
):
    (tmp_path / "experiments").mkdir()
    text = OWN.replace("METRIC", metric).replace("WHERE", where)
    (tmp_path / "experiments" / "mine.yaml").write_text(text)
    monkeypatch.setenv("ROTCTL_CONFIG_DIR", str(tmp_path))
    out = tmp_path / "out"
    code = main(["sweep", "+experiment=mine", *further, "--out", str(out), "--dry-run"])
    error = capsys.readouterr().err
    assert code == (2 if message else 0)
    assert error.startswith(f"rotctl: +experiment=mine: claim a: {message}" if message else "")
    assert error.count("\n") <= 1
    assert not out.exists()


@pytest.mark.parametrize(
    ("grid", "further", "message"),
    [
        ("behaviour=stnad", [], '+experiment=mine: behaviour="stnad": no such'),
        ("behaviour=stnad", ["seed=3"], '+experiment=mine: behaviour="stnad": no such'),
        ("duration=range(0,", [], "+experiment=mine: override 'duration=range(0,': cannot"),
        ("duration=0.3", ["behaviour=stnad"], 'behaviour="stnad": no such'),
    ],
)
def test_what_is_wrong_with_an_experiments_grid_names_it(
    tmp_path, monkeypatch, capsys, grid, further, message
):
    (tmp_path / "experiments").mkdir()
    text = OWN.replace("behaviour=stand,stand_step", grid).replace(', "duration=0.3"', "")
    text = text.replace("METRIC", "lean_most").replace("WHERE", "")
    (tmp_path / "experiments" / "mine.yaml").write_text(text)
    monkeypatch.setenv("ROTCTL_CONFIG_DIR", str(tmp_path))
    out = tmp_path / "out"
    assert main(["sweep", "+experiment=mine", *further, "--out", str(out), "--dry-run"]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"rotctl: {message}")
    assert error.count("\n") == 1


@pytest.mark.parametrize(
    "overrides",
    [
        ["behaviour=forward_roll_1"],
        ["behaviour=forward_roll_2", "disturbance=push", "disturbance.time=0.1"],
        ["behaviour=forward_roll", "+finish=stand", "behaviour.finish.after=0.3"],
        ["behaviour=forward_roll", "behaviour.pace.schedule=[[0.0,0.9],[0.3,0.0]]"],
        ["behaviour=stand", "disturbance=slippery", "disturbance.time=0.1"],
        ["behaviour=back_flip"],
        ["behaviour=dive_forward"],
        ["behaviour=kick_up"],
        ["behaviour=get_up"],
        ["behaviour=pirouette_one_foot"],
        ["behaviour=turn_over"],
        ["behaviour=chain", "behaviour.parts=[back_flip,front_flip]"],
    ],
)
def test_what_a_run_may_have_a_number_of_is_known_before_it(overrides):
    config = load([*overrides, "duration=0.5"])
    scenario = build(config)
    row = summarise(scenario, in_memory(scenario)[0], "", 1.0)
    measured = {name for name, value in row.items() if name not in TAKEN}
    has = {name for name in measured if isinstance(row[name], int | float)}
    assert has <= numbers(config)
    assert numbers(config) <= measured


def test_a_deviation_of_no_run_is_refused_as_well(tmp_path, monkeypatch, capsys):
    (tmp_path / "experiments").mkdir()
    text = OWN.replace("METRIC", "lean_most").replace("WHERE", "")
    deviations = "deviations: [{text: x}, {text: y, where: {behaviour: stnad}}]"
    (tmp_path / "experiments" / "mine.yaml").write_text(text + deviations)
    monkeypatch.setenv("ROTCTL_CONFIG_DIR", str(tmp_path))
    assert main(["sweep", "+experiment=mine", "--out", str(tmp_path / "out"), "--dry-run"]) == 2
    said = "rotctl: +experiment=mine: deviations.1: where: no run of its grid has behaviour stnad; "
    assert capsys.readouterr().err.startswith(said)


def test_table_1_has_the_velocities_of_the_paper():
    found = experiment("table1")
    expected = {claim.id: claim.expected for claim in found.claims}
    for row, (spin, speed) in TABLE_1.items():
        assert expected[f"{row}.success"] >= 0.9
        assert (expected[f"{row}.angular_velocity"], expected[f"{row}.speed"]) == (spin, speed)
    assert len(found.claims) == 3 * len(TABLE_1) == 30
    for claim in found.claims:
        if claim.metric != SUCCESS_RATE:
            assert claim.tolerance == pytest.approx(0.15 * claim.expected)


def test_table_1_is_of_one_set_of_gains_and_never_uses_the_head():
    """As the paper's ten rolls."""
    overrides = [row for grid in experiment("table1").matrix for row in grid]
    configs = [load([one]) for one in overrides]
    assert len(configs) == 10
    assert all(config.controller == configs[0].controller for config in configs)
    assert {config.character.exclude_from_control for config in configs} == {("head",)}


def test_a_behaviour_that_is_not_there_is_one_line(tmp_path, monkeypatch, capsys):
    text = (shipped("experiments") / "forward_roll_1.yaml").read_text()
    (tmp_path / "experiments").mkdir()
    file = tmp_path / "experiments" / "wrong.yaml"
    file.write_text(text.replace("forward_roll_1,", "nobody,"))
    monkeypatch.setenv("ROTCTL_CONFIG_DIR", str(tmp_path))
    assert main(["sweep", "+experiment=wrong", "--out", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert error.startswith(
        'rotctl: +experiment=wrong: behaviour="nobody": no such choice; valid: '
    )
    assert error.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_sweep_leaves_a_copy_of_its_experiment(tmp_path):
    one = ("behaviour=forward_roll_1", "seed=0", "duration=0.5")
    swept(tmp_path, "+experiment=forward_roll_1", *one)
    (copy,) = copies(tmp_path).items()
    assert copy == ("forward_roll_1", tmp_path / "experiment-forward_roll_1.yaml")
    assert read(copy[1]) == experiment("forward_roll_1")


def test_a_huge_or_foreign_copy_is_one_line(tmp_path):
    path = tmp_path / "experiment-x.yaml"
    for text, message in (
        ("x" * 2_000_001, f"{path}: larger than 2 MB"),
        ("[" * 100_000, f"{path}:1: nested more than 12 deep"),
        ("!!python/object/apply:os.system [x]", f"{path}:1: has a tag; write plain values"),
    ):
        path.write_text(text)
        with pytest.raises(InputError) as error:
            read(path)
        assert str(error.value) == message


def test_forward_roll_1_is_fifty_starts_of_both():
    found = list(points(matrix(["+experiment=forward_roll_1", "duration=1"])))
    assert len(found) == 100
    assert {point.config.behaviour.name for point in found} == {
        "forward_roll_1",
        "forward_roll_1_phase",
    }
    assert {point.config.duration for point in found} == {1.0}
    assert {claim.metric for claim in experiment("forward_roll_1").claims} == {"success_rate"}


def test_further_overrides_replace_its_own():
    assert matrix(["+experiment=forward_roll_1", "seed=7"]) == [
        ["behaviour=forward_roll_1,forward_roll_1_phase", "seed=7"]
    ]


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (["+experiment="], "+experiment=: no such experiment; valid: " + ", ".join(names())),
        (["+experiment=no"], "+experiment=no: no such experiment; valid: " + ", ".join(names())),
        (
            ["+experiment=forward_roll_1", "+experiment=b"],
            "+experiment=b: one experiment a sweep",
        ),
    ],
)
def test_what_is_wrong_is_said(overrides, message):
    with pytest.raises(InputError) as error:
        matrix(overrides)
    assert str(error.value).startswith(message)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("title: x", ": source: missing, it cannot be left out"),
        ("{title: x, source: y, matrix: [], seeds: '1', claims: [], tittle: z}",
         ": unknown key 'tittle'; did you mean title? valid keys: "
         "title, source, matrix, seeds, claims, deviations, limitations"),
        ("{title: [1", ":2: is no YAML: while parsing a flow sequence, did not find expected ',' "
         "or ']'"),
        ("- 1", ": must be keys with values: title, source, matrix, seeds, claims, deviations, "
         "limitations"),
        ("{title: x, source: y, matrix: [], seeds: 1.5, claims: []}",
         ": seeds=1.5: must be one seed, or several as in range(0,100) or 2000,2001"),
        ("{title: x, source: y, matrix: [], seeds: all, claims: []}",
         ': seeds="all": must be one seed, or several as in range(0,100) or 2000,2001'),
        ("{title: x, source: y, matrix: [], seeds: [1, 2], claims: []}",
         ": seeds: must be one seed, or several as in range(0,100) or 2000,2001"),
        ("{title: x, source: y, matrix: [], seeds: '1', claims: [{id: '', metric: jerk, "
         "expected: 1, tolerance: 0, source: y}]}",
         ': claims.0.id="": reports go by it: must be printable, on one line and not empty'),
    ],
)  # fmt: skip
def test_a_wrong_file_is_one_line(tmp_path, monkeypatch, text, message):
    (tmp_path / "experiments").mkdir()
    file = tmp_path / "experiments" / "wrong.yaml"
    file.write_text(text)
    monkeypatch.setenv("ROTCTL_CONFIG_DIR", str(tmp_path))
    with pytest.raises(InputError) as error:
        experiment("wrong")
    assert str(error.value) == f"{file}{message}"


def test_one_seed_needs_no_quotes(tmp_path, monkeypatch):
    (tmp_path / "experiments").mkdir()
    text = "{title: x, source: y, matrix: [[duration=1]], seeds: 2000, claims: []}"
    (tmp_path / "experiments" / "one.yaml").write_text(text)
    monkeypatch.setenv("ROTCTL_CONFIG_DIR", str(tmp_path))
    assert experiment("one").grids([]) == [["duration=1", "seed=2000"]]
