"""What a run is worth, and a candidate over its runs."""

from dataclasses import replace
from math import nan

import pytest

from rotctl.tune.objective import LOST, Objective, TrialRun, Wish, finished, overall, score

OBJECTIVE = Objective("mean", survival=0.6, progress=0.4, pace=0.65, drift=0.03, heading=0.001)
WANTED = replace(OBJECTIVE, success=0.5)
PERFECT = TrialRun(10.0, wanted=10.0, revolutions=6.5, drift=0.0, heading=0.0, success=True)


@pytest.mark.parametrize(
    ("run", "worth"),
    [
        (PERFECT, 1.0),
        (replace(PERFECT, revolutions=60.0), 1.0),
        (replace(PERFECT, revolutions=-2.0), 0.6),
        (replace(PERFECT, survived=5.0, revolutions=3.25), 0.5),
        (replace(PERFECT, drift=-1.0), 0.97),
        (replace(PERFECT, heading=-30.0), 0.97),
        (replace(PERFECT, survived=0.0, heading=nan), 0.0),
        (LOST, 0.0),
    ],
)
def test_the_score_of_a_run(run, worth):
    assert score(run, OBJECTIVE) == pytest.approx(worth)


def test_a_success_by_the_criteria_is_worth_more():
    assert score(PERFECT, WANTED) == pytest.approx(1.5)
    assert score(replace(PERFECT, success=False), WANTED) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("value", "cost"),
    [
        *((0.9, 0.0), (1.0, 0.0), (0.85, 0.1), (0.5, 0.8), (0.4, 1.0), (-9.0, 1.0), (1.1, 0.2)),
        (nan, 1.0),
    ],
)
def test_a_column_outside_of_what_is_wished_costs(value, cost):
    wished = replace(WANTED, columns={"hands_bear": Wish(weight=0.3, miss=0.5, low=0.9, high=1.0)})
    run = replace(PERFECT, columns={"hands_bear": value})
    assert score(run, wished) == pytest.approx(1.5 - 0.3 * cost)
    assert score(PERFECT, wished) == pytest.approx(1.2), "a column that is not there"


def test_the_mean_or_the_worst_run_counts():
    runs = [PERFECT, replace(PERFECT, survived=5.0, revolutions=3.25), PERFECT]
    assert overall(runs, OBJECTIVE) == pytest.approx(2.5 / 3)
    assert overall(runs, replace(OBJECTIVE, over_runs="worst")) == pytest.approx(0.5)
    assert finished(runs) == pytest.approx(2 / 3)
