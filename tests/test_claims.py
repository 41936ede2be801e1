"""Verdicts: what counts as reproduced, and what keeps a claim from it."""

import pandas as pd
import pytest
from pydantic import ValidationError

from rotctl.metrics.claims import (
    NOT_REPRODUCED,
    NOT_TESTED,
    PARTLY,
    REPRODUCED,
    Claim,
    judge,
    overall,
)
from rotctl.metrics.measured import picked


def claim(metric="success_rate", expected=0.9, tolerance=0.0, comparison="at_least", **where):
    return Claim("c", metric, expected, tolerance, "paper", comparison, where=where)


def runs(successes, **columns):
    """A table with a row a run; None has no result."""
    table = {"success": successes, "seed": range(len(successes)), "behaviour": "roll", **columns}
    return pd.DataFrame(table)


def verdict(asked, table, keys=("behaviour", "seed")):
    return judge(asked, table, keys).verdict


@pytest.mark.parametrize(
    ("succeeded", "n", "expected"),
    [
        (19, 20, REPRODUCED),  # 0.95 is 0.95, whatever the last bit says
        (95, 100, REPRODUCED),
        (94, 100, PARTLY),  # 0.94, but Wilson's interval ends at 0.972
        (90, 100, NOT_REPRODUCED),  # it ends at 0.945
        (85, 100, NOT_REPRODUCED),
        (0, 4, NOT_REPRODUCED),
        (1, 1, REPRODUCED),
    ],
)
def test_a_rate_at_least(succeeded, n, expected):
    table = runs([True] * succeeded + [False] * (n - succeeded))
    found = judge(claim(expected=0.95), table, ["seed"])
    assert found.verdict == expected
    assert found.measured.value == succeeded / n
    assert found.measured.runs == n


def test_twice_the_tolerance_is_partly():
    of_hundred = {n: runs([True] * n + [False] * (100 - n)) for n in (80, 79, 70, 60)}
    verdicts = [verdict(claim(expected=0.9, tolerance=0.1), of_hundred[n]) for n in (80, 79, 70)]
    assert verdicts == [REPRODUCED, PARTLY, PARTLY]
    assert verdict(claim(expected=0.9, tolerance=0.1), of_hundred[60]) == NOT_REPRODUCED


def test_a_claim_that_something_fails():
    contrast = claim(expected=0.2, comparison="at_most")
    assert verdict(contrast, runs([False] * 20)) == REPRODUCED
    assert verdict(contrast, runs([True] * 6 + [False] * 14)) == PARTLY  # from 0.145
    assert verdict(contrast, runs([True] * 20)) == NOT_REPRODUCED


@pytest.mark.parametrize(
    ("value", "expected"),
    [(1.0, REPRODUCED), (1.15, REPRODUCED), (0.72, PARTLY), (0.69, NOT_REPRODUCED)],
)
def test_the_median_of_a_quantity_near(value, expected):
    table = runs([True] * 3, speed=[value, value, 9.0])
    found = judge(claim("speed", 1.0, 0.15, "near"), table, ["seed"])
    assert found.verdict == expected
    assert (found.measured.value, found.measured.low) == (value, value)


@pytest.mark.parametrize(("few", "expected"), [(4, REPRODUCED), (6, NOT_REPRODUCED)])
def test_a_low_quantile_says_of_nearly_all_runs(few, expected):
    """95 of 100 reach 10, whatever the median is."""
    asked = Claim("c", "turn", 10.0, 0.0, "paper", "at_least", quantile=0.05)
    found = judge(asked, runs([False] * 101, turn=[3.0] * few + [40.0] * (101 - few)), ["seed"])
    assert found.verdict == expected
    assert found.measured.value == {4: 40.0, 6: 3.0}[few]


def test_values_that_are_no_numbers_are_left_out():
    found = judge(
        claim("speed", 1.0, 0.1), runs([True, False, False], speed=[1.0, None, float("inf")]), []
    )
    assert (found.verdict, found.measured.runs) == (REPRODUCED, 1)
    assert found.remarks == ("2 of 3 runs have no 'speed'",)


def test_without_a_result_it_is_not_tested():
    for table, remark in (
        (runs([None, None]), ("no run has a result", "2 of 2 runs have no result")),
        (runs([True], behaviour="other"), ("no such run in the sweep",)),
        (runs([True]).drop(columns="behaviour"), ("no column 'behaviour' in the runs",)),
    ):
        found = judge(claim(behaviour="roll"), table, [])
        assert (found.verdict, found.remarks) == (NOT_TESTED, remark)
        assert found.measured.value is None
    found = judge(claim("sped"), runs([True]), [])
    assert (found.verdict, found.remarks) == (NOT_TESTED, ("the summary has no 'sped'",))


def test_missing_runs_keep_it_from_being_reproduced():
    found = judge(claim(), runs([True] * 9 + [None]), [])
    assert (found.verdict, found.missing) == (PARTLY, 1)
    assert found.remarks == ("1 of 10 runs have no result",)


def test_runs_that_should_not_be_pooled_are_told():
    table = runs([True] * 4, gain=[1, 1, 2, 2], code=["a", "a", "a", "b"])
    assert judge(claim(), table, ["gain", "seed"]).remarks == (
        "over runs that differ in gain",
        "over runs of 2 versions of the code",
    )
    assert judge(claim(gain=1), table, ["gain", "seed"]).remarks == ()


def test_runs_that_are_the_same_to_the_bit_make_no_interval_narrower():
    table = runs([True] * 20, trajectory=["a"] * 19 + ["b"])
    found = judge(claim(), table, ["seed"])
    assert found.remarks == ("20 runs, 2 distinct",)
    assert (found.measured.runs, found.measured.distinct) == (20, 2)
    assert found.measured.low == pytest.approx(0.3424, abs=5e-5)  # Wilson's of 2 of 2
    assert judge(claim(), runs([True] * 20, trajectory=[""] * 20), ["seed"]).remarks == ()


def test_a_key_that_is_also_measured_is_the_one_asked_for():
    table = runs([True, False], duration=[5.0, 5.0], **{"config.duration": [5.0, 20.0]})
    assert judge(claim(duration=5.0), table, []).measured.runs == 1


def test_one_verdict_for_several():
    assert overall([REPRODUCED, REPRODUCED]) == REPRODUCED
    assert overall([REPRODUCED, NOT_TESTED]) == PARTLY
    assert overall([REPRODUCED, NOT_REPRODUCED]) == PARTLY
    assert overall([NOT_TESTED, NOT_REPRODUCED]) == NOT_REPRODUCED
    assert overall([NOT_TESTED]) == overall([]) == NOT_TESTED


@pytest.mark.parametrize(
    "wrong",
    [
        {"tolerance": -0.1},
        {"comparison": "about"},
        {"expected": float("nan")},
        {"metric": "turn", "quantile": 1.0},
        {"quantile": 0.05},
        {"expected": 90.0},
        {"expected": -0.1},
        {"tolerance": 5.0},
    ],
)
def test_a_claim_is_checked(wrong):
    given = {"id": "c", "metric": "success_rate", "expected": 0.9, "tolerance": 0.0, "source": "x"}
    with pytest.raises(ValidationError):
        Claim(**(given | wrong))


@pytest.mark.parametrize(
    ("wanted", "runs"), [(True, [0]), (1.0, [1]), (1, [1]), (False, [2]), (0, [3])]
)
def test_yes_is_no_1(wanted, runs):
    table = pd.DataFrame({"x": pd.Series([True, 1.0, False, 0, None], dtype=object)})
    assert picked(table, {"x": wanted}).index.tolist() == runs


def test_where_no_run_is_picked_columns_stay():
    table = pd.DataFrame({"x": [1.0, 2.0], "y": [1.0, 1.0], "success": [True, True]})
    found = picked(table, {"x": 9, "y": 1})
    assert (len(found), list(found)) == (0, ["x", "y", "success"])
