"""A roll that is told to go up as it turns: what control is asked for, and what comes of it."""

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

LIFT = [0.1, 0.2, -0.3, 0.05, 0.15]


def rolled(*overrides):
    scenario = build(load(["behaviour=backward_roll_2", "seed=2003", *overrides]))
    buffer, _ = in_memory(scenario)
    return buffer.arrays()


@pytest.mark.parametrize("more", [(), ("terrain=incline",)], ids=["level", "uphill"])
def test_it_is_added_to_the_speed_along_the_way(more):
    log = rolled("duration=1.5", f"++behaviour.lift={LIFT}", *more)
    plain = rolled("duration=0.1", "++behaviour.lift=null", *more)
    phase = log["trajectory/phase"]
    ones = np.ones_like(phase)
    waves = ones, np.cos(phase), np.sin(phase), np.cos(2 * phase), np.sin(2 * phase)
    turns = (log["trajectory/angular_velocity"] * log["command/axes"][:, 1]).sum(1) / (2 * np.pi)
    asked = log["command/velocity"][:, 0] - plain["command/velocity"][0, 0]
    assert np.abs(asked[:, :2]).max() < 1e-12
    assert asked[:, 2] == pytest.approx(turns * np.tensordot(LIFT, waves, 1), abs=1e-12)
    assert np.ptp(phase) > 3.0


def test_who_is_told_to_rise_over_its_hands_gets_higher_there():
    """By 0.5 m/rev at 0.55 rev, and down again by as much at 0.05."""
    told = [0.0, -0.476, -0.155]
    heights = []
    for lift in ("null", told):
        log = rolled("duration=6", f"++behaviour.lift={lift}")
        turn = log["trajectory/phase"] / (2 * np.pi) % 1.0
        late = (log["trajectory/time"] > 1.5) & (turn > 0.6) & (turn < 0.7)
        heights.append(np.median(log["trajectory/com"][late, 2]))
    assert heights[1] > heights[0] + 0.02


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("[1,2]", "behaviour.lift: must be a mean with pairs of cosine and sine, not 2 numbers"),
        ("[21]", "behaviour.lift.0=21: must be less than or equal to 20"),
    ],
)
def test_what_makes_no_lift(value, message):
    with pytest.raises(InputError) as told:
        build(load([f"+behaviour.lift={value}"]))
    assert str(told.value) == message
