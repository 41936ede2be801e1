"""Ways of a chain: chosen by how the body is, as it begins and as a try comes to nothing."""

from dataclasses import replace
from math import cos, radians, sin, tau
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.behaviours.chain.ways import FaceDown, Rolls, Way
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.metrics.criteria.getting_up import GettingUpCriteria, judge
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.simulation.known import StateSettings

PARTS = ("rock_back", "press_up", "roll_up", "at once", "ends rolling")
FIRST = (0, 4, 14, 17, 20)  # stages of the parts of get_up
UP = GettingUpCriteria("up", "getting_up", ("foot_l", "foot_r"), 2.0, 1.0, 0.8, 20.0, 0.25)
UPRIGHT = 0.986  # [m] of an adult's centre of mass
SQUAT = {
    f"{joint}_{side}": angle
    for joint, angle in {"hip_y": 2.2, "knee": 2.4, "ankle_y": 0.6, "shoulder_y": 1.0}.items()
    for side in "lr"
}


def simulated(*overrides, seconds=0.05, state=None, **changes):
    """A short run of get_up."""
    config = load(["behaviour=get_up", f"duration={seconds}", *overrides])
    if state:
        still = dict.fromkeys(("pitch", "speed_x", "angular_velocity_y"), (0.0, 0.0))
        start = replace(config.start, **still, scatter=0.0, tilt=0.0, postures={}, state=state)
        config = replace(config, start=start)
    behaviour = replace(config.behaviour, **changes)
    return in_memory(build(replace(config, behaviour=behaviour)))[0].arrays()


def parts(log):
    """The names of the parts, in their order, each as often as it begins from another one."""
    number = np.searchsorted(FIRST, log["command/stage"], side="right") - 1
    first = np.flatnonzero(np.diff(number, prepend=-1))
    return [PARTS[one] for one in number[first]]


def turned(angle, pose):
    """At rest, turned about its left from upright [deg]."""
    half = radians(0.5 * angle)
    there = (cos(half), 0.0, sin(half), 0.0)
    return StateSettings((0.0, 0.0), 0.0, there, (0.0,) * 3, (0.0,) * 3, pose, {})


@pytest.mark.parametrize(
    ("start", "part"),
    [("supine", "rock_back"), ("side", "rock_back"), ("prone", "press_up")],
)
def test_the_way_is_that_of_how_the_body_lies(start, part):
    for seed in (1, 2, 3):
        assert parts(simulated(f"start={start}", f"seed={seed}")) == [part]


def test_who_squats_stands_up_at_once():
    log = simulated(state=turned(15.0, SQUAT), seconds=3.2)
    assert parts(log) == ["at once"]
    assert not judge(log, UP, 1 / 120, UPRIGHT)[1]


@pytest.mark.parametrize(("pitch", "part"), [(-60.0, "rock_back"), (90.0, "press_up")])
def test_who_sits_or_is_on_all_fours_takes_the_way_of_who_lies(pitch, part):
    """Leaning back with the legs ahead, or face down with thighs and arms under it."""
    joints = ("hip_y", "shoulder_y") if pitch > 0.0 else ("hip_y",)
    pose = {f"{joint}_{side}": 1.57 for joint in joints for side in "lr"}
    assert parts(simulated(state=turned(pitch, pose))) == [part]


def test_who_falls_takes_the_way_of_how_it_lies_then():
    """At three metres a second backwards nobody stays up."""
    rolls, first, *others = load(["behaviour=get_up"]).behaviour.ways
    hasty = replace(first, when=replace(first.when, speed=9.0))
    falling = replace(turned(0.0, {}), velocity=(-3.0, 0.0, 0.0))
    log = simulated(state=falling, seconds=1.2, ways=(rolls, hasty, *others))
    assert parts(log)[:2] == ["at once", "rock_back"]


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_who_comes_to_lie_on_the_front_while_it_turns_gets_up_from_there(side):
    """65 degrees off the front, for which 60 count as that, and tumbling at 6 rad/s."""
    down = Rotation.from_euler("y", 90.0, degrees=True)  # on the front, the head ahead
    aside = down * Rotation.from_euler("z", side * 65.0, degrees=True)
    there = tuple(aside.as_quat(scalar_first=True).tolist())
    falling = replace(turned(0.0, {}), orientation=there, angular_velocity=(0.0, 0.0, -side * 6.0))
    assert parts(simulated(state=falling, seconds=0.6)) == ["rock_back", "press_up"]


def test_who_moves_through_a_squat_does_not_stand_up_at_once():
    falling = replace(turned(0.0, {}), velocity=(-3.0, 0.0, 0.0))
    assert parts(simulated(state=falling)) == ["rock_back"]


def test_a_part_that_lasts_too_long_begins_again():
    log = simulated("start=supine", "seed=1", seconds=0.2, ways=(
        Way((3,), FaceDown("face_down", 1.0)), Way((1,), FaceDown("face_down", 1.0)),
        Way((4,), FaceDown("face_down", 1.0)), Way((0, 2), patience=0.1),
    ))  # fmt: skip
    stage = log["command/stage"]
    again = log["trajectory/time"][np.flatnonzero(np.diff(stage) < 0) + 1]
    assert again == pytest.approx([0.11], abs=0.01)


BALL = {
    f"{joint}_{side}": angle
    for joint, angle in {"hip_y": 2.2, "knee": 2.2, "shoulder_y": 1.0}.items()
    for side in "lr"
}


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_who_rolls_ends_the_roll(way):
    """On its back in a ball, round at 0.8 rev/s and along at 1.5 m/s, either way."""
    rolling = replace(
        turned(-90.0, BALL), velocity=(way * 1.5, 0.0, 0.0), angular_velocity=(0.0, way * 5.0, 0.0)
    )
    assert parts(simulated(state=rolling)) == ["ends rolling"]


def test_a_way_that_begins_with_a_roll_leads_across_the_trunks_left():
    """On the back, the head towards -x, it is where the feet are."""
    rolling = replace(turned(-90.0, BALL), angular_velocity=(0.0, 5.0, 0.0))
    log = simulated(state=rolling)
    assert log["command/axes"][-1, 0] == pytest.approx([1.0, 0.0, 0.0], abs=1e-6)


@pytest.mark.parametrize(
    ("turning", "tilt", "met"),
    [(0.3, 0.0, False), (0.5, 0.0, True), (-0.5, 0.0, True), (0.5, 10.0, True), (0.5, 20.0, False)],
)
def test_who_rolls_turns_about_the_trunks_level_left(turning, tilt, met):
    left = np.array([0.0, cos(radians(tilt)), sin(radians(tilt))])
    momentum = SimpleNamespace(angular_velocity=tau * turning * left)
    axes = np.array([left * 0.0, left, left * 0.0]).T
    state = SimpleNamespace(trunk_axes=axes, momentum=momentum)
    assert Rolls("rolls", 0.4, 15.0).met(None, state) == met


@pytest.mark.parametrize(("off", "met"), [(0.0, True), (55.0, True), (65.0, False), (180.0, False)])
def test_face_down_is_the_front_within_an_angle_of_straight_down(off, met):
    for about in (0.0, 2.0):  # which way the trunk lies
        front = (sin(radians(off)) * cos(about), sin(radians(off)) * sin(about), -cos(radians(off)))
        state = SimpleNamespace(trunk_axes=np.array([front, (0.0,) * 3, (0.0,) * 3]).T)
        assert FaceDown("face_down", 60.0).met(None, state) == met


@pytest.mark.parametrize(
    ("ways", "said"),
    [
        ("[{parts:[0,2,7]}]", "behaviour.ways.0.parts: no part 7; valid: 0 to 4"),
        ("[{parts:[0,2,0]}]", "behaviour.ways.0.parts: a part comes once on a way"),
        ("[{parts:[0]},{parts:[1]}]", "behaviour.ways.0: must have a when"),
        (
            "[{parts:[0,2],when:{kind:face_down,angle:60}}]",
            "behaviour.ways.0: must have no when, as the last one",
        ),
        ("[{parts:[0,2]}]", "behaviour.ways: none leads through part 1"),
    ],
)
def test_ways_lead_through_all_parts_and_the_last_is_for_all_others(ways, said):
    with pytest.raises(InputError) as caught:
        load(["behaviour=get_up", f"behaviour.ways={ways}"])
    assert str(caught.value).startswith(said)
    assert "\n" not in str(caught.value)


def test_nothing_goes_between_parts_that_ways_number():
    with pytest.raises(InputError, match="ways numbers the parts") as caught:
        load(["behaviour=get_up", "behaviour.between=square"])
    assert "give null" in str(caught.value)


def test_a_later_part_of_a_way_does_not_begin_from_lying():
    ways = "[{parts:[3],when:{kind:face_down,angle:60}},{parts:[0,1,2,4]}]"
    with pytest.raises(InputError, match="behaviour.parts: 'press_up': press_up rolls about"):
        build(load(["behaviour=get_up", f"behaviour.ways={ways}"]))
