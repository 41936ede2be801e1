"""Dives from a handstand at the platform's edge, and what they are judged by."""

from dataclasses import replace

import numpy as np
import pytest
from flights import HEAD_FIRST, flier, fly

from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.metrics.criteria import dive
from rotctl.metrics.criteria.platform import clearance, stood
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

PERIOD = 1 / 240
KEY = "behaviour.target_excursion"


@pytest.fixture(scope="module")
def forward():
    """A forward dive of one somersault: its criteria and its rows."""
    config = load(["behaviour=dive_armstand_forward", "seed=2001", "plant=varied", "duration=5.3"])
    return config.criteria, in_memory(build(config))[0].arrays()


def test_it_is_held_and_enters_straight_hands_first(forward):
    criteria, log = forward
    columns, reason = dive.judge(log, criteria, 360.0, PERIOD)
    assert reason == ""
    assert columns["revolved"] == pytest.approx(360.0, abs=15.0)
    assert columns["held"] > 1.2  # its stage, and the lean that follows


def test_it_stands_on_its_hands_at_the_edge(forward):
    """By the contacts of the hold: both hands bear it, within a hand's length of the edge."""
    _, log = forward
    row = int(np.flatnonzero(np.asarray(log["command/stage"]) == 0)[-1])
    names = [name.decode() for name in np.asarray(log["model/body"])]
    used = np.asarray(log["contacts/body"])[row] > 0
    bodies = [names[b] for b in np.asarray(log["contacts/body"])[row][used]]
    assert sorted(bodies) == ["forearm_l", "forearm_r"]
    assert np.asarray(log["contacts/position"])[row][used][:, 0] == pytest.approx(0.0, abs=0.1)
    force = np.asarray(log["contacts/force_realised"])[row, :, 2].sum()
    assert force == pytest.approx(70.0 * 9.81, rel=0.05)


def test_who_is_not_held_long_enough_is_told_so(forward):
    criteria, log = forward
    longer = replace(criteria, held=replace(criteria.held, seconds=4.0))
    reason = dive.judge(log, longer, 360.0, PERIOD)[1]
    assert reason.startswith("was held upside down for 3.")
    assert reason.endswith(" s, is to be for 4")


def test_hands_that_pushed_off_do_not_count_until_the_body_is_below_the_platform(forward):
    _, log = forward
    row = dive.entry(log)
    assert clearance(log, row, 1.0, stood) < 0.15
    assert clearance(log, row, 1.0, stood, hands=True) > 0.3


@pytest.mark.parametrize(("target", "height"), [(-360, 5), (-720, 10)])
def test_backward_it_does_so_too(target, height):
    turns = [f"{KEY}={target}", f"terrain.height={height}", "seed=2001", "duration=5.3"]
    config = load(["behaviour=dive_armstand_backward", *turns])
    log = in_memory(build(config))[0].arrays()
    assert dive.judge(log, config.criteria, float(target), PERIOD)[1] == ""


def test_a_target_may_count_from_another_attitude():
    """From half a turn on, one more is the one and a half that count from upright."""
    landed = fly(flier(1.0, HEAD_FIRST | {"first": 180.0}), 45.0, height=11.0, up=1.0, pitch=0.3)
    assert abs(landed.error) < 5.0
    assert landed == fly(flier(1.5), 45.0, height=11.0, up=1.0, pitch=0.3)


@pytest.mark.parametrize(
    ("way", "target", "height", "said"),
    [
        (
            "forward",
            720,
            5,
            "to turn so far in 0.78 s asks for 75 kg m2/s in the tightest shape, and the push "
            "gives at most 50; 360 is possible here",
        ),
        (
            "backward",
            -360,
            3,
            "to turn so far in 0.55 s asks for 62 kg m2/s in the tightest shape, and the push "
            "gives at most 50; no turn is possible here",
        ),
        (
            "forward",
            180,
            10,
            "it would not come down on its forearm; half a turn less or more: 360",
        ),
        ("backward", 360, 10, "this take-off goes backward and can only turn backward; give -360"),
    ],
)
def test_what_no_push_gives_is_refused(way, target, height, said):
    words = [f"behaviour=dive_armstand_{way}", f"{KEY}={target}", f"terrain.height={height}"]
    with pytest.raises(InputError) as caught:
        build(load(words))
    assert str(caught.value) == f"{KEY}={target}: {said}"
