"""Proposals: pure functions of the finished generations and the seed."""

import sys
from dataclasses import replace

import numpy as np
import pytest

from rotctl.errors import InputError
from rotctl.tune.sampler import centre, need_extra, propose
from rotctl.tune.space import Parameter, load_space

GOAL = {"a.linear": 1.5, "a.log": 30.0}
START = {"a.linear": -0.5, "a.log": 2.0}


def make_space(sampler="cmaes"):
    space = load_space("rolling_gains")
    return replace(
        space,
        parameters=[
            Parameter("a.linear", -1.0, 2.0, "m"),
            Parameter("a.log", 1.0, 100.0, "1/s", scale="log"),
        ],
        sampler=replace(space.sampler, name=sampler),
    )


def worth(values):
    return -((values["a.linear"] - GOAL["a.linear"]) ** 2) - np.log(values["a.log"] / 30.0) ** 2


def searched(space, generations, seed=0):
    told = []
    for _ in range(generations):
        told.append([(values, worth(values)) for values in propose(space, START, told, seed)])
    return told


@pytest.mark.parametrize("sampler", ["cmaes", "tpe"])
def test_proposals_are_in_range_and_depend_on_seed_and_history_alone(sampler):
    space = make_space(sampler)
    told = searched(space, 3)
    assert searched(space, 3) == told
    assert propose(space, START, told, 0) == propose(space, START, told, 0)
    assert propose(space, START, told, 0) != propose(space, START, told, 1)
    assert propose(space, START, told, 0) != propose(space, START, told[:2], 0)
    for generation in told:
        assert len(generation) == space.sampler.population
        for values, _ in generation:
            assert -1.0 <= values["a.linear"] <= 2.0
            assert 1.0 <= values["a.log"] <= 100.0


@pytest.mark.parametrize(("sampler", "least"), [("cmaes", -0.01), ("tpe", -0.3)])
def test_the_search_finds_the_top_of_a_hill(sampler, least):
    told = searched(make_space(sampler), 20)
    assert max(score for _, score in told[0]) < -0.3
    assert max(score for generation in told for _, score in generation) > least


def test_the_centre_begins_at_the_start_and_goes_where_the_search_goes():
    space = make_space()
    assert centre(space, START, []) == pytest.approx(START)
    assert centre(space, START, searched(space, 25)) == pytest.approx(GOAL, rel=0.02)
    assert centre(make_space("tpe"), START, []) is None


def test_a_start_on_the_edge_of_its_range_is_fine():
    space = make_space()
    edge = {"a.linear": 2.0, "a.log": 1.0}
    assert centre(space, edge, []) == pytest.approx(edge)
    assert len(propose(space, edge, [], 0)) == space.sampler.population


@pytest.mark.parametrize("package", ["optuna", "cmaes"])
def test_without_the_extra_one_line_says_how_to_get_it(package, monkeypatch):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(InputError, match=r"not installed: pip install 'rotctl\[tune\]'$"):
        need_extra()
