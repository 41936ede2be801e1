"""A front aerial: off one foot, over without hands, onto the other one."""

from itertools import pairwise

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.metrics.criteria.flip import judge, longest_flight, measure
from rotctl.metrics.touching import touch_downs
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

PERIOD = 1 / 240


@pytest.fixture(scope="module")
def runs():
    """Three starts until the second foot is down, and what each is judged by."""
    made = []
    for seed in (2009, 2010, 2012):
        config = load(["behaviour=front_aerial", f"seed={seed}", "plant=varied", "duration=0.9"])
        buffer, ending = in_memory(build(config))
        assert not ending
        made.append((config, buffer.arrays()))
    return made


def feet(log):
    """(steps,) whether the left foot and the right one are on the ground."""
    names = [name.decode() for name in log["model/body"].tolist()]
    return [(log["contacts/body"] == names.index(f"foot_{side}")).any(axis=1) for side in "lr"]


def test_it_takes_off_from_one_foot_and_lands_on_the_other(runs):
    for _, log in runs:
        first, landed = longest_flight(log)
        left, right = feet(log)
        assert left[0]
        assert not right[:first].any()
        assert right[landed]
        assert not left[landed]


def test_no_hand_comes_down(runs):
    for _, log in runs:
        came = [body for _, body in touch_downs(log, PERIOD)]
        assert came[0] == "foot_r"
        assert set(came) <= {"foot_l", "foot_r"}


def test_it_turns_over_in_the_air(runs):
    """Between the feet the trunk turns by more than half a turn, all of it upside down for once."""
    for config, log in runs:
        found = measure(log, config.criteria, PERIOD)
        assert found.flight_time > config.criteria.flight
        assert 60.0 < found.take_off_momentum < 100.0
        first, landed = longest_flight(log)
        up = log["trajectory/trunk_axes"][first:landed, 2, 2]
        assert up.min() < -0.95
        turned = [log["trajectory/phase"][row] for row in (first, landed)]
        assert np.diff(turned)[0] > np.pi


def test_a_run_up_leaves_the_foot_where_it_is(runs):
    """The body turns over it: what moves at 2.2 m/s is not the foot."""
    for _, log in runs:
        assert 2.0 < log["trajectory/com_velocity"][0, 0] < 2.4
        left, _ = feet(log)
        names = [name.decode() for name in log["model/body"].tolist()]
        foot = names.index("foot_l")
        places = [
            log["contacts/position"][row][log["contacts/body"][row] == foot].mean(axis=0)[0]
            for row in np.flatnonzero(left)[:24]
        ]
        assert max(abs(b - a) for a, b in pairwise(places)) < 0.12  # from heel and toes to toes
        assert abs(places[-1] - max(places)) < 0.05


def test_of_two_starts_one_stands():
    """Nine of ten do, each by itself: that none of two does is no chance."""
    stood = 0
    for seed in (2010, 2012):
        config = load(["behaviour=front_aerial", f"seed={seed}", "plant=varied", "duration=5"])
        buffer, _ = in_memory(build(config))
        _, reason = judge(buffer.arrays(), config.criteria, 360.0, PERIOD)
        stood += not reason
    assert stood
