"""Experiments: every one that we ship can be read and planned."""

import pytest

from rotctl.errors import InputError
from rotctl.results.experiments import experiment, matrix, names
from rotctl.sweep.points import points


@pytest.mark.parametrize("name", names())
def test_each_experiment_plans(name):
    found = list(points(matrix([f"+experiment={name}"])))
    seeds = {point.config.seed for point in found}
    assert seeds
    assert max(seeds) < 1_000_000  # judging seeds
    assert len({claim.id for claim in experiment(name).claims}) == len(experiment(name).claims)


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
        (["+experiment=no"], "+experiment=no: no such experiment; valid: forward_roll_1"),
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
        ("title: x", "source: Field required"),
        ("{title: x, source: y, matrix: [], seeds: '1', claims: [], tittle: z}", "tittle: "),
        ("{title: [", "is not YAML: "),
        ("- 1", ": "),
    ],
)
def test_a_wrong_file_is_one_line(tmp_path, monkeypatch, text, message):
    (tmp_path / "wrong.yaml").write_text(text)
    monkeypatch.setattr("rotctl.results.experiments.shipped", lambda name: tmp_path)
    with pytest.raises(InputError) as error:
        experiment("wrong")
    assert str(error.value).startswith(f"{tmp_path / 'wrong.yaml'}: ")
    assert message in str(error.value)
    assert "\n" not in str(error.value)
