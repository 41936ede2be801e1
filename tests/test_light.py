"""Water in pictures: the sky is seen through it, not in its place."""

import mujoco
import numpy as np
import pytest

from rotctl.report import light

WORLD = "<mujoco><worldbody>{}</worldbody></mujoco>"
WATER = '<geom type="box" size="1 1 1" contype="0" conaffinity="0" rgba="0 0 1 0.55"/>'
STONE = '<geom type="box" size="1 1 1"/>'


def test_light_goes_in_at_a_face_of_the_water_and_out_at_another():
    stone, both = (
        mujoco.MjModel.from_xml_string(WORLD.format(geoms)) for geoms in (STONE, STONE + WATER)
    )
    assert light.clear(stone) == 0.0
    assert light.clear(both) == pytest.approx(0.45**2)


def test_the_sky_shines_through_what_is_clear_and_nothing_solid():
    """Four pixels: sky, water before the sky, water before its bottom, stone."""
    picture = np.uint8([[[0, 0, 0], [10, 40, 80], [30, 90, 120], [90, 90, 90]]])
    sky, far = np.full_like(picture, 200), np.array([[True, True, False, False]])
    seen = light.before_sky(picture, far, sky, 0.2)
    assert seen[0].tolist() == [[200, 200, 200], [50, 80, 120], [30, 90, 120], [90, 90, 90]]


def test_where_nothing_is_clear_what_is_far_is_the_sky():
    picture = np.uint8([[[0, 0, 0], [1, 1, 1], [90, 90, 90]]])
    sky, far = np.full_like(picture, 200), np.array([[True, True, False]])
    seen = light.before_sky(picture, far, sky, 0.0)
    assert seen[0].tolist() == [[200, 200, 200], [200, 200, 200], [90, 90, 90]]


def test_what_is_bright_stays_within_a_byte():
    picture, sky = np.full((1, 1, 3), 220, np.uint8), np.full((1, 1, 3), 250, np.uint8)
    assert light.before_sky(picture, np.array([[True]]), sky, 0.9)[0, 0].tolist() == [255] * 3
