"""Charts of sweeps: which are made, that a stranger's names harm none, and the same bytes."""

from xml.etree import ElementTree as Xml

import pandas as pd
import pytest

from rotctl.report.site.charts import charts
from rotctl.report.site.grid import grid, telling
from rotctl.report.site.outcomes import failures_of
from rotctl.results.groups import grouped
from rotctl.results.table import Table

EVIL = "<script>alert(1)</script> $x^2$ & more"
METRICS = ["angular_velocity_mean", "angular_velocity_commanded", "speed_mean", "longest_stall"]


def table(points, seeds=4, missing=0):
    """Runs over points (dicts of key -> value); every third fails."""
    rows = []
    for i, point in enumerate(points):
        for seed in range(seeds):
            good = (i + seed) % 3 > 0
            measured = dict.fromkeys(METRICS, 0.1 * (i + seed))
            rows.append(
                {"run_id": f"{i}-{seed}", "status": "done", **point, "seed": seed, "success": good}
                | {"failure_reason": "" if good else f"stalled for {i}.{seed} s from t = 1 s"}
                | measured
                | {"code": "c", "log": ""}
            )
    for row in rows[:missing]:
        row |= {"status": "failed to run", "success": None, "failure_reason": "its worker died"}
    return Table(pd.DataFrame(rows), [*points[0], "seed"], METRICS, [])


def grids(**keys):
    return [
        dict(zip(keys, values, strict=True))
        for values in pd.MultiIndex.from_product(keys.values()).tolist()
    ]


@pytest.mark.parametrize(
    ("points", "expected"),
    [
        ([{"behaviour": "roll"}], ["groups", "failures", "starts"]),
        (
            grids(behaviour=["a", "b"], gain=[1.0, 2.0, 3.0]),
            ["groups", "curves", "failures", "starts"],
        ),
        (
            grids(behaviour=["a", "b"], gain=[1.0, 2.0, 3.0], damping=[1, 2, 3, 4]),
            ["groups", "heat", "failures", "starts"],  # eight curves would be too many
        ),
    ],
)
def test_charts_suit_the_sweep(points, expected):
    made = charts(grid(table(points)))
    assert [chart.name for chart in made] == expected
    for chart in made:
        root = Xml.fromstring(chart.light)
        assert root.tag.endswith("svg")
        assert chart.light != chart.dark
        assert chart.alt


def test_the_same_runs_give_the_same_bytes():
    first, second = (charts(grid(table(grids(behaviour=["a"], x=[1.0, 2.0, 3.0])))) for _ in "12")
    assert first == second


def test_a_strangers_names_stay_text():
    made = charts(grid(table([{"behaviour": EVIL}, {"behaviour": "b"}])))
    assert made
    for chart in made:
        assert b"<script" not in chart.light
        texts = [
            text.text or "" for text in Xml.fromstring(chart.light).iter() if "text" in text.tag
        ]
        assert any(text.startswith("<script>alert(1)</script> $x^2$") for text in texts)


def test_thousands_of_groups_are_not_listed():
    made = charts(
        grid(table(grids(behaviour=["a"], x=list(range(20)), y=list(range(20))), seeds=2))
    )
    assert [chart.name for chart in made] == ["heat", "starts"]
    assert sum(len(chart.light) for chart in made) < 300_000


def test_keys_that_change_together_are_told_by_the_first():
    points = [
        {"behaviour": b, "terrain": t, "gain": 1.0} for b, t in (("a", "flat"), ("b", "hills"))
    ]
    found = grouped(table(points))
    assert telling(found) == ["behaviour"]
    assert grid(table(points)).groups["label"].tolist() == ["a", "b"]


def test_failures_are_counted_by_kind():
    counted = failures_of(grid(table([{"behaviour": "a"}], seeds=6, missing=1)).runs)
    assert counted.to_dict("records") == [{"stalled for … s": 1, "failed to run": 1}]


def test_without_any_result_there_are_still_charts():
    made = charts(grid(table([{"behaviour": "a"}, {"behaviour": "b"}], seeds=2, missing=4)))
    assert [chart.name for chart in made] == ["groups", "failures", "starts"]
    assert made[0].alt == "No run has a result."


@pytest.mark.parametrize("value", [1e308, -1e308, 1e15, 1e-308, 5e-324, -1e-320])
def test_numbers_that_no_axis_has_ticks_for(value):
    """A stranger's outcome, in one run and in all; and along an axis."""
    some = table(grids(behaviour=["a"], gain=[1.0, value, 3.0]))
    for rows in ([0], slice(None)):
        some.rows.loc[some.rows.index[rows], METRICS] = value
        assert charts(grid(some))
