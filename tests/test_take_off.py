"""Flips at a commanded speed of take-off, and speeds that are none."""

import pytest

from rotctl.behaviours.aerial.launch import Launch
from rotctl.behaviours.staged.take_off import at_speed
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.metrics.criteria.flip import judge
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build


def launching(behaviour):
    stages = load([f"behaviour={behaviour}"]).behaviour.stages
    return next(stage for stage in stages if stage.name == "launch")


@pytest.mark.parametrize("behaviour", ["back_flip", "front_flip", "pirouette", "dive_forward"])
def test_a_launch_without_a_command_and_at_its_own_speed_is_itself(behaviour):
    stage = launching(behaviour)
    assert at_speed(stage, None) is stage
    assert at_speed(stage, stage.until.up) == stage


def test_a_command_moves_what_the_push_aims_at_as_well():
    stage = launching("back_flip")
    faster = at_speed(stage, 2.0 * stage.until.up)
    before, after = (
        next(t.aim for t in s.tasks.values() if isinstance(t.aim, Launch)) for s in (stage, faster)
    )
    assert faster.until.up == 2.0 * stage.until.up
    assert after.up == pytest.approx(2.0 * before.up)
    assert (after.forward, after.height) == (before.forward, before.height)


def test_faster_is_faster():
    """And one of the two stands at least; nearly all do."""
    took_off, stood = [], 0
    for speed in (2.7, 3.0):
        words = ["behaviour=back_flip", f"behaviour.take_off={speed}", "seed=2001", "duration=5"]
        config = load(words)
        log = in_memory(build(config))[0].arrays()
        columns, reason = judge(log, config.criteria, -360.0, 1 / 240)
        took_off.append(columns["take_off_speed"])
        stood += not reason
    assert took_off == pytest.approx([2.7, 2.92], abs=0.1)
    assert stood >= 1


@pytest.mark.parametrize(
    ("behaviour", "speed", "said"),
    [
        (
            "back_flip",
            1.6,
            "behaviour.target_excursion=-360: to turn so far in 0.41 s asks for 59 kg m2/s in the "
            "tightest shape, and the push gives at most 50; with behaviour.take_off=1.9 it is "
            "possible here",
        ),
        (
            "front_flip",
            2.0,
            "behaviour.target_excursion=360: to turn so far in 0.44 s asks for 59 kg m2/s in the "
            "tightest shape, and the push gives at most 50; with behaviour.take_off=2.3 it is "
            "possible here",
        ),
        (
            "front_flip",
            4.0,
            "behaviour.take_off=4: legs give no more than at 3.7 m/s; give that or less",
        ),
        ("back_flip", 0.0, "behaviour.take_off=0.0: must be greater than 0"),
        ("stand", 3.0, "behaviour.take_off=3: no stage ends as it is launched"),
    ],
)
def test_speeds_that_are_none_are_refused(behaviour, speed, said):
    new = "+" if behaviour == "stand" else ""
    with pytest.raises(InputError) as caught:
        build(load([f"behaviour={behaviour}", f"{new}behaviour.take_off={speed}"]))
    assert str(caught.value) == said


def test_what_is_told_to_be_possible_is():
    for behaviour, speed in (("back_flip", 1.9), ("front_flip", 2.3)):
        build(load([f"behaviour={behaviour}", f"behaviour.take_off={speed}"]))


def test_no_speed_is_told_that_would_be_refused():
    far = load(["behaviour=front_flip", "behaviour.target_excursion=720", "behaviour.take_off=1"])
    with pytest.raises(InputError, match="gives at most 50; no turn is possible here$"):
        build(far)


def test_a_launch_without_a_measured_most_takes_no_speed():
    with pytest.raises(InputError) as caught:
        build(load(["behaviour=dive_forward", "+behaviour.take_off=9"]))
    assert str(caught.value) == "behaviour.take_off=9: this launch has its own speed alone"
