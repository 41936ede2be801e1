"""The adult's visual geoms only fill its outline."""

import mujoco
import numpy as np
import pytest

from rotctl.config import load
from rotctl.mechanics.model import build, lowest_and_highest


@pytest.fixture(scope="module")
def adult():
    config = load([])
    return build(config.character, config.terrain, config.physics, config.controller.rate).mj


def test_visual_geoms_weigh_and_touch_nothing(adult):
    visual = (adult.geom_bodyid > 0) & (adult.geom_contype == 0)
    assert visual.sum() > 20
    assert not adult.geom_conaffinity[visual].any()
    assert adult.body_subtreemass[1] == pytest.approx(70.0, abs=1e-9)
    paired = np.r_[adult.pair_geom1, adult.pair_geom2]
    assert not visual[paired].any()


def test_visual_geoms_do_not_make_the_adult_taller(adult):
    data = mujoco.MjData(adult)
    mujoco.mj_forward(adult, data)
    character = adult.geom_bodyid > 0
    solid = character & (adult.geom_contype > 0)
    assert lowest_and_highest(adult, data, character) == pytest.approx(
        lowest_and_highest(adult, data, solid), abs=1e-6
    )
