"""Jumps that turn about the upright, and what they are judged by."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.behaviours.aerial.flight import Flight
from rotctl.behaviours.facing import frame_of
from rotctl.config.loading import composed, load
from rotctl.config.schema import check
from rotctl.errors import InputError
from rotctl.metrics.criteria.flip import judge, longest_flight, turn
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.simulation.episode import Episode

PERIOD = 1 / 240


@pytest.fixture(scope="module")
def pirouettes():
    """Scenario and rows of a whole turn to the left, and of half a one to the right."""
    found = {}
    for target in (360.0, -180.0):
        config = load(
            [
                "behaviour=pirouette",
                f"behaviour.target_excursion={target}",
                "plant=varied",
                "seed=2000",
                "duration=5",
            ]
        )
        scenario = build(config)
        buffer, ending = in_memory(scenario)
        assert not ending
        found[target] = scenario, buffer.arrays()
    return found


@pytest.mark.parametrize("target", [360.0, -180.0])
def test_it_turns_as_far_as_it_should_and_stands(pirouettes, target):
    scenario, log = pirouettes[target]
    columns, reason = judge(log, scenario.config.criteria, target, PERIOD)
    assert reason == ""
    assert columns["revolved"] == pytest.approx(target, abs=15.0)
    assert columns["flight_time"] > 0.3


@pytest.mark.parametrize("target", [360.0, -180.0])
def test_most_of_the_turn_is_made_in_the_air(pirouettes, target):
    """By its momentum, which nothing changes there; swivelling feet would turn on the ground."""
    _, log = pirouettes[target]
    rows = slice(*longest_flight(log))
    momentum = log["trajectory/angular_momentum"][rows, 2]
    assert np.abs(momentum - momentum[0]).max() < 0.06 * abs(momentum[0])
    turned = turn(log, "up")[rows]
    assert (turned[-1] - turned[0]) / target > 0.6


@pytest.mark.parametrize("heading", [0.0, 70.0])
def test_turns_about_up_are_counted_from_the_heading(heading):
    frame = frame_of("left", heading, "up")
    for degrees in (-170.0, -30.0, 0.0, 90.0):
        axes = Rotation.from_euler("z", heading + degrees, degrees=True).as_matrix()
        assert frame.turned(axes) == pytest.approx(np.radians(degrees), abs=1e-12)
        assert frame.axis(axes) == pytest.approx([0.0, 0.0, 1.0])


def test_whole_turns_about_up_are_counted():
    yaw = np.linspace(0.0, -540.0, 400)
    axes = Rotation.from_euler("z", yaw[:, None], degrees=True).as_matrix()
    log = {"trajectory/trunk_axes": axes, "command/axes": np.tile(np.eye(3), (400, 1, 1))}
    assert turn(log, "up")[-1] == pytest.approx(-540.0, abs=1e-6)


def test_who_turns_about_up_stands():
    data = composed(["behaviour=pirouette"])
    data["behaviour"] = {**data["behaviour"], "roll_about": "head"}
    with pytest.raises(InputError, match="turn_about up needs roll_about left, not head"):
        check(data)


def test_a_wrong_turn_is_told(pirouettes):
    scenario, log = pirouettes[360.0]
    strict = replace(scenario.config.criteria, turn=0.001)
    assert judge(log, strict, 180.0, PERIOD)[1].endswith(" deg of 180")


@pytest.mark.parametrize(("turn", "opens"), [(180.0, 0.22), (-360.0, 0.22), (540.0, 0.44 / 3)])
def test_what_turns_further_opens_later(turn, opens):
    """As long before the landing as it takes to turn by the same angle."""
    config = load(["behaviour=pirouette"])
    (flight,) = (stage.flight for stage in config.behaviour.stages if stage.flight)
    assert flight.opened_for(np.radians(turn)) == pytest.approx(opens)
    assert replace(flight, opening_for=None).opened_for(np.radians(turn)) == 0.22


def test_one_and_a_half_turns_stay_folded_for_longer():
    """The law that flies them is told so."""
    held = {}
    for target in (360.0, 540.0):
        scenario = build(load(["behaviour=pirouette", f"behaviour.target_excursion={target}"]))
        (flight,) = (stage.flight for stage in scenario.config.behaviour.stages if stage.flight)
        frame = frame_of("left", 0.0, "up")
        law = Flight(flight, scenario.model, frame, np.radians(target), "flight")
        held[target] = law.tucking.held(0.15)
    assert held[360.0] < 1.0 == held[540.0]


def launched(seed, dropped=()):
    """Momentum about up at take-off [kg m2/s], without some of the launch's tasks."""
    words = ["behaviour=pirouette", "behaviour.target_excursion=540", "plant=varied"]
    config = load([*words, f"seed={seed}", "duration=2"])
    behaviour = config.behaviour
    stages = [
        replace(one, tasks={name: task for name, task in one.tasks.items() if name not in dropped})
        for one in behaviour.stages
    ]
    episode = Episode(build(replace(config, behaviour=replace(behaviour, stages=tuple(stages)))))
    moment = next(one for one in episode if one.signals.stage == 3)
    return float(moment.truth.momentum.angular[2])


def test_toes_that_slip_off_are_pressed_down_again():
    """What has lost the ground by a millimetre pushes the turn no further."""
    seeds = (2009, 2010, 2012, 2038)
    kept, lost = (np.mean([launched(s, dropped) for s in seeds]) for dropped in ((), ("toe",)))
    assert kept > lost + 0.4


@pytest.mark.parametrize("behaviour", ["pirouette", "pirouette_one_foot"])
@pytest.mark.parametrize("seed", [2005, 2032])
def test_a_foot_that_hovers_at_the_start_does_not_turn(behaviour, seed):
    """No contact is found under it for a tenth of a second, and nothing else holds it."""
    config = load([f"behaviour={behaviour}", "plant=varied", f"seed={seed}", "duration=1"])
    episode = Episode(build(config))
    feet = [episode.data.model.body(f"foot_{side}").id for side in "lr"]
    fronts = [episode.data.xmat[feet][:, (0, 3)].copy() for _ in islice(episode, 96)]
    yaw = np.degrees(np.unwrap([np.arctan2(one[:, 1], one[:, 0]) for one in fronts], axis=0))
    assert np.abs(yaw - yaw[0]).max() < 5.0


@pytest.mark.parametrize("seed", [2005, 2022])
def test_feet_that_have_landed_aslant_do_not_turn_under_who_stands(seed):
    """Pressed into the pose of standing they turn by 47 and 13 degrees in this second."""
    words = ["behaviour=pirouette", "behaviour.target_excursion=540", "plant=varied"]
    episode = Episode(build(load([*words, f"seed={seed}", "duration=4"])))
    feet = [episode.data.model.body(f"foot_{side}").id for side in "lr"]
    fronts = [episode.data.xmat[feet][:, (0, 3)].copy() for _ in islice(episode, 840)][600:]
    yaw = np.degrees(np.unwrap([np.arctan2(one[:, 1], one[:, 0]) for one in fronts], axis=0))
    assert np.ptp(yaw, axis=0).max() < 9.0
