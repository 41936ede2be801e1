"""The ground."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from pydantic import ValidationError

from rotctl.mechanics import model as models
from rotctl.mechanics.terrain import Terrain

FLAT = Terrain(name="flat", kind="flat", friction=1.0)


def test_height_and_normal_agree_with_the_physics(world):
    """A ray straight down hits the ground at the height and on the slope it claims."""
    data = mujoco.MjData(world.mj)
    mujoco.mj_forward(world.mj, data)
    terrain, ground = world.model.terrain, world.mj.geom("ground").id
    for x, y in ((40.0, -7.0), (-3.0, 100.0)):
        hit = np.array([-1], dtype=np.int32)
        distance = mujoco.mj_ray(
            world.mj, data, np.array([x, y, 5.0]), np.array([0.0, 0, -1]), None, 1, -1, hit
        )
        assert hit[0] == ground
        assert 5.0 - distance == pytest.approx(terrain.height(x, y), abs=1e-12)
        normal = data.geom_xmat[ground].reshape(3, 3)[:, 2]
        assert terrain.normal(x, y) == pytest.approx(normal, abs=1e-12)


def test_kinds_are_named():
    with pytest.raises(ValidationError, match="Input should be 'flat'"):
        Terrain(name="x", kind="hills", friction=1.0)


def test_friction_must_be_positive():
    with pytest.raises(ValidationError, match="greater than 0"):
        Terrain(name="x", kind="flat", friction=0.0)


@pytest.mark.parametrize(("ground", "expected"), [(0.3, 1.0), (1.7, 1.7)])
def test_contacts_take_the_larger_friction(world, ground, expected):
    config = world.config
    model = models.build(
        replace(config.character, friction=1.0),
        replace(FLAT, friction=ground),
        config.physics,
        60.0,
    )
    data = mujoco.MjData(model.mj)
    mujoco.mj_forward(model.mj, data)
    data.qpos[2] -= 0.05
    mujoco.mj_forward(model.mj, data)
    ground = (model.mj.geom_bodyid[data.contact.geom] == 0).any(axis=1)
    assert ground.sum() >= 4  # both feet
    assert data.contact.friction[ground, :2] == pytest.approx(expected, abs=1e-12)
    assert (data.contact.dim[ground] == 3).all()
