"""The ground: its own account against rays cast in the physics, and starts upon it."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from rotctl.config import check, load, to_dict
from rotctl.errors import InputError
from rotctl.mechanics import model as models
from rotctl.mechanics.terrain import Flat
from rotctl.scenario import build
from rotctl.simulation.start import place

KINDS = ["flat", "incline", "decline", "uneven", "bumps", "stairs_down", "stairs_up", "obstacles"]


@pytest.fixture(scope="module", params=KINDS)
def scenario(request):
    return build(load([f"terrain={request.param}", "seed=3"]))


def ray_down(scenario, x, y):
    """Height at which a ray from above meets the ground, and the model's data."""
    mj = scenario.model.mj
    data = mujoco.MjData(mj)
    data.qpos[:3] = [-500.0, 0.0, 500.0]  # the character out of the way
    data.qpos[3] = 1.0
    mujoco.mj_kinematics(mj, data)
    hit = np.array([-1], dtype=np.int32)
    down = np.array([0.0, 0.0, -1.0])
    distance = mujoco.mj_ray(mj, data, np.array([x, y, 40.0]), down, None, 1, -1, hit)
    assert mj.geom_bodyid[hit[0]] == 0
    return 40.0 - distance


def test_height_agrees_with_the_physics(scenario):
    rng = np.random.default_rng(0)
    ground = scenario.model.ground
    for x, y in rng.uniform((-3.0, -3.0), (25.0, 3.0), (60, 2)):
        assert ground.height(x, y) == pytest.approx(ray_down(scenario, x, y), abs=2e-3)


def test_normals_are_unit_and_stand_on_the_slope(scenario):
    rng = np.random.default_rng(1)
    ground = scenario.model.ground
    edges = scenario.config.terrain.kind in ("stairs", "hazards")
    for x, y in rng.uniform((-3.0, -3.0), (25.0, 3.0), (20, 2)):
        normal = ground.normal(x, y)
        assert np.linalg.norm(normal) == pytest.approx(1.0, abs=1e-12)
        if not edges:
            rise = (ground.height(x + 0.05, y) - ground.height(x - 0.05, y)) / 0.1
            assert -normal[0] / normal[2] == pytest.approx(rise, abs=1e-6)


def test_starts_touch_the_ground_and_do_not_sink_in(scenario):
    model = scenario.model
    data = mujoco.MjData(model.mj)
    place(
        model,
        data,
        scenario.start,
        scenario.behaviour.orientation,
        scenario.behaviour.pose(scenario.start.pitch),
    )
    mujoco.mj_forward(model.mj, data)
    solid = np.flatnonzero((model.mj.geom_bodyid[data.contact.geom] == 0).any(axis=1))
    assert (data.contact.dist[solid] > -0.005).all()
    data.qpos[2] -= 0.01
    mujoco.mj_forward(model.mj, data)
    assert (model.mj.geom_bodyid[data.contact.geom] == 0).any()


def test_uneven_ground_is_as_high_as_it_says_and_follows_the_seed():
    def heights(seed):
        return build(load(["terrain=uneven", f"seed={seed}"])).model.ground.heights

    first = heights(1)
    assert np.ptp(first) <= 0.10 + 1e-9
    assert np.ptp(first) > 0.08
    assert (heights(1) == first).all()
    assert (heights(2) != first).any()
    assert not first[:, :40].any()  # level before the run-in


def test_the_command_follows_the_slope():
    for terrain, angle in (("incline", 6.0), ("decline", -6.0), ("flat", 0.0)):
        scenario = build(load([f"terrain={terrain}"]))
        velocity = scenario.behaviour._velocity
        assert np.degrees(np.arctan2(velocity[2], velocity[0])) == pytest.approx(angle)
        assert np.linalg.norm(velocity) == pytest.approx(1.2)
    level = build(load(["terrain=decline", "behaviour.align_with_slope=false"]))
    assert level.behaviour._velocity.tolist() == [1.2, 0.0, 0.0]


def test_rows_bring_their_terrain_and_a_choice_overrides_it():
    config = load(["behaviour=decline"])
    assert (config.terrain.name, config.criteria.name) == ("decline", "terrain")
    assert load(["behaviour=decline", "terrain=flat"]).terrain.name == "flat"


def test_the_log_s_model_has_the_ground_in_it():
    mjcf = build(load(["terrain=uneven", "seed=4"])).model.mjcf
    scenario = build(load(["terrain=uneven", "seed=4"]))
    again = mujoco.MjModel.from_xml_string(mjcf)
    assert again.hfield_data == pytest.approx(scenario.model.mj.hfield_data, abs=1e-3)


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (["terrain=incline", "terrain.angle=80"], "terrain.angle=80: must be less than"),
        (["terrain=stairs_up", "terrain.riser=-1"], "terrain.riser=-1: must be greater than 0"),
        (["terrain=uneven", "terrain.wavelength=0.1"], "terrain.wavelength=0.1: must be"),
    ],
)
def test_bad_numbers_are_named(overrides, message):
    with pytest.raises(InputError) as error:
        load(overrides)
    assert str(error.value).startswith(message)


def test_unknown_kinds_are_named():
    data = to_dict(load([]))
    data["terrain"]["kind"] = "swamp"
    with pytest.raises(InputError, match="flat.*slope.*stairs.*uneven"):
        check(data)


@pytest.mark.parametrize(("ground", "expected"), [(0.3, 1.0), (1.7, 1.7)])
def test_contacts_take_the_larger_friction(world, ground, expected):
    config = world.config
    flat = Flat(name="flat", kind="flat", friction=ground)
    character = replace(config.character, friction=1.0)
    model = models.build(character, flat, config.physics, 60.0)
    data = mujoco.MjData(model.mj)
    mujoco.mj_forward(model.mj, data)
    data.qpos[2] -= 0.05
    mujoco.mj_forward(model.mj, data)
    touching = (model.mj.geom_bodyid[data.contact.geom] == 0).any(axis=1)
    assert touching.sum() >= 4  # both feet
    assert data.contact.friction[touching, :2] == pytest.approx(expected, abs=1e-12)
    assert (data.contact.dim[touching] == 3).all()
