"""How near a roll comes to what is commanded, on logs made by hand."""

import numpy as np
import pytest

from rotctl.cli.run_wording import readable
from rotctl.config.loading import load
from rotctl.metrics.criteria.kinds import settling
from rotctl.metrics.pace import measure, off

PERIOD = 1.0 / 60.0
ASKED = {"angular_velocity_commanded": 0.5, "speed_commanded": 1.0}


def log_of(progress):
    turned = 2 * np.pi * np.asarray(progress)
    none = np.zeros(len(turned))
    return {
        "trajectory/time": PERIOD * np.arange(len(turned)),
        "trajectory/angular_excursion": np.stack((none, turned, none), axis=1),
    }


def test_means_against_commands():
    steady = log_of(0.6 * PERIOD * np.arange(600))
    found = measure(steady, (0.6, 0.9), ASKED, settle=2.0)
    assert found == pytest.approx(
        {"rate_error": 0.2, "speed_error": 0.1, "revolution_error": 0.2, "travel_mean": 1.5},
        abs=0.01,
    )


def test_a_mean_that_is_met_by_quick_and_slow_revolutions():
    time = PERIOD * np.arange(1201)
    progress = np.interp(time, [0, 4, 5, 9, 10, 14, 15, 20], [0, 1, 2, 3, 4, 5, 6, 7])
    found = measure(log_of(progress), (0.5, 1.0), ASKED, settle=0.0)
    assert found["rate_error"] == 0.0
    assert found["revolution_error"] > 0.15


def test_what_happens_before_it_settles_does_not_count():
    progress = np.interp(PERIOD * np.arange(601), [0, 5, 10], [0, 10, 12.5])
    assert measure(log_of(progress), (0.5, 1.0), ASKED, 5.0)["revolution_error"] < 0.02
    assert measure(log_of(progress), (0.5, 1.0), ASKED, 0.0)["revolution_error"] > 0.02


def test_backward_is_no_error_where_it_is_commanded():
    asked = {"angular_velocity_commanded": -0.5, "speed_commanded": -1.0}
    found = measure(log_of(-0.5 * PERIOD * np.arange(600)), (-0.5, -1.0), asked, 2.0)
    assert found["rate_error"] == found["speed_error"] == 0.0
    assert found["revolution_error"] < 0.01
    assert found["travel_mean"] == 2.0
    assert off(0.5, -0.5) == 2.0


@pytest.mark.parametrize("rows", [0, 1, 60])
def test_what_is_not_there_is_no_number(rows):
    found = measure(log_of(0.5 * PERIOD * np.arange(rows)), (np.nan, np.nan), ASKED, 2.0)
    assert np.isnan(list(found.values())).all()
    none = {"angular_velocity_commanded": 0.0, "speed_commanded": 0.0}
    assert np.isnan(measure(log_of(np.arange(600)), (0.0, 0.0), none, 2.0)["rate_error"])


@pytest.mark.parametrize(
    ("overrides", "asked", "said"),
    [
        ([], {"angular_velocity_commanded": 0.7}, ("commanded 0.70", "follows from the pace")),
        (
            ["behaviour.pace.keep=speed", "behaviour.speed=1.6"],
            {"speed_commanded": 1.6},
            ("follows from the pace", "commanded 1.60"),
        ),
        (
            ["behaviour.pace.schedule=[[7, 0.9]]"],
            {"angular_velocity_commanded": None},
            ("commanded by a schedule", "follows from the pace"),
        ),
    ],
)
def test_a_pace_is_told_by_what_it_keeps(overrides, asked, said):
    commanded = load(["behaviour=forward_roll", *overrides]).behaviour.commanded
    row = {key: value if value == value else None for key, value in commanded.items()}
    assert row == asked
    found = measure(log_of(0.7 * PERIOD * np.arange(600)), (0.7, 1.6), commanded, 2.0)
    met = [name for name in ("rate_error", "speed_error") if found[name] < 0.01]
    assert met == [{"angular_velocity": "rate_error", "speed": "speed_error"}[key.removesuffix(
        "_commanded")] for key, value in asked.items() if value]  # fmt: skip
    whole = {"success": True, "solver_failures": 0, **row}
    lines = [line for line in readable(whole).splitlines() if line.endswith(")")]
    assert [line.partition("(")[2].rstrip(")") for line in lines[:2]] == list(said)


def test_what_is_said_of_its_halts():
    row = {"success": True, "solver_failures": 0, "halt_commanded": 4.0, "halted": 1.62}
    assert "  halts        told to from 4.0 s on, still for 1.6 s" in readable(row).splitlines()
    row = {"success": True, "solver_failures": 0}
    assert "halts" not in readable(row)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"angular_velocity_mean": 0.71}, "8.0 rev in 10.0 s, 0.71 rev/s (commanded 1.30)"),
        (
            {"angular_velocity_mean": 0.71, "angular_velocity_commanded": 5.0},
            "8.0 rev in 10.0 s, 0.71 rev/s (commanded 5.00, which it does not follow)",
        ),
        (
            {"angular_velocity_mean": 0.004, "revolutions": 1.1, "success": False},
            "1.1 rev in 10.0 s, and then no more (commanded 1.30)",
        ),
        (
            {"angular_velocity_mean": 0.0, "revolutions": 0.01, "success": False},
            "0.0 rev in 10.0 s, 0.00 rev/s (commanded 1.30)",
        ),
        (
            {"angular_velocity_mean": None, "success": False},
            "8.0 rev in 10.0 s, - rev/s (commanded 1.30)",
        ),
    ],
)
def test_what_is_said_of_its_pace(changes, said):
    row = {"success": True, "solver_failures": 0, "revolutions": 8.0, "duration": 10.0}
    row |= {"angular_velocity_commanded": 1.3} | changes
    assert readable(row).splitlines()[1].partition("rolled")[2].strip() == said


@pytest.mark.parametrize(
    ("lasts", "mean", "said"),
    [
        (3.0, 0.79, "0.79 rev/s after the first 2 s (commanded 1.30)"),
        (1.5, None, "- rev/s: means begin after 2 s (commanded 1.30)"),
        (20.0, 0.79, "0.79 rev/s (commanded 1.30)"),
    ],
)
def test_of_a_short_run_it_is_said_what_its_means_leave_out(lasts, mean, said):
    row = {"success": True, "solver_failures": 0, "revolutions": 2.6, "duration": lasts}
    row |= {"angular_velocity_commanded": 1.3, "angular_velocity_mean": mean}
    assert said in readable(row, settle=2.0).splitlines()[1]


def test_what_means_leave_out_is_of_the_criteria():
    for name, settle in (("rolling", 3.0), ("finish", 2.0), ("standing", 0.0)):
        changed = ["criteria.settle=3"] if name == "rolling" else []
        assert settling(load([f"criteria={name}", *changed]).criteria) == settle
