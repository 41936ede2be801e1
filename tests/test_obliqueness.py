"""A roll about an oblique axis of the trunk: where that lies, and what comes of it."""

from math import cos, radians, sin

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.behaviours.rolling import obliqueness
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

OBLIQUE = [12.0, 5.0, -3.0, 2.0, 1.0]


def degrees_at(phase):
    waves = 1.0, cos(phase), sin(phase), cos(2 * phase), sin(2 * phase)
    return sum(a * b for a, b in zip(OBLIQUE, waves, strict=True))


@pytest.mark.parametrize("phase", [0.0, 1.0, 4.0, 40.0])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_axis_is_the_side_turned_towards_the_head(phase, side):
    axes = Rotation.from_euler("xyz", [0.3, 1.1, -0.4]).as_matrix()
    front, left, up = axes.T
    angle = radians(degrees_at(phase))
    expected = Rotation.from_rotvec(side * angle * front).apply(side * left)
    assert obliqueness.axis(side * left, up, OBLIQUE, phase) == pytest.approx(expected, abs=1e-12)
    assert obliqueness.axis(left, up, None, phase) is left


def rolled(*overrides):
    scenario = build(load(["behaviour=forward_roll", "behaviour.pace=null", *overrides]))
    buffer, _ = in_memory(scenario)
    return buffer.arrays()


def test_the_other_way_is_the_same_roll_in_a_mirror():
    left, right = (
        rolled("start=rest", "duration=0.5", f"+behaviour.oblique=[{angle}]") for angle in (20, -20)
    )
    a, b = left["trajectory/com"][:], right["trajectory/com"][:]
    assert np.abs(a[:, 1]).max() > 0.01
    assert np.abs(a * [1, -1, 1] - b).max() < 1e-6


@pytest.mark.parametrize("angle", [-15, 15])
def test_the_trunk_stays_as_oblique_as_it_is_asked_to(angle):
    log = rolled("duration=4", "seed=2001", f"+behaviour.oblique=[{angle}]")
    up = log["trajectory/trunk_axes"][:, :, 2]
    leaning = np.degrees(np.arcsin((up * log["command/axes"][:, 1]).sum(axis=1)))
    assert 0.5 < np.median(leaning) / angle < 1.2


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (
            ["+behaviour.oblique=[15,3]"],
            "behaviour.oblique: must be a mean with pairs of cosine and sine, not 2 numbers",
        ),
        (
            ["+behaviour.oblique=[90]"],
            "behaviour.oblique.0=90: must be less than or equal to 60",
        ),
        (
            ["behaviour=sideways_roll", "+behaviour.oblique=[15]"],
            "behaviour: an oblique axis lies between left or right and the head: roll_about=head "
            "has none",
        ),
        (
            ["excursion=root", "+behaviour.oblique=[15]"],
            "behaviour.oblique: excursion=root controls the root's angular velocity",
        ),
    ],
)
def test_what_makes_no_oblique_axis(overrides, message):
    with pytest.raises(InputError) as told:
        build(load(overrides))
    assert str(told.value) == message
