"""From lying on the back or a side over the shoulders to standing, and again where it fails."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from rotctl.behaviours.staged.conditions import Leant
from rotctl.config.loading import load
from rotctl.config.schema import changed
from rotctl.errors import InputError
from rotctl.metrics.criteria.getting_up import GettingUpCriteria, judge
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.simulation.known import StateSettings

UP = GettingUpCriteria("up", "getting_up", ("foot_l", "foot_r"), 4.0, 1.0, 0.8, 20.0, 0.5)
UPRIGHT = 0.986  # [m] of an adult's centre of mass
CURL, THROW, ROLL, STAND = 1, 2, 4, 6  # stages
LYING = StateSettings((0.0, 0.0), 0.0, (1.0, 0.0, 1.0, 0.0), (0.0,) * 3, (0.0,) * 3, {}, {})


def simulated(config):
    return in_memory(build(config))[0].arrays()


def lying(behaviour, duration, more=(), **state):
    """A run that begins on the front, its head ahead."""
    config = load([f"behaviour={behaviour}", "start=symmetric", f"duration={duration}", *more])
    still = dict.fromkeys(("pitch", "speed_x", "angular_velocity_y"), (0.0, 0.0))
    return replace(config, start=replace(config.start, **still, state=replace(LYING, **state)))


@pytest.fixture(scope="module")
def rocked():
    """Who lies on the back: rows of some starts."""
    config = load(["behaviour=rock_up", "start=supine", "duration=5"])
    return [simulated(changed(config, {"seed": seed})) for seed in (2000, 2003, 2012)]


@pytest.mark.parametrize("start", ["supine", "side"])
def test_of_four_starts_two_stand_within_four_seconds(start):
    """Of a hundred 96 do from a side, all from the back: at most one does once in a hundred."""
    made = (
        simulated(load(["behaviour=rock_up", f"start={start}", f"seed={seed}", "duration=5"]))
        for seed in (2000, 2003, 2001, 2004)
    )
    assert sum(not judge(log, UP, 1 / 120, UPRIGHT)[1] for log in made) >= 2


def test_hips_rise_over_the_head_before_the_feet_come_down(rocked):
    """It goes over the shoulders: nothing but the back, the head and arms is on the ground."""
    for log in rocked:
        row = int(np.argmax(log["command/stage"] == ROLL))
        touching = {log["model/body"][body] for body in log["contacts/body"][row] if body > 0}
        assert touching <= {b"waist", b"chest", b"head", b"forearm_l", b"forearm_r", b"upper_arm_l",
                            b"upper_arm_r"}  # fmt: skip
        assert log["trajectory/trunk_axes"][row, 2, 2] < 0.0  # head down


def test_the_roll_goes_where_the_feet_lay(rocked):
    """From the back, whose feet are in the air as the roll begins, on along the body."""
    for log in rocked:
        long = log["trajectory/trunk_axes"][0, :2, 2]
        row = int(np.argmax(log["command/stage"] == ROLL))
        way = log["command/axes"][row, 0, :2]
        assert way @ -long / np.linalg.norm(long) == pytest.approx(1.0, abs=1e-6)


def test_who_lies_in_the_end_begins_again():
    """Lower than two metres it is all the time: it begins again instead of the last stage."""
    config = load(["behaviour=rock_up", "seed=2012", "duration=3.2"])
    log = simulated(replace(config, behaviour=replace(config.behaviour, again=2.0)))
    stage = log["command/stage"].tolist()
    assert ROLL in stage
    assert STAND not in stage
    assert stage[-1] < ROLL


def test_parts_that_come_again_are_not_judged_one_by_one():
    with pytest.raises(InputError, match="criteria=chain does not judge behaviour=rock_up"):
        build(load(["behaviour=rock_up", "criteria=chain", "criteria.parts=[]", "duration=1"]))


def test_a_roll_keeps_to_the_line_through_where_it_begins():
    """It is the same one elsewhere: nothing draws it to the middle of the world."""
    here, there = (
        simulated(lying("forward_roll", 0.5, place=place)) for place in ((0.0, 0.0), (3.0, -2.0))
    )
    moved = there["trajectory/com"] - here["trajectory/com"] - np.array([3.0, -2.0, 0.0])
    assert np.abs(moved).max() < 1e-6


@pytest.mark.parametrize(("leant", "curls"), [(30.0, False), (60.0, True), (150.0, False)])
def test_who_sits_or_stands_on_the_shoulders_lies_down_first(leant, curls):
    """Leant back so far from upright, at rest: within 40 degrees of the level it curls at once."""
    half = np.radians(leant) / 2.0
    log = simulated(lying("rock_back", 0.05, orientation=(np.cos(half), 0.0, -np.sin(half), 0.0)))
    assert (log["command/stage"][-1] == CURL) == curls


def test_the_throw_lasts_until_the_trunk_is_over(rocked):
    """Head lower than the hips, and no sooner than in 0.39 s."""
    for log in rocked:
        first, last = np.searchsorted(log["command/stage"], [THROW, THROW + 1])
        assert log["trajectory/trunk_axes"][last, 2, 2] < 0.0
        assert last - first >= round(0.39 * 120)


@pytest.mark.parametrize(("terrain", "slope"), [("flat", 0.0), ("incline", 6.0), ("decline", -6.0)])
@pytest.mark.parametrize(("beyond", "leant"), [(-1.0, False), (1.0, True)])
def test_leaning_is_measured_from_the_ground(terrain, slope, beyond, leant):
    """On the back, feet ahead: head down by the slope already, where that leads up."""
    config = load(["behaviour=rock_back", f"terrain={terrain}"])
    angle = np.radians(-(92.0 + slope + beyond))  # about left: its head goes back
    c, s = np.cos(angle), np.sin(angle)
    axes = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    momentum = SimpleNamespace(com=np.array([0.3, 0.1, 0.4]))
    state = SimpleNamespace(trunk_axes=axes, momentum=momentum, time=1.0)
    scene = SimpleNamespace(model=build(config).model, state=state, begin=SimpleNamespace(time=0.0))
    assert Leant("leant", 92.0, 0.39).met(scene) == leant


@pytest.mark.parametrize(("speed", "curls"), [(0.0, True), (2.0, False)])
def test_who_still_moves_fast_comes_to_lie_first(speed, curls):
    """On its back, its feet ahead: as it lies it needs no turn."""
    on_its_back = (1.0, 0.0, -1.0, 0.0)
    moving = lying("rock_back", 0.05, orientation=on_its_back, velocity=(speed, 0.0, 0.0))
    assert (simulated(moving)["command/stage"][-1] == CURL) == curls
