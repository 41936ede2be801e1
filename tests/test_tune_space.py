"""Space files: what they may say, and the one line for what they may not."""

import copy
import os

import pytest
import yaml

from rotctl.choices.config_folders import conf_dir
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.metrics.expressions.expression import NAMES
from rotctl.settings.writing import to_dict
from rotctl.tune.objective import ROLLING
from rotctl.tune.space import TRAINING_SEEDS, load_space, names
from rotctl.tune.values import (
    configs,
    final_seeds,
    get,
    put,
    start_values,
    training_seeds,
    variations,
)

GAINS = conf_dir() / "tune" / "rolling_gains.yaml"
DRAWN = "tune draws the seeds of its runs itself, from 1,000,000 on; those below are for judging"


@pytest.fixture
def complaint(tmp_path):
    """Changes a good space file, and returns what is said of it."""

    def say(change):
        data = copy.deepcopy(yaml.safe_load(GAINS.read_text()))
        change(data)
        path = tmp_path / "x.yaml"
        path.write_text(yaml.safe_dump(data))
        with pytest.raises(InputError) as caught:
            load_space(str(path))
        assert caught.value.exit_code == 2
        return str(caught.value).removeprefix(f"{path}: ")

    return say


@pytest.mark.parametrize("name", names())
def test_a_shipped_space_fits_its_config_and_gives_its_reasons(name):
    space = load_space(name)
    assert space.name == name
    assert list(start_values(space, variations(space, [])[0])) == [p.key for p in space.parameters]
    assert all(parameter.unit for parameter in space.parameters)


@pytest.mark.parametrize(
    ("where", "value", "said"),
    [
        (
            ["foo"],
            1,
            "unknown key 'foo'; valid keys: name, title, base, parameters, runs, objective, "
            "stopping, sampler, trials, description",
        ),
        (
            ["parameters", 1, "hi"],
            1,
            "unknown key 'parameters.1.hi'; did you mean high? "
            "valid keys under parameters.1: key, low, high, unit, "
            "scale, start, reason",
        ),
        (["parameters", 1, "high"], 100.0, "parameters.1: low=200 must be below high=100"),
        (["parameters", 1, "low"], -1.0, "parameters.1: low=-1 must be above 0 on a log scale"),
        (["parameters", 1, "low"], "1", 'parameters.1.low="1": must be a valid number'),
        (
            ["parameters", 1, "start"],
            1e6,
            "parameters.1: start=1e+06 must be within its range, 200 to 2000",
        ),
        (
            ["runs", "variations"],
            [[], ["controller.pose.stiffness=900"]],
            "runs.variations.1: controller.pose.stiffness=900: acts on nothing, as that is "
            "searched and a candidate has its own value",
        ),
        (["parameters", 1, "scale"], "x", "parameters.1.scale=\"x\": must be 'linear' or 'log'"),
        (
            ["parameters", 1, "key"],
            "seed",
            "parameters.1: key must be dotted names, as in controller.tasks.linear.damping.0",
        ),
        (
            ["parameters", 1, "key"],
            "criteria.heading",
            "parameters.1.key=criteria.heading: criteria judge what a search finds",
        ),
        (
            ["parameters", 0, "key"],
            "controller.pose.weight",
            "parameters name controller.pose.weight twice",
        ),
        (["parameters"], [], "parameters=[]: too few values, at least 2"),
        (
            ["parameters", 0, "key"],
            "controller.x" + "{a,b}" * 40,
            "parameters: too many values, at most 1000",
        ),
        (
            ["parameters", 0, "key"],
            "controller.tasks.{a",
            "parameters.0: key must be dotted names, as in controller.tasks.linear.damping.0",
        ),
        (
            ["objective", "columns"],
            {"head_share": {"weight": 1.0, "miss": 0.1}},
            "objective.columns.head_share: give low, high or both",
        ),
        (
            ["objective", "columns"],
            {"head": {"weight": 1.0, "miss": 0.1, "high": 0.1}},
            f"objective: a roll has no column 'head'; it has: {', '.join(ROLLING)}",
        ),
        (
            ["objective", "metrics"],
            {"top": "max(kom)"},
            "objective: metric top: no array 'kom' in a log; did you mean com? valid: "
            f"{', '.join([*NAMES, 'period', 'pi'])}",
        ),
        (
            ["objective", "metrics"],
            {"jerk": "1"},
            "objective: metric jerk: there is a column of that name already",
        ),
        (
            ["objective", "columns"],
            {"head_share": {"weight": 1.0, "low": 0.5, "high": 0.1, "miss": 0.1}},
            "objective.columns.head_share: low=0.5 must not exceed high=0.1",
        ),
        (
            ["objective", "metrics"],
            {"top": "max(com[:, 2])"},
            "objective: metric top: acts on nothing, no column of that name is wished for",
        ),
        (
            ["objective"],
            {"over_runs": "mean", "pace": 0.6}
            | dict.fromkeys(("survival", "progress", "drift", "heading"), 0.0),
            "objective: all weights are 0, so that no run is better than another",
        ),
        (["runs"], None, "runs=null: must be keys with values"),
        (
            ["runs"],
            {"seeds": 2, "duration": 3.0, "final": 9, "variations": [[], [], ["seed_=3"]]},
            "runs.variations: 3 of them, and with seeds=2 the last never come",
        ),
        (
            ["runs", "first_seed"],
            999_999,
            "runs.first_seed=999999: training seeds start at 1,000,000; "
            "those below are for judging",
        ),
        (["runs", "variations"], [["seed=3"]], f"runs.variations.0: seed=3: {DRAWN}"),
        (["base"], ["+seed={x}"], f"base: +seed={{x}}: {DRAWN}"),
        (["sampler", "name"], "random", "sampler.name=\"random\": must be 'cmaes' or 'tpe'"),
        (["name"], "a b", 'name="a b": must be letters, digits and _, a letter first'),
    ],
)
def test_one_line_for_a_bad_value(complaint, where, value, said):
    def change(data):
        *owners, last = where
        for owner in owners:
            data = data[owner]
        data[last] = value

    assert complaint(change) == said


def test_one_line_for_what_is_missing_or_no_space(complaint, tmp_path):
    assert complaint(lambda data: data.pop("runs")) == "runs: missing, it cannot be left out"
    with pytest.raises(InputError, match="^nope: no such space; valid: ablation, clip, clip_one_s"):
        load_space("nope")
    with pytest.raises(InputError, match="none.yaml: no such file$"):
        load_space(str(tmp_path / "none.yaml"))
    (tmp_path / "torn.yaml").write_text("a: [")
    with pytest.raises(InputError, match="torn.yaml:2: is no YAML: while parsing"):
        load_space(str(tmp_path / "torn.yaml"))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("name: 2026-13-45", ': name="2026-13-45": must be letters, digits and _, a letter first'),
        ("trials: " + "9" * 5000, ":1: a number has more than 40 digits"),
        ("a: " + "[" * 3000, ":1: nested more than 12 deep"),
        ("a: " + "[" * 1200 + "]" * 1200, ":1: nested more than 12 deep"),
        ("#" * 2_000_001, ": larger than 2 MB"),
        (
            "canary: [unclosed",
            ":2: is no YAML: while parsing a flow sequence, did not find expected ",
        ),
        ("", ": must be keys with values: name, title, "),
    ],
)
def test_a_strangers_space_is_one_line(tmp_path, text, said):
    path = tmp_path / "x.yaml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        load_space(str(path))
    assert str(caught.value).startswith(f"{path}{said}")
    assert "\n" not in str(caught.value)
    assert "canary" not in str(caught.value)


def test_a_pipe_in_the_place_of_a_space_does_not_hang(tmp_path):
    os.mkfifo(tmp_path / "x.yaml")
    with pytest.raises(InputError) as caught:
        load_space(str(tmp_path / "x.yaml"))
    assert str(caught.value) == f"{tmp_path / 'x.yaml'}: is no plain file"


def test_braces_stand_for_several_keys(tmp_path):
    data = yaml.safe_load(GAINS.read_text())
    data["parameters"] = [
        {"key": "a.{b, c}.{0,1}", "low": 0.0, "high": 1.0, "unit": "rad", "reason": "why"},
        {"key": "a.d", "low": 0.0, "high": 2.0, "unit": "s"},
    ]
    (tmp_path / "x.yaml").write_text(yaml.safe_dump(data))
    found = load_space(str(tmp_path / "x.yaml")).parameters
    assert [p.key for p in found] == ["a.b.0", "a.b.1", "a.c.0", "a.c.1", "a.d"]
    assert {(p.high, p.unit, p.reason) for p in found[:4]} == {(1.0, "rad", "why")}


def test_a_number_that_the_config_lacks_begins_at_its_start(tmp_path):
    data = yaml.safe_load((conf_dir() / "tune" / "clip.yaml").read_text())
    (tmp_path / "x.yaml").write_text(yaml.safe_dump(data))
    space = load_space(str(tmp_path / "x.yaml"))
    given = "+behaviour.reference.offsets={knee: [0.2, 0.1], waist_x: [0.3]}"
    (found,) = {str(v["behaviour"]["reference"]["offsets"]) for v in variations(space, [given])}
    offsets = yaml.safe_load(found)
    assert offsets["knee"] == [0.2, 0.1, 0.0, 0.0, 0.0]
    assert offsets["waist_x"] == [0.3]
    assert offsets["hip_x"] == [0.0]
    data["parameters"][0] = {
        "key": "controller.rate.x",
        "low": -1.0,
        "high": 1.0,
        "unit": "-",
        "start": 0,
    }
    (tmp_path / "x.yaml").write_text(yaml.safe_dump(data))
    space = load_space(str(tmp_path / "x.yaml"))
    with pytest.raises(InputError, match='^controller.rate={"x": -1.0}: must be a'):
        start_values(space, variations(space, [])[0])


def test_numbers_go_in_and_out_by_key_and_the_rest_stays():
    data = to_dict(load(["controller=rolling"]))
    assert get(data, "controller.tasks.linear.damping.0") == 3.62
    changed = put(data, {"controller.tasks.linear.damping.0": 5.0, "behaviour.speed": 2.0})
    assert list(changed["controller"]["tasks"]["linear"]["damping"]) == [5.0, 8.59, 7.8]
    assert changed["behaviour"]["speed"] == 2.0
    assert data == to_dict(load(["controller=rolling"]))
    assert (
        put(changed, {key: get(data, key) for key in ("behaviour.speed",)})["start"]
        == (data["start"])
    )


@pytest.mark.parametrize(
    ("key", "said"),
    [
        ("controller.pose.weigh", "not in the config; valid under controller.pose: stiffness, "),
        ("controller.tasks.linear.damping.3", "not in the config; valid under controller.tasks.l"),
        ("controller.tasks.linear.damping", "is a list of 3, no single number"),
        ("controller.solver", "is the value 'boxqp', no single number"),
    ],
)
def test_a_key_that_is_no_number_is_refused(key, said):
    with pytest.raises(InputError) as caught:
        get(to_dict(load([])), key)
    assert str(caught.value).startswith(f"parameter {key}: {said}")


def test_a_start_outside_its_range_and_a_range_outside_the_config_are_refused(tmp_path):
    text = GAINS.read_text()
    path = tmp_path / "x.yaml"
    path.write_text(text.replace("low: 200.0", "low: 1000.0"))
    space = load_space(str(path))
    with pytest.raises(InputError, match="starts at 900 1/s2, outside its range 1000 to 2000$"):
        start_values(space, variations(space, [])[0])
    path.write_text(text.replace("low: 0.5, high: 20.0, scale: log", "low: -0.5, high: 20.0"))
    space = load_space(str(path))
    with pytest.raises(InputError, match=r"^controller\.tasks\.spin\.weight\.1=-0\.5: must be"):
        start_values(space, variations(space, [])[0])


def test_no_override_and_no_seed_below_a_million_gets_through():
    space = load_space("rolling_gains")
    with pytest.raises(InputError, match=f"^seed=7: {DRAWN}$"):
        variations(space, ["seed=7"])
    data = variations(space, [])
    with pytest.raises(InputError, match="^seed=999999: training seeds start at 1,000,000$"):
        configs(data, {}, [TRAINING_SEEDS, TRAINING_SEEDS - 1])


def test_every_generation_and_every_search_has_seeds_of_its_own():
    space = load_space("rolling_gains")
    blocks = [training_seeds(space, seed, g) for seed in (0, 1) for g in (0, 1, 2)]
    blocks += [final_seeds(space, seed) for seed in (0, 1)]
    seeds = [seed for block in blocks for seed in block]
    assert len(set(seeds)) == len(seeds)
    assert min(seeds) == TRAINING_SEEDS


def test_runs_go_through_the_variations_again_and_again():
    space = load_space("clip")
    data = variations(space, ["controller.friction=0.7"])
    made = configs(data, {"behaviour.speed": 1.5}, range(TRAINING_SEEDS, TRAINING_SEEDS + 10))
    assert [c.physics.substeps for c in made] == [4, 2, 4, 4, 4] * 2
    assert [c.terrain.friction for c in made] == [1.0, 1.0, 1.0, 0.8, 1.0] * 2
    assert [c.seed for c in made] == list(range(TRAINING_SEEDS, TRAINING_SEEDS + 10))
    assert {(c.controller.friction, c.behaviour.speed, c.duration) for c in made} == {
        (0.7, 1.5, 12.0)
    }
