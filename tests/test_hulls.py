"""Meshes that touch by their convex hulls."""

from dataclasses import replace
from itertools import product
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest
from test_adopt import BRICK, stl, text

from rotctl.adopting import adopt
from rotctl.adopting.meshes import outermost
from rotctl.behaviours import support
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.export.meshes import mesh_of
from rotctl.mechanics.bodies import lowest_and_highest
from rotctl.mechanics.character import Character
from rotctl.mechanics.hulls import hulls, places
from rotctl.report import shapes
from rotctl.report.prints import outlines
from rotctl.runs.run import make
from rotctl.runs.scenario import build
from rotctl.settings.checking import checked
from rotctl.settings.writing import to_dict

HULLS = "character={kind: mjcf, file: robot.xml, collision: hulls}"
FEET = ("foot_l", "foot_r")
SQUARE = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
FLAT = {"hull": SQUARE, "start": [0.5, 0.5, 0], "size": 0.5**0.5, "end": None}
BALL = "start and size must be the ball around its hull: [0.5, 0.5, 0] and 0.70711"


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    """A robot with bricks of 40, 10 and 6 cm for feet."""
    (tmp_path / "foot.stl").write_bytes(stl(BRICK))
    whole = text().replace(
        '<geom type="box" size="0.1 0.04 0.03" pos="0.05 0 -0.03" mass="1"/>',
        '<geom type="mesh" mesh="foot" pos="0 0 -0.06" mass="1"/>',
    )
    asset = '<asset><mesh name="foot" file="foot.stl"/></asset><worldbody>'
    (tmp_path / "robot.xml").write_text(whole.replace("<worldbody>", asset))
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def model(here):
    return build(load([HULLS])).model


def corners_of(model, data, name):
    body = model.mj.body(name).id
    (geom,) = (g for g in hulls(model.mj) if model.mj.geom_bodyid[g] == body)
    return places(model.mj, data, geom)


def test_a_brick_is_one_and_its_other_side_the_mirror_image(here, model):
    (foot,) = (b for b in adopt(here / "robot.xml", "mine", hulls=True).character["bodies"]
               if b["name"] == "foot")  # fmt: skip
    (geom,) = foot["geoms"]
    assert sorted(geom["hull"]) == sorted((BRICK - [0, 0, 0.06]).round(5).tolist())
    data = mujoco.MjData(model.mj)
    mujoco.mj_kinematics(model.mj, data)
    left, right = (corners_of(model, data, foot) for foot in FEET)
    assert sorted(map(tuple, left.round(5))) == sorted(map(tuple, (right * [1, -1, 1]).round(5)))
    solid = model.mj.geom_contype > 0
    assert lowest_and_highest(model.mj, data, solid)[0] == pytest.approx(0.0, abs=1e-5)


def test_it_rests_on_corners_where_mujoco_says_they_are(model):
    """Contacts of the engine against the corners that behaviours stand on."""
    mj, data = model.mj, mujoco.MjData(model.mj)
    data.qpos[:] = mj.qpos0
    data.qpos[2] -= 1e-3
    mujoco.mj_forward(mj, data)
    touched = {tuple(c.pos[:2].round(3)) for c in data.contact}
    sole = {(x, y) for x, y, z in corners_of(model, data, FEET[0]).round(3).tolist() if z < 0}
    assert sole <= touched
    stands = support.ends(model, data, [mj.body("foot_l").id])
    assert {(round(x, 3), round(y, 3)) for x, y in stands} == sole


def test_the_lowest_end_is_the_corner_that_touches(model):
    """Tilted to every side; the engine's contact is half way into the ground."""
    mj, data = model.mj, mujoco.MjData(model.mj)
    for axis in ([1, 1, 0], [-1, 1, 0], [1, -1, 0]):
        data.qpos[:] = mj.qpos0
        mujoco.mju_axisAngle2Quat(data.qpos[3:7], np.array(axis) / np.sqrt(2), 0.3)
        mujoco.mj_kinematics(mj, data)
        low = min(corners_of(model, data, name)[:, 2].min() for name in FEET)
        data.qpos[2] -= low + 1e-3
        mujoco.mj_forward(mj, data)
        (contact,) = (one for one in data.contact if 0 in mj.geom_bodyid[one.geom])
        body = int(mj.geom_bodyid[contact.geom].max())
        expected = contact.pos - [0.0, 0.0, 0.5e-3]
        assert support.lowest_end(model, data, body) == pytest.approx(expected, abs=1e-4)


def test_what_touches_nothing_has_no_lowest_end():
    seen = "<geom size='.1' contype='0' conaffinity='0'/>"
    mj = mujoco.MjModel.from_xml_string(
        f"<mujoco><worldbody><body name='ghost'><freejoint/>{seen}</body></worldbody></mujoco>"
    )
    with pytest.raises(InputError, match="^behaviour: ghost cannot bear the body$"):
        support.lowest_end(SimpleNamespace(mj=mj), mujoco.MjData(mj), 1)


def test_from_behind_it_is_outlined(model):
    """By the corners: the brick is 10 cm wide and 6 cm high."""
    data = mujoco.MjData(model.mj)
    mujoco.mj_kinematics(model.mj, data)
    found = outlines(model.mj, data)
    assert len(found) == (model.mj.geom_contype[model.mj.geom_bodyid > 0] > 0).sum()
    feet = [each for each in found if each[:, 1].min() < 1e-4]
    assert [np.ptp(each, axis=0).round(4).tolist() for each in feet] == [[0.1, 0.06]] * 2


def test_of_a_sole_of_many_corners_four_touch(here):
    """As docs/characters.md says: MuJoCo gives no more of a mesh with a plane, far apart."""
    ways = np.arange(12) * np.pi / 6
    ring = np.stack((0.2 * np.cos(ways), 0.05 * np.sin(ways)), axis=1)
    sole = [(x, y, z) for z in (-0.03, 0.03) for x, y in ring.tolist()]
    places = "".join("v {} {} {}\n".format(*place) for place in sole)
    (here / "foot.obj").write_text(places + "f 1 2 3\n")
    robot = here / "robot.xml"
    robot.write_text(robot.read_text().replace("foot.stl", "foot.obj"))
    model = build(load([HULLS])).model
    mj, data = model.mj, mujoco.MjData(model.mj)
    data.qpos[:] = mj.qpos0
    data.qpos[2] -= 1e-3
    mujoco.mj_forward(mj, data)
    corners = corners_of(model, data, FEET[0])
    low = corners[corners[:, 2] < corners[:, 2].min() + 1e-3]
    assert len(low) > 4
    foot = mj.body(FEET[0]).id
    touched = [c.pos[:2] for c in data.contact if foot in mj.geom_bodyid[c.geom]]
    assert 3 <= len(touched) <= 4
    gaps = [np.abs(low[:, :2] - place).max(axis=1).min() for place in touched]
    assert max(gaps) < 1e-3


@pytest.mark.parametrize("points", ["ball", "brick"])
def test_the_outermost_points_are_nearly_the_whole_hull(points):
    generator = np.random.default_rng(1)
    cloud = generator.normal(size=(3000, 3))
    if points == "ball":
        cloud /= np.linalg.norm(cloud, axis=1, keepdims=True)
    else:
        cloud = np.array(list(product((-1, 1), (-2, 2), (-3, 3))) + (cloud.clip(-1, 1)).tolist())
    kept = outermost(cloud)
    assert len(kept) <= 98
    ways = generator.normal(size=(500, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    reach, left = (cloud @ ways.T).max(axis=0), (kept @ ways.T).max(axis=0)
    assert ((reach - left) / np.ptp(cloud, axis=0).max()).max() < 0.05


def test_what_is_flat_has_the_corners_of_its_box():
    sheet = np.random.default_rng(2).uniform(size=(50, 3)) * [1.0, 0.5, 0.0]
    assert np.ptp(outermost(sheet), axis=0) == pytest.approx([1.0, 0.5, 1e-3], abs=0.1)
    assert outermost(sheet)[:, 2].max() > 0.0


def test_a_hull_without_an_inside_is_told():
    plain = to_dict(load([]))["character"]
    plain["bodies"][0]["geoms"][0].update(FLAT)
    with pytest.raises(InputError, match="^character: does not compile: .* coplanar vertices"):
        build(replace(load([]), character=checked(Character, plain)))


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"end": [0, 0, 1]}, "a hull has no end; leave it out"),
        ({"size": 0.1}, BALL),
        ({"start": [0, 0, 0]}, BALL),
    ],
)
def test_a_hull_with_what_has_no_effect_is_told(more, said):
    """Neither the ball nor an end moves anything: they may not say something else."""
    plain = to_dict(load([]))["character"]
    plain["bodies"][0]["geoms"][0].update(FLAT | more)
    with pytest.raises(InputError) as caught:
        checked(Character, plain)
    assert said in str(caught.value)


@pytest.mark.parametrize(
    "more", ["", "terrain=uneven", "disturbance=wind", "character.height=0.9", "terrain=pool"]
)
def test_it_moves_and_is_drawn_as_it_touches(here, more):
    config = load([HULLS, "behaviour=forward_roll_push", "duration=0.5", *filter(None, [more])])
    scenario = build(config)
    assert make(config).summary["duration"] == pytest.approx(0.5)
    mj = scenario.model.mj
    (hull, *_) = hulls(mj)
    drawn = np.array(shapes.triangles(mj, hull)).reshape(-1, 3)
    exported = mesh_of(mj, hull)
    assert len(np.unique(drawn.round(6), axis=0)) == 8
    middle = exported.vertices.mean(axis=0)
    assert ((exported.vertices - middle) * exported.normals).sum(axis=1).min() > 0, "outward"


def test_wind_pushes_what_faces_it(here):
    """Air from ahead on a still body: half the density times the faces of the boxes."""
    model = build(load([HULLS])).model
    from rotctl.mechanics.wind import Air

    data = mujoco.MjData(model.mj)
    mujoco.mj_forward(model.mj, data)
    wind = Air(model.mj, np.array([3.0, 0.0, 0.0]), 1.0)
    wind._geoms = list(hulls(model.mj))
    assert wind.apply(data, 1.0)[:3] == pytest.approx([2 * 9.0 * 0.1 * 0.06, 0, 0], abs=1e-6)
