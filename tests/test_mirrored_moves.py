"""A move the other way, from the mirror image of a start, is the mirror image of the move.

Nothing of a law may know left from right: what one side does better is in the draws alone.
"""

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.motion.sides import other_side, sign_of
from rotctl.runs.scenario import build
from rotctl.simulation.episode import Episode

ACROSS = np.array([1.0, -1.0, 1.0])  # of a vector, in a mirror along the way
ABOUT = -ACROSS  # of a turn


def mirrored(model, position, velocity):
    names = model.joint_names
    others = [names.index(other_side(name)) for name in names]
    signs = np.array([sign_of(model, motor) for motor in range(len(names))])
    position, velocity = position.copy(), velocity.copy()
    position[:3] *= ACROSS
    position[4:7] *= ABOUT
    velocity[:3] *= ACROSS
    velocity[3:6] *= ABOUT
    position[model.angles] = (signs * position[model.angles])[others]
    velocity[model.joints] = (signs * velocity[model.joints])[others]
    return position, velocity


@pytest.mark.parametrize(
    ("behaviour", "target", "seconds"),
    [
        ("pirouette", 540.0, 2.2),  # it has landed by then
        ("pirouette_one_foot", 360.0, 2.6),  # and turns on its foot
        ("cartwheel", -360.0, 1.6),  # and tips over its foot
    ],
)
def test_to_the_other_side_it_is_the_mirror_image(behaviour, target, seconds):
    """To what rounding has grown to by then: bodies that tip double it every fifth of a second."""
    runs = []
    for goal in (target, -target):
        config = load(
            [
                f"behaviour={behaviour}",
                f"behaviour.target_excursion={goal}",
                "behaviour.heading=0",
                "seed=2001",
                f"duration={seconds}",
            ]
        )
        runs.append(Episode(build(config)))
    one, other = runs
    model = build(config).model
    data = other.data
    data.qpos[:], data.qvel[:] = mirrored(model, one.data.qpos, one.data.qvel)
    for _ in range(round(seconds * config.controller.rate)):
        here, there = one.step(), other.step()
        assert here.signals.stage == there.signals.stage
    position, velocity = mirrored(model, here.truth.position, here.truth.velocity)
    assert there.signals.stage >= 3
    assert np.abs(position - there.truth.position).max() < 1e-5
    assert np.abs(velocity - there.truth.velocity).max() < 1e-3
