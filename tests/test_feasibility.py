"""Turns that no launch gives are refused; what is refused really falls short."""

from math import radians

import pytest
from flights import HEAD_FIRST, flier, fly

from rotctl.behaviours.aerial.feasibility import GONE
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.runs.scenario import build

KEY = "behaviour.target_excursion"
MOST = 48.0  # [kg m2/s] of the dives' launches


def refusal(*overrides):
    with pytest.raises(InputError) as caught:
        build(load(list(overrides)))
    return str(caught.value)


@pytest.mark.parametrize(
    ("behaviour", "target", "height", "said"),
    [
        (
            "dive_backward",
            -1260,
            10,
            "to turn so far in 1.67 s asks for 51 kg m2/s in the tightest shape, and the push "
            "gives at most 48; -900 is possible here",
        ),
        (
            "dive_backward",
            -540,
            1,
            "to turn so far in 0.73 s asks for 61 kg m2/s in the tightest shape, and the push "
            "gives at most 48; -180 is possible here",
        ),
        (
            "dive_forward",
            1260,
            10,
            "to turn so far in 1.79 s asks for 47 kg m2/s in the tightest shape, and the push "
            "gives at most 43; 900 is possible here",
        ),
        (
            "dive_forward",
            360,
            10,
            "it would not come down on its forearm; half a turn less or more: 180 or 540",
        ),
    ],
)
def test_a_dive_that_no_body_makes_is_refused(behaviour, target, height, said):
    dive = (f"behaviour={behaviour}", f"{KEY}={target}", f"terrain.height={height}")
    assert refusal(*dive) == f"{KEY}={target}: {said}"


def test_so_is_a_flip_that_ends_on_the_head_or_turns_twice():
    assert refusal("behaviour=back_flip", f"{KEY}=-180") == (
        f"{KEY}=-180: it would not come down on its foot; half a turn less or more: -360"
    )
    assert "; -360 is possible here" in refusal("behaviour=back_flip", f"{KEY}=-720")


@pytest.mark.parametrize(
    ("behaviour", "target", "way", "instead"),
    [
        ("front_flip", -360, "forward", 360),
        ("back_flip", 360, "backward", -360),
        ("back_flip", 0, "backward", -360),
    ],
)
def test_a_somersault_turns_the_way_that_it_takes_off(behaviour, target, way, instead):
    assert refusal(f"behaviour={behaviour}", f"{KEY}={target}") == (
        f"{KEY}={target}: this take-off goes {way} and can only turn {way}; give {instead}"
    )
    build(load([f"behaviour={behaviour}", f"{KEY}={instead}"]))


def test_a_reverse_dive_is_none():
    build(load(["behaviour=dive_forward", f"{KEY}=-540"]))


@pytest.mark.parametrize("terrain", ["flat", "stairs_down"])
@pytest.mark.parametrize("behaviour", ["dive_forward", "dive_backward"])
def test_a_dive_needs_water(behaviour, terrain):
    assert refusal(f"behaviour={behaviour}", f"terrain={terrain}") == (
        "behaviour.stages.4.until: this behaviour dives, and here is no water; choose terrain=pool"
    )


def test_shapes_that_are_not_there_are_told():
    said = "behaviour.shape=ball: no such shape; valid: tuck"
    assert refusal("behaviour=back_flip", "behaviour.shape=ball").startswith(said)
    assert "nothing flies here" in refusal("behaviour=stand", "+behaviour.shape=pike")


@pytest.mark.parametrize(("turns", "short"), [(3.5, True), (2.5, False)])
def test_what_is_refused_falls_short_in_the_air(turns, short):
    """Of 10 m, with all that legs give, turned already as far as is allowed for."""
    landed = fly(flier(turns, HEAD_FIRST), MOST, height=11.05, up=2.2, pitch=GONE)
    assert landed.error < -20.0 if short else abs(landed.error) < 5.0


def test_the_longer_the_shape_the_more_momentum_it_asks_for():
    """Of one and a half turns from 10 m, in 1.7 s; straight it is refused."""
    dive = ("behaviour=dive_forward", f"{KEY}=540")
    tuck, pike = (
        build(load([*dive, f"behaviour.shape={shape}"])).behaviour._laws["flight"]
        for shape in ("tuck", "pike")
    )
    turns = radians(540.0)
    assert 1.2 < pike.least_momentum(turns, GONE, 1.7) / tuck.least_momentum(turns, GONE, 1.7) < 3.0
    assert "180 is possible here" in refusal(*dive, "behaviour.shape=straight")


@pytest.mark.parametrize(
    ("behaviour", "turn", "valid"),
    [("cartwheel", 90, "-360 or 360"), ("front_aerial", -360, "360"), ("handstand", 360, "0")],
)
def test_a_motion_of_one_turn_is_no_other(behaviour, turn, valid):
    with pytest.raises(InputError) as caught:
        load([f"behaviour={behaviour}", f"behaviour.target_excursion={turn}"])
    assert str(caught.value) == (
        f"behaviour.target_excursion={turn}: {behaviour} is a motion of {valid} deg"
    )
