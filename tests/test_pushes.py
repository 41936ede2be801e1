"""Pushes at a phase, who rolls on after one, and the map of it."""

from dataclasses import replace
from itertools import islice
from math import nan, radians, tau
from xml.etree import ElementTree as Xml

import numpy as np
import pandas as pd
import pytest

from rotctl.cli.run_wording import readable
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.mechanics.onset import Onset
from rotctl.metrics.criteria.judge import judge
from rotctl.report.site import pushes
from rotctl.report.site.charts import charts
from rotctl.report.site.grid import grid
from rotctl.results.group_table import markdown
from rotctl.results.groups import grouped
from rotctl.results.table import Table
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.runs.summary import summarise
from rotctl.simulation.episode import Episode

PUSH = ("seed=2001", "disturbance=push", "disturbance.time=1.0")


def measured(*overrides):
    scenario = build(load([*PUSH, *overrides]))
    buffer, _ = in_memory(scenario)
    config = scenario.config
    found = judge(
        buffer.arrays(), config.criteria, config.behaviour.commanded, 1 / 60, config.duration
    )
    return buffer, found.columns


# ---------------------------------------------------------------- when


@pytest.mark.parametrize("degrees", [0.0, 90.0, 300.0])
@pytest.mark.parametrize("behaviour", ["forward_roll_1", "backward_roll_1"])
def test_a_push_begins_as_the_phase_is_passed(degrees, behaviour):
    """Forward it grows, backward it falls; the step that passes it is the one before."""
    scenario = build(
        load([*PUSH, f"behaviour={behaviour}", f"disturbance.phase={degrees}", "duration=6"])
    )
    steps = list(islice(Episode(scenario), 360))
    began = next(i for i, step in enumerate(steps) if step.wrench.any())
    assert steps[began].state.time >= 1.0 - 1e-9
    before, after = (steps[i].signals.phase for i in (began - 2, began - 1))
    places = radians(degrees) + tau * np.arange(-10, 10)
    assert ((places > min(before, after) - 1e-9) & (places < max(before, after) + 1e-9)).any()
    earlier = [step.signals.phase for step in steps[60 : began - 1]]
    assert all(
        not ((places > min(a, b)) & (places < max(a, b))).any()
        for a, b in zip(earlier, earlier[1:], strict=False)
    )


def told(*overrides):
    scenario = build(load([*PUSH, "duration=3", *overrides]))
    buffer, ending = in_memory(scenario)
    row = summarise(scenario, buffer, ending, 1.0)
    return row, next((line for line in readable(row).splitlines() if "disturbed" in line), "")


def test_a_summary_tells_what_came():
    row, line = told("disturbance.impulse=20")
    assert row["disturbed_by"] == pytest.approx(20.0, rel=1e-9)
    assert row["disturbed_at"] == pytest.approx(1.0, abs=1 / 60 + 1e-9)
    came = f"  disturbed    by 20 N s, from {row['disturbed_at']:.2f} s on"
    assert line == f"{came}; rolled on at once"


def test_a_summary_tells_that_nothing_came():
    """A roll that is over before the phase comes was not pushed, though that was asked for."""
    row, line = told("disturbance.phase=120", "disturbance.time=2.95")
    assert (row["disturbed_by"], row["disturbed_at"]) == (0.0, None)
    assert line == "  disturbed    by nothing: what was to come did not come in the run"


@pytest.mark.parametrize("phase", ["3150", "-361", "[-90,400]"])
@pytest.mark.parametrize("kind", ["push", "load", "slippery"])
def test_a_phase_lies_within_a_revolution(kind, phase):
    with pytest.raises(InputError) as raised:
        load([f"disturbance={kind}", f"disturbance.phase={phase}"])
    shown = "" if phase.startswith("[") else f"={phase}"
    assert str(raised.value) == (
        f"disturbance.phase{shown}: must lie within a revolution, from -360 to 360 deg"
    )


def test_a_change_comes_with_the_control_step_at_its_time():
    """Though the run's time, a sum of steps, is a little less there."""
    scenario = build(load(["behaviour=stand", "disturbance=load", "disturbance.time=0.5"]))
    steps = list(islice(Episode(scenario), 32))
    told = [i for i, step in enumerate(steps) if step.remark]
    assert told == [30]
    assert steps[30].state.time < 0.5


@pytest.mark.parametrize(
    ("overrides", "missed"),
    [
        (["load", "disturbance.phase=90", "disturbance.time=0.5"], ["chest takes up 5 kg"]),
        (["slippery", "disturbance.phase=90", "disturbance.time=0.5"],
         ["the ground has 0.5 of its friction"]),
        (["push", "disturbance.phase=90"], ["the push"]),
        (["push", "disturbance.time=[0.5, 1e6]"], ["the push"]),
        (["wind", "disturbance.time=[0.5, 1e6]"], ["the wind"]),
        (["load", "disturbance.time=[0.2, 0.3]"], []),
        (["push", "disturbance.time=[0.2, 0.3]"], []),
        (["wind"], []),
        (["none"], []),
    ],
    ids=str,
)  # fmt: skip
def test_what_never_came_is_told_at_the_end(overrides, missed):
    """As standing has no phase to come through."""
    chosen = [f"disturbance={overrides[0]}", *overrides[1:]]
    buffer, _ = in_memory(build(load(["behaviour=stand", "duration=1", *chosen])))
    told = [(at, text) for at, text in buffer.events if "never came" in text]
    assert [text for _, text in told] == [f"to the end it never came: {it}" for it in missed]
    assert all(at == buffer.trajectory.time[-1] for at, _ in told)


def test_a_phase_that_is_never_passed_never_comes():
    onset = Onset(0.0, 1.0)
    assert not any(onset.come(0.1, phase) for phase in (nan, 0.5, 0.9, 0.7, 0.99))
    assert onset.come(0.2, 1.01)


def test_a_number_stands_for_itself():
    at, between = (load([*PUSH, f"disturbance.direction={way}"]) for way in ("30", "[30,30]"))
    one, other = build(at).disturbance, build(between).disturbance
    assert np.array_equal(one.force, other.force)


# ---------------------------------------------------------------- and then


def test_a_light_push_is_overcome_at_once():
    _, columns = measured("disturbance.impulse=1", "duration=6")
    assert columns["recovered"] == 1.0
    assert columns["recovery"] == pytest.approx(0.0, abs=0.5)


def test_pushes_that_throw_it_over_are_seldom_overcome():
    """Who tumbles may by chance roll on: most of six do not."""
    overcome = 0.0
    for impulse in (200, 300, 600):
        for direction in (90, 270):
            push = f"disturbance.impulse={impulse}", f"disturbance.direction={direction}"
            overcome += measured(*push, "duration=6")[1]["recovered"]
    assert overcome <= 3.0


@pytest.mark.parametrize("disturbance", ["none", "wind"])
def test_without_a_push_that_ends_nothing_is_overcome(disturbance):
    scenario = build(load([f"disturbance={disturbance}", "duration=3"]))
    buffer, _ = in_memory(scenario)
    config = scenario.config
    found = judge(buffer.arrays(), config.criteria, config.behaviour.commanded, 1 / 60, 3.0)
    assert np.isnan(found.columns["recovered"])
    assert np.isnan(found.columns["recovery"])


def test_what_the_end_cuts_short_is_not_called_unrecovered():
    """Thrown over at 2 s: 3.5 s on, all that one looks at, it is known, and not before."""
    thrown = ("disturbance.time=2", "disturbance.impulse=900", "disturbance.direction=90")
    buffer, columns = measured(*thrown, "duration=7")
    assert columns["recovered"] == 0.0
    scenario = build(load([*PUSH, *thrown]))
    config, log = scenario.config, buffer.arrays()
    asked = config.behaviour.commanded
    known = {}
    for end in (4.0, 5.0, 5.5, 6.0):
        cut = {k: v[: round(60 * end)] if k[:6] != "model/" else v for k, v in log.items()}
        whole = judge(cut, config.criteria, asked, 1 / 60, end).columns
        broken = judge(cut, config.criteria, asked, 1 / 60, 20.0).columns
        assert broken["recovered"] == 0.0
        known[end] = not np.isnan(whole["recovered"])
    assert known == {4.0: False, 5.0: False, 5.5: False, 6.0: True}


def test_a_roll_that_is_to_end_on_its_feet_and_breaks_off_has_not_recovered():
    config = load([*PUSH, "behaviour=forward_roll", "+finish=stand", "disturbance.impulse=1"])
    told = replace(config.behaviour, finish=replace(config.behaviour.finish, after=1.5))
    buffer, _ = in_memory(build(replace(config, behaviour=told, duration=2.0)))
    asked = config.behaviour.commanded
    whole, broken = (
        judge(buffer.arrays(), config.criteria, asked, 1 / 60, wanted).columns["recovered"]
        for wanted in (2.0, config.duration)
    )
    assert np.isnan(whole)
    assert broken == 0.0


@pytest.mark.parametrize(
    ("recovered", "recovery", "words"),
    [
        (1.0, 0.26, "; rolled on 0.3 s after it"),
        (1.0, 0.04, "; rolled on at once"),
        (0.0, 2.44, "; rolled on 2.4 s after it, too late"),
        (0.0, None, "; did not roll on"),
        (None, None, ""),
    ],
)
def test_a_summary_tells_what_came_of_it(recovered, recovery, words):
    row, _ = told("disturbance.impulse=20", "duration=2")
    row |= {"recovered": recovered, "recovery": recovery}
    line = next(line for line in readable(row).splitlines() if "disturbed" in line)
    assert line == f"  disturbed    by 20 N s, from {row['disturbed_at']:.2f} s on{words}"


def test_a_table_has_the_share_that_rolled_on_and_nothing_of_who_was_not_pushed():
    rows = [
        {"behaviour": b, "seed": i, "success": True, "status": "done", "code": "c", "log": ""}
        | {"run_id": f"{b}{i}", "trajectory": f"{b}{i}", "recovered": value}
        for b, values in (("a", [1.0, 0.0, 1.0, None]), ("b", [None] * 4))
        for i, value in enumerate(values)
    ]
    table = Table(pd.DataFrame(rows), ["behaviour", "seed"], ["recovered"], [])
    found = grouped(table)
    assert found.rows["recovered_rate"].tolist() == pytest.approx([2 / 3, nan], nan_ok=True)
    heading, _, a, b = markdown(found).splitlines()
    assert heading.split()[-2] == "recovered"
    assert a.split()[-5:-1] == ["67", "%", "of", "3"]
    assert b.split()[-2] == "-"
    alone = Table(table.rows[4:].reset_index(drop=True), table.keys, table.metrics, [])
    assert "recovered" not in markdown(grouped(alone))


# ---------------------------------------------------------------- the map


def runs(recovers):
    """Runs of two behaviours over impulses and directions; who recovers is told."""
    points = pd.MultiIndex.from_product([["a", "b"], [10.0, 20.0, 30.0], [0.0, 90.0, 180.0]])
    rows = [
        {"run_id": f"{n}-{seed}", "status": "done", "behaviour": b, "seed": seed}
        | {pushes.IMPULSE: impulse, pushes.DIRECTION: way, "success": True, "failure_reason": ""}
        | {"recovered": float(recovers(b, impulse, way, seed)), "code": "c", "log": ""}
        for n, (b, impulse, way) in enumerate(points.tolist())
        for seed in range(20)
    ]
    keys = ["behaviour", pushes.IMPULSE, pushes.DIRECTION, "seed"]
    return Table(pd.DataFrame(rows), keys, ["recovered"], [])


def test_what_is_withstood_is_the_last_impulse_before_the_first_that_is_not():
    """`a` falls from 20 on at 90 deg, but would stand 30; `b` loses one of 20, which is 95 %."""
    table = runs(lambda b, impulse, way, seed: seed > 0 if b == "b" else (impulse, way) != (20, 90))
    found = pushes.maps(table.rows, ["behaviour"])
    a, b = (pushes.withstood(shares).to_dict() for shares in found.values())
    assert a == {0.0: 30.0, 90.0: 10.0, 180.0: 30.0}
    assert b == {0.0: 30.0, 90.0: 30.0, 180.0: 30.0}
    assert pushes.said(found).startswith(
        "95 % recover up to, a: 10 N s in the worst direction (90\u00b0), 30 in"
    )


def test_nothing_is_withstood_where_the_least_is_too_much():
    found = pushes.maps(runs(lambda *_: False).rows, ["behaviour"])
    assert [pushes.withstood(shares).max() for shares in found.values()] == [0.0, 0.0]


def test_the_phases_that_are_overcome_least_and_most_are_told():
    rows = runs(lambda b, impulse, way, seed: seed % 4 > 0).rows
    assert pushes.said_of_phases(rows) == ""
    assert pushes.said_of_phases(rows.assign(**{pushes.PHASE: "[0, 360]"})) == ""
    assert pushes.said_of_phases(rows.assign(**{pushes.PHASE: 45.0 * (rows["seed"] % 4)})) == (
        " Over all, 0 % are overcome that come at a phase of 0\u00b0, 100 % at 45\u00b0."
    )


def test_the_map_is_among_the_charts_of_a_sweep():
    (chart,) = [c for c in charts(grid(runs(lambda *_: True))) if c.name == "pushes"]
    assert Xml.fromstring(chart.light).tag.endswith("svg")
    assert "30 N s in the worst direction" in chart.alt
