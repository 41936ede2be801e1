"""The ground: its own account against rays cast in the physics, and starts upon it."""

import re
from dataclasses import replace

import mujoco
import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.config.schema import check
from rotctl.errors import InputError
from rotctl.log import RunLog
from rotctl.mechanics import compilation
from rotctl.mechanics.bodies import is_character
from rotctl.mechanics.terrain import FASTEST, Flat
from rotctl.report import stored_model
from rotctl.runs.run import LOG_NAME, in_memory, run
from rotctl.runs.scenario import build, model_of
from rotctl.settings.writing import to_dict
from rotctl.simulation.episode import Episode
from rotctl.simulation.loop import simulate

ENDLESS = ["flat", "incline", "decline"]
FINITE = ["uneven", "bumps", "stairs_down", "stairs_up", "obstacles"]
LONG = 40  # [s] so that a second field of hills is needed


@pytest.fixture(scope="module", params=[*ENDLESS, *FINITE])
def scenario(request):
    return build(load([f"terrain={request.param}", "seed=3", f"duration={LONG}"]))


def ray_down(scenario, x, y):
    """Height at which a ray from above meets the ground, and the model's data."""
    mj = scenario.model.mj
    data = mujoco.MjData(mj)
    data.qpos[:3] = [-5000.0, 0.0, 5000.0]  # the character out of the way
    data.qpos[3] = 1.0
    mujoco.mj_kinematics(mj, data)
    hit = np.array([-1], dtype=np.int32)
    down = np.array([0.0, 0.0, -1.0])
    distance = mujoco.mj_ray(mj, data, np.array([x, y, 40.0]), down, None, 1, -1, hit)
    assert distance >= 0.0
    assert mj.geom_bodyid[hit[0]] == 0
    return 40.0 - distance


def test_height_agrees_with_the_physics(scenario):
    """From one end to the other, and over the seam of two fields."""
    rng = np.random.default_rng(0)
    ground = scenario.model.ground
    everywhere = rng.uniform((-5.9, -5.9), (119.9, 5.9), (60, 2))
    seam = rng.uniform((59.7, -5.9), (60.3, 5.9), (20, 2))
    for x, y in (*everywhere, *seam):
        assert ground.height(x, y) == pytest.approx(ray_down(scenario, x, y), abs=1e-5)


def test_normals_are_unit_and_stand_on_the_slope(scenario):
    rng = np.random.default_rng(1)
    ground = scenario.model.ground
    edges = scenario.config.terrain.kind in ("stairs", "hazards")
    for x, y in rng.uniform((-3.0, -3.0), (80.0, 3.0), (40, 2)):
        normal = ground.normal(x, y)
        assert np.linalg.norm(normal) == pytest.approx(1.0, abs=1e-12)
        for axis, (dx, dy) in enumerate([(1e-7, 0.0), (0.0, 1e-7)]):
            if not edges:
                rise = ground.height(x + dx, y + dy) - ground.height(x - dx, y - dy)
                assert -normal[axis] / normal[2] == pytest.approx(rise / 2e-7, abs=1e-5)


def test_starts_touch_the_ground_and_do_not_sink_in(scenario):
    model, data = scenario.model, Episode(scenario).data
    mujoco.mj_forward(model.mj, data)
    solid = np.flatnonzero((model.mj.geom_bodyid[data.contact.geom] == 0).any(axis=1))
    assert (data.contact.dist[solid] > -0.005).all()
    data.qpos[2] -= 0.01
    mujoco.mj_forward(model.mj, data)
    assert (model.mj.geom_bodyid[data.contact.geom] == 0).any()


def test_uneven_ground_is_as_high_as_it_says_and_follows_the_seed():
    config = load(["terrain=uneven"])

    def ground(seed):
        return model_of(replace(config, seed=seed)).ground

    one = ground(1)
    assert np.ptp(one.other) == pytest.approx(0.10, abs=1e-12)
    assert (ground(1).first == one.first).all()
    assert (ground(2).first != one.first).any()
    behind = np.linspace(-6.0, 0.0, 50)
    assert not any(one.height(x, y) for x in behind for y in (-5.0, 0.0, 5.0))  # the run-in
    assert (one.first[:, 60:] == one.other[:, 60:]).all()
    assert (one.other[:, 0] == one.other[:, -1]).all()  # so that fields fit


def test_a_bump_at_a_field_s_end_goes_on_in_the_next():
    """As many bumps as there may be, so that some lie across the seam."""
    ground = build(load(["terrain=bumps", "terrain.bumps=5000", "seed=2"])).model.ground
    steepest = np.abs(np.diff(ground.other, axis=1)).max()
    assert (ground.other[:, 0] > 0.01).any()
    assert np.abs(ground.other[:, 1] - ground.other[:, -2]).max() <= 2.0 * steepest
    assert np.abs(ground.other[:, -1] - ground.other[:, -2]).max() <= steepest


@pytest.mark.parametrize("terrain", [*FINITE, "hazards"])
def test_a_seed_s_ground_is_the_same_for_any_duration(terrain):
    """A shorter run's ground is a longer one's begin, for the physics to the last bit."""
    config = load([f"terrain={terrain}", "seed=6"])
    short, long = (model_of(replace(config, duration=seconds)) for seconds in (6.0, 35.0))
    assert short.ground.extent.end < long.ground.extent.end
    for x, y in np.random.default_rng(3).uniform((-5.9, -5.9), (18.0, 5.9), (100, 2)):
        assert short.ground.height(x, y) == long.ground.height(x, y)
    if terrain == "hazards":
        assert short.ground.boxes == long.ground.boxes[: len(short.ground.boxes)]


@pytest.mark.parametrize("overrides", [["behaviour=uneven_terrain"], ["behaviour=stairs"]])
def test_a_longer_duration_changes_nothing_before(overrides):
    """What lies beyond changes no bit of the way there."""
    config, buffers = load([*overrides, "seed=4"]), []
    for seconds in (2.0, 60.0):
        scenario = build(replace(config, duration=seconds))
        buffers.append(simulate(scenario, 1.5, 64).buffer)
    for name, array in buffers[0].arrays().items():
        assert array.tobytes() == buffers[1].arrays()[name].tobytes(), name


# ---------------------------------------------------------------- the end of the world


@pytest.mark.parametrize("terrain", FINITE)
def test_it_reaches_as_far_as_the_fastest_roll(terrain):
    config = load([f"terrain={terrain}"])
    for seconds in (1.0, 100.0):
        extent = model_of(replace(config, duration=seconds)).ground.extent
        assert extent.end >= FASTEST * seconds
        assert extent.has(0.0, 0.0)
        assert not extent.has(extent.end + 0.01, 0.0)
        assert not extent.has(-6.01, 0.0)
        assert not extent.has(0.0, 6.01)
        assert not extent.has(0.0, -6.01)
        assert not extent.has(float("nan"), 0.0)


@pytest.mark.parametrize("terrain", ENDLESS)
def test_planes_have_no_end(terrain):
    extent = build(load([f"terrain={terrain}"])).model.ground.extent
    assert extent.has(-1e6, 0.0)
    assert extent.has(1e6, -1e6)


@pytest.mark.parametrize(
    ("overrides", "where"),
    [
        (
            ["terrain=uneven", "start.speed_y=[14,14]"],
            r"x = -?\d\.\d\d m, y = 6\.\d\d m: it reaches from x = -6 to 60 m",
        ),
        (
            ["terrain=stairs_down", "start.speed_x=[14,14]", "duration=1"],
            r"x = 3\.\d\d m, y = -?0\.\d\d m: it reaches from x = -6 to 3.4 m",
        ),
        (
            ["terrain=obstacles", "start.speed_x=[-14,-14]"],
            r"x = -6\.\d\d m, y = -?0\.\d\d m: it reaches from x = -6 to 61.5 m",
        ),
    ],
)
def test_a_run_ends_where_it_leaves_the_ground(overrides, where, tmp_path):
    """Thrown off at 14 m/s: a failure of the roll that says where, and the rows until then."""
    result = run(load(["seed=1", *overrides]), tmp_path)
    summary = result.summary
    reason = rf"left the ground at t = {summary['duration']:.2f} s, {where} and 6 m to either side"
    assert re.fullmatch(reason, summary["failure_reason"])
    assert not summary["success"]
    assert not result.broke_down
    log = RunLog.open(result.folder / LOG_NAME)
    assert log.events[-1][1] == summary["failure_reason"]
    extent = build(load(["seed=1", *overrides])).model.ground.extent
    assert all(extent.has(x, y) for x, y, _ in log["trajectory/com"])


def test_a_start_beside_the_ground_is_refused():
    state = "{place:[-9,0.5],gap:0.05,orientation:[1,0,0,0],velocity:[0,0,0],"
    start = f"+start.state={state}angular_velocity:[0,0,0],pose:{{}},speeds:{{}}}}"
    message = (
        r"start: begins beside the ground, at x = -9\.\d\d m, y = 0\.\d\d m: "
        "it reaches from x = -6 to 60 m and 6 m to either side"
    )
    with pytest.raises(InputError, match=message):
        in_memory(build(load(["terrain=uneven", "start=rest", start])))


def test_where_there_is_no_end_nothing_ends(tmp_path):
    result = run(load(["seed=1", "start.speed_y=[14,14]", "duration=1"]), tmp_path)
    assert "left" not in result.summary["failure_reason"]
    assert result.summary["duration"] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (
            ["terrain=hazards", "duration=60"],
            "terrain.boxes=14: hazards would have 45 loose boxes to x = 180 m, where a run of "
            "this duration may come, at most 30 can be; choose a shorter duration or a larger "
            "spacing",
        ),
        (
            ["terrain=stairs_up", "terrain.tread=0.1", "duration=3600"],
            "terrain.tread=0.1: stairs_up would be 107990 steps to x = 10800 m, where a run of "
            "this duration may come, at most 18000 can be; choose a shorter duration or a longer "
            "tread",
        ),
        (
            ["terrain=obstacles", "terrain.spacing=0.2", "duration=3600"],
            "terrain.spacing=0.2: obstacles would be 53993 things to x = 10800 m, where a run of "
            "this duration may come, at most 18000 can be; choose a shorter duration or a larger "
            "spacing",
        ),
    ],
)
def test_a_world_that_is_too_long_is_refused(overrides, message):
    with pytest.raises(InputError) as error:
        build(load(overrides))
    assert str(error.value) == message


@pytest.mark.parametrize(("terrain", "megabytes"), [("uneven", 1), ("stairs_down", 3)])
def test_an_hour_of_it_is_a_model_that_a_log_can_hold(terrain, megabytes):
    model = model_of(load([f"terrain={terrain}", "duration=3600"]))
    assert model.ground.extent.end >= 10_800
    assert model.mj.nhfield == (2 if terrain == "uneven" else 0)
    assert len(model.mjcf) < megabytes * 1_000_000
    assert stored_model.checked(model.mjcf)


def test_the_command_follows_the_slope():
    for terrain, angle in (("incline", 6.0), ("decline", -6.0), ("flat", 0.0)):
        scenario = build(load([f"terrain={terrain}"]))
        velocity = scenario.behaviour._velocities[0]
        assert np.degrees(np.arctan2(velocity[2], velocity[0])) == pytest.approx(angle)
        assert np.linalg.norm(velocity) == pytest.approx(1.2)
    level = build(load(["terrain=decline", "behaviour.align_with_slope=false"]))
    assert level.behaviour._velocities[0].tolist() == [1.2, 0.0, 0.0]


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


# ---------------------------------------------------------------- friction


@pytest.mark.parametrize("friction", [0.3, 1.7])
@pytest.mark.parametrize("physics", ["mujoco", "lockstep"])
def test_contacts_have_the_ground_s_friction(physics, friction):
    """Of two the larger counts, so that the character has the same."""
    config = load([f"physics={physics}"])
    flat = Flat(name="flat", kind="flat", friction=friction)
    model = compilation.build(config.character, flat, config.physics, 60.0)
    data = mujoco.MjData(model.mj)
    mujoco.mj_forward(model.mj, data)
    data.qpos[2] -= 0.05
    mujoco.mj_forward(model.mj, data)
    touching = (model.mj.geom_bodyid[data.contact.geom] == 0).any(axis=1)
    assert touching.sum() >= 4  # both feet
    assert data.contact.friction[touching, :2] == pytest.approx(friction, abs=1e-12)
    assert (data.contact.dim[touching] == 3).all()
    assert (model.mj.geom_friction == [friction, 0.0, 0.0]).all()


def test_a_limp_body_slides_as_coulomb_says():
    """On its back, from 4 m/s: slowed down by mu g."""
    for friction in (0.1, 0.2, 0.4):
        model = build(load([f"terrain.friction={friction}"])).model
        data = mujoco.MjData(model.mj)
        data.qpos[3:7] = [np.sqrt(0.5), 0.0, -np.sqrt(0.5), 0.0]
        data.qpos[2] = 0.12
        data.qvel[0] = 4.0
        speeds = []
        for _ in range(2):
            mujoco.mj_step(model.mj, data, 60)
            mujoco.mj_subtreeVel(model.mj, data)
            speeds.append(data.subtree_linvel[1, 0])
        assert speeds[0] - speeds[1] == pytest.approx(friction * 9.81 * 0.25, rel=0.1)


@pytest.mark.parametrize("terrain", ["incline", "uneven", "stairs_down", "hazards"])
def test_every_ground_has_its_friction(terrain):
    """And so has a loose box, on the ground and under a body."""
    model = build(load([f"terrain={terrain}", "terrain.friction=0.3", "seed=1"])).model
    data, bodies = mujoco.MjData(model.mj), set()
    boxes = np.arange(model.angles.stop, model.mj.nq, 7)
    mujoco.mj_forward(model.mj, data)
    if len(boxes):
        data.qpos[boxes[0] : boxes[0] + 3] = data.qpos[:3] - [0.0, 0.0, 0.9]
    for _ in range(40):
        mujoco.mj_step(model.mj, data, 10)
        touching = model.mj.geom_bodyid[data.contact.geom]
        outside = ~is_character(model.mj)[touching].all(axis=1)
        bodies |= set(touching[outside].ravel().tolist())
        assert data.contact.friction[outside, :2] == pytest.approx(0.3, abs=1e-12)
    own = set(np.flatnonzero(is_character(model.mj)).tolist())
    assert bodies & own
    assert bool(bodies - own - {0}) == bool(len(boxes))
