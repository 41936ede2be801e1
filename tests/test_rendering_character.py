"""Visual geoms only fill a character's outline; cameras keep to its size."""

import mujoco
import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.mechanics.bodies import lowest_and_highest
from rotctl.mechanics.compilation import build
from rotctl.report import gl
from rotctl.report.scene import opened
from rotctl.runs import scenario
from rotctl.simulation.episode import Episode


@pytest.fixture(scope="module")
def adult():
    config = load([])
    model = build(config.character, config.terrain, config.physics, config.controller.rate)
    return mujoco.MjModel.from_xml_string(model.mjcf)


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


def test_a_camera_is_as_near_as_who_it_sees_is_small_and_sees_who_lies_from_above(drawing):
    cameras = {}
    for name in ("turn_over", "baby_roll_over", "forward_roll_1"):
        parts = scenario.build(load([f"behaviour={name}"]))
        start = Episode(parts).data.qpos
        with opened(parts.model.mj, gl.backend(), 64, 48) as stage:
            stage.fit(start[None])
            cameras[name] = stage.draw(start)[1]
    small, tall, tucked = (cameras[n] for n in ("baby_roll_over", "turn_over", "forward_roll_1"))
    assert 0.3 < small.distance / tall.distance < 0.6  # 0.74 of 1.75 m
    assert small.view.elevation == tall.view.elevation < 2.0 * tucked.view.elevation < 0.0
