"""Hydra's sweep syntax: the same points, and the same configs, as Hydra would make."""

from importlib import import_module

import pytest

from rotctl.choices.listing import choices
from rotctl.config import loading
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.sweep.assignments import quickly
from rotctl.sweep.points import points
from rotctl.sweep.values import values


def overrides(*grid):
    return [point.overrides for point in points([grid])]


@pytest.mark.parametrize(
    ("grid", "expected"),
    [
        ((), [()]),
        (("seed=3",), [("seed=3",)]),
        (("seed=1,2",), [("seed=1",), ("seed=2",)]),
        (("seed=range(0,3)",), [("seed=0",), ("seed=1",), ("seed=2",)]),
        (("seed=range(8,2,-3)",), [("seed=8",), ("seed=5",)]),
        (("duration=range(1,2,0.5)",), [("duration=1.0",), ("duration=1.5",)]),
        (("seed=choice(4,2)",), [("seed=4",), ("seed=2",)]),
        (("seed=sort(3,1,2)",), [("seed=1",), ("seed=2",), ("seed=3",)]),
        (
            ("start=rest,tucked", "seed=1,2"),
            [
                ("start=rest", "seed=1"),
                ("start=rest", "seed=2"),
                ("start=tucked", "seed=1"),
                ("start=tucked", "seed=2"),
            ],
        ),
        (("start=glob(re*)",), [("start=rest",)]),
        (
            ("start.speed_x=[0,1],[1,2]",),
            [("start.speed_x=[0,1]",), ("start.speed_x=[1,2]",)],
        ),
    ],
)
def test_the_last_key_varies_fastest(grid, expected):
    assert overrides(*grid) == expected


def test_a_shuffled_value_is_what_its_text_says():
    found = values("seed=shuffle(range(0,40))")
    assert sorted(one.value for one in found) == list(range(40))
    assert [one.text for one in found] == [f"seed={one.value}" for one in found]


def test_glob_is_over_the_choices_of_a_group():
    found = overrides("behaviour=glob(*,exclude=*_phase)")
    wanted = [name for name in choices("behaviour") if not name.endswith("_phase")]
    assert found == [(f"behaviour={name}",) for name in wanted]


def test_grids_follow_each_other():
    found = [point.overrides for point in points([["seed=1,2"], ["start=rest"]])]
    assert found == [("seed=1",), ("seed=2",), ("start=rest",)]


@pytest.mark.parametrize(
    "grid",
    [
        ["behaviour=forward_roll_1,forward_roll_1_phase", "seed=range(0,2)", "duration=1,2.5"],
        ["controller.pose.weight=2,4.5", "seed=1", "start=rest"],
        ["seed=1,2", "seed=5"],  # the later one wins, as in Hydra
        ["start.speed_x=[0,1],[1,2]", "terrain.name='a, b'"],
        ["start.speed_x=[0,1],[1,2]", "start=rest,tucked"],
        ["+start.speed_x=[0,1],[1,2]"],
        ["behaviour.poses.a={knee: 1.0},{knee: 2.0}", "behaviour.poses.a.hip_y=0.5"],
        ["~behaviour.description", "seed=1,2"],
        ["behaviour=forward_roll_2,stairs", "behaviour.catch.gain=1,2", "behaviour.catch=null"],
        ["++duration=1,2"],
        ["seed=1,2", "+course=circle,slalom", "behaviour.course.pull=10", "behaviour=forward_roll"],
        ["+course=glob(*)", "behaviour=forward_roll"],
        ["physics.substeps=4,8", "controller.solver=boxqp,osqp", "controller.form=condensed"],
    ],
)
def test_each_config_is_the_one_that_hydra_composes(grid):
    found = list(points([grid]))
    for point in (found[0], found[-1]):
        assert point.config == load(list(point.overrides))


def test_what_is_added_has_its_value_where_the_config_has_it():
    grid = ["behaviour=forward_roll", "+finish=stand,seat", "+course=circle"]
    found = [point.values for point in points([grid])]
    assert [values["behaviour.finish"] for values in found] == ["stand", "squat, stand"]
    assert {values["behaviour.course"] for values in found} == {"circle"}


def test_the_values_are_those_of_the_config():
    (point,) = points([["behaviour=forward_roll_1", "duration=2", "start.speed_x=[0,1]"]])
    assert point.values == {
        "behaviour": "forward_roll_1",
        "duration": 2.0,
        "start.speed_x": (0.0, 1.0),
    }


@pytest.mark.parametrize(
    ("grid", "message"),
    [
        (["seed=range(-1,2)"], "seed=-1: must be greater than or equal to 0"),
        (["seed=1,x"], 'seed="x": must be a valid integer'),
        (["sed=1,2"], "unknown key 'sed'; did you mean seed? valid keys: "),
        (["duration.x=1,2"], "unknown key 'duration.x'; valid keys under duration: none, it is "),
        (["start=rest,ret"], 'start="ret": no such choice; did you mean rest? valid: '),
        (["+start=rest,tucked"], "start is there already; write start=VALUE"),
        (["course=circle,turn"], "course is no part of a config, its choices are added to one: "),
        (["+course=circle,tur"], 'course="tur": no such choice; did you mean turn? valid: '),
        (["start=glob(x*)"], "start=glob(x*): no choice matches; valid: "),
        (["seed=glob(*)"], "seed=glob(*): no such group"),
        (["seed=interval(0,1)"], "seed=interval(0,1): has no steps; write seed=range(start,stop"),
        (["seed=range(3,3)"], "seed=range(3,3): has no values"),
        *(
            ([f"seed={endless}"], f"seed={endless}: cannot be counted through; write seed=range(st")
            for endless in ("range(0,3,0)", "range(0,1,0.0)", "range(nan)", "range(0,3,nan)")
        ),
        *(
            ([f"start={mixed}"], f"override 'start={mixed}': choice(...), range(...), ")
            for mixed in ("range(0,3),7", "interval(0,1),2", "rest,glob(*)", "[range(0,3)]")
        ),
        (["seed=shuffle(range(0,1e12))"], "the sweep has more than 100000 points; make several"),
        (
            ["seed=range(0,1000)", "duration=range(1,1000)"],
            "the sweep has more than 100000 points; make several",
        ),
        (["seed=range(0,1000000000)"], "the sweep has more than 100000 points; make several"),
        (["hydra.run.dir=a,b"], "override 'hydra.run.dir=a,b': Hydra's own settings cannot be"),
        (["seed"], "override 'seed' has no '='; write key=value, such as seed=3"),
        (["seed=${x},2"], "override 'seed=${x},2': interpolations and _target_ are not honoured"),
    ],
)
def test_what_is_wrong_is_said_before_anything_runs(grid, message):
    with pytest.raises(InputError) as error:
        list(points([grid]))
    assert str(error.value).startswith(message)
    assert "\n" not in str(error.value)


def test_what_does_not_change_is_composed_and_checked_once(monkeypatch):
    """Of 3000 points only what is set is checked, each value once: hours of planning otherwise."""
    module, loaded = import_module("rotctl.sweep.points"), []
    monkeypatch.setattr(module, "load", lambda o: loaded.append(o) or loading.load(o))
    grid = ["start=rest,tucked", "controller.pose.weight=1,2,3", "seed=range(0,500)"]
    found = list(points([grid]))
    assert len(found) == 3000
    assert loaded == [["start=rest"], ["start=tucked"]]
    assert len({id(point.config.controller) for point in found}) == 6
    assert len({id(point.config.character) for point in found}) <= 2


@pytest.mark.parametrize("added", ["+course=circle,turn", "+course=choice(circle,turn)"])
def test_what_is_added_is_composed_once(monkeypatch, added):
    module, loaded = import_module("rotctl.sweep.points"), []
    monkeypatch.setattr(module, "load", lambda o: loaded.append(o) or loading.load(o))
    assert len(list(points([["behaviour=forward_roll", added, "seed=range(0,50)"]]))) == 100
    assert loaded == [["behaviour=forward_roll", f"+course={name}"] for name in ("circle", "turn")]


@pytest.mark.parametrize("out", ["~behaviour.catch", "behaviour.catch=null"])
def test_what_is_left_out_is_composed_once_for_all_that_is_elsewhere(monkeypatch, out):
    module, loaded = import_module("rotctl.sweep.points"), []
    monkeypatch.setattr(module, "load", lambda o: loaded.append(o) or loading.load(o))
    grid = ["behaviour=forward_roll_2", out, "behaviour.heading=0,10", "seed=1,2"]
    found = list(points([grid]))
    for_both = [[*grid[:2], f"behaviour.heading={value}"] for value in (0, 10)]
    assert [texts for texts in loaded if len(texts) > 1] == for_both
    for point in found:
        assert point.config == loading.load(list(point.overrides))
        assert point.config.behaviour.catch is None


@pytest.mark.parametrize("bad", ["seed=-1", "controller.pose.weight=-2", "terrain.name=''"])
def test_a_value_that_is_wrong_is_told_as_for_a_single_run(bad):
    with pytest.raises(InputError) as alone:
        load([bad])
    with pytest.raises(InputError) as among:
        list(points([["start=rest,tucked", bad]]))
    assert str(among.value) == str(alone.value)


@pytest.mark.parametrize(
    "override",
    ["seed=3", "seed=1,2,10", "seed=range(0,5)", "seed=range(-2,1)", "duration=0.50,1.0,2.5",
     "start=rest,tucked", "behaviour=stand", "behaviour.roll_about=left,right",
     "+course=circle,turn", "+finish=stand"],
)  # fmt: skip
def test_what_needs_no_hydra_is_what_hydra_makes_of_it(override):
    assert quickly(override) == values(override)


@pytest.mark.parametrize(
    "override",
    ["seed=range(5,0)", "seed=range(0,9,2)", "seed=range(0,1000000)", "start=no", "start=glob(*)",
     "+course=no", "seed=1,", "a=x y",
     "+a=1", "a='x,y'", "a=[1,2]", "a=choice(1,2)", "seed", "seed=1 ,2"],
)  # fmt: skip
def test_all_other_syntax_is_left_to_hydra(override):
    assert quickly(override) is None
