"""Steps: the support against other geometry, where a foot goes, and who stands by them."""

from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from rotctl.behaviours import support
from rotctl.behaviours.scene import Step
from rotctl.behaviours.staged.attitudes import Upright
from rotctl.behaviours.standing.footholds import capture_point, landing
from rotctl.behaviours.standing.swing_foot import chosen
from rotctl.behaviours.standing.swinging import arrival
from rotctl.config.loading import load
from rotctl.control.kinds import kind
from rotctl.control.task import task
from rotctl.mechanics.state import read
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.runs.summary import summarise
from rotctl.simulation.placing import place


@pytest.fixture(scope="module")
def scenario():
    return build(load(["behaviour=stand_step", "seed=2000"]))


@pytest.fixture
def standing(scenario):
    """Data of a standing character that does not move."""
    model, behaviour = scenario.model, scenario.behaviour
    data = mujoco.MjData(model.mj)
    place(model, data, scenario.start, behaviour.start(0.0), behaviour.axes)
    return data


def law(scenario):
    return scenario.config.behaviour.tasks["swing"].aim


def feet(scenario):
    return [scenario.model.mj.body(name).id for name in ("foot_l", "foot_r")]


def scene_of(scenario, data, velocity=(0.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0), step=None):
    """A character that moves as one piece, with a velocity of its centre of mass and a spin."""
    mj = scenario.model.mj
    mujoco.mj_forward(mj, data)
    arm = data.qpos[:3] - data.subtree_com[1]
    data.qvel[:] = 0.0
    data.qvel[:3] = velocity + np.cross(spin, arm)
    data.qvel[3:6] = data.xmat[1].reshape(3, 3).T @ spin
    mujoco.mj_forward(mj, data)
    state = read(scenario.model, data)
    return SimpleNamespace(model=scenario.model, state=state, step=step or Step())


# ---------------------------------------------------------------- the support


@pytest.mark.parametrize("seed", range(20))
def test_how_far_a_point_is_outside_is_that_of_another_hull(seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(8, 2))
    corners = support.hull([tuple(p) for p in points])
    hull = ConvexHull(points)
    assert len(corners) == len(hull.vertices)
    for point in rng.normal(size=(20, 2)) * 2.0:
        truth = (hull.equations[:, :2] @ point + hull.equations[:, 2]).max()
        assert support.outside(corners, tuple(point)) == pytest.approx(truth, abs=1e-12)


def test_a_foot_is_lifted_once_all_of_it_is_clear(scenario, standing):
    left, _ = feet(scenario)
    state = scene_of(scenario, standing).state
    assert not support.lifted(scenario.model, state, left)
    for up, clear in ((0.028, False), (0.034, True)):
        data = mujoco.MjData(scenario.model.mj)
        data.qpos[:] = standing.qpos
        data.qpos[2] += up
        found = scene_of(scenario, data).state
        gap = min(
            mujoco.mj_geomDistance(scenario.model.mj, data, 0, geom, 1.0, None)
            for geom in np.flatnonzero(scenario.model.mj.geom_bodyid == left)
            if scenario.model.mj.geom_contype[geom]
        )
        assert (gap > support.CLEAR) == clear
        assert support.lifted(scenario.model, found, left) == clear


# ---------------------------------------------------------------- where the foot goes


def test_the_body_comes_to_rest_over_its_capture_point(scenario, standing):
    """A pendulum of constant height whose angular momentum a short moment takes away, pressed at
    the capture point from then on, stops there."""
    scene = scene_of(scenario, standing, (0.3, -0.2, 0.0), (0.4, 0.9, 0.0))
    momentum, mass = scene.state.momentum, scenario.model.mass
    x, y = capture_point(law(scenario), scene)
    height = momentum.com[2]
    rate2 = 9.81 / height
    brief = 1e-6

    def rates(t, s):
        taken = -momentum.angular / brief if t < brief else np.zeros(3)
        # About the centre of mass: dH/dt = (p - c) x f, with f up m g and p on the ground.
        ax = rate2 * (s[0] - x) - taken[1] / (mass * height)
        ay = rate2 * (s[1] - y) + taken[0] / (mass * height)
        return [s[2], s[3], ax, ay]

    first = [*momentum.com[:2], *momentum.com_velocity[:2]]
    early = solve_ivp(rates, (0.0, brief), first, rtol=1e-10, atol=1e-12)
    end = solve_ivp(rates, (brief, 1.5), early.y[:, -1], rtol=1e-10, atol=1e-12).y[:, -1]
    assert end[:2] == pytest.approx([x, y], abs=3e-3)
    assert end[2:] == pytest.approx([0.0, 0.0], abs=1e-2)


def test_the_foot_goes_where_the_point_will_be_and_a_little_further(scenario, standing):
    """The point runs away from the pressure under the other foot, by its equation of motion."""
    left, right = feet(scenario)
    scene = scene_of(scenario, standing, (0.9, 0.1, 0.0), step=Step(left, right, 0.0))
    data, aim = standing, law(scenario)
    ends = support.ends(scenario.model, data, [right])
    pressure = support.within(
        support.hull(ends), support.middle(ends), capture_point(aim, scene), 0
    )
    rate = np.sqrt(9.81 / scene.state.momentum.com[2])
    run = solve_ivp(
        lambda t, xi: rate * (xi - np.array(pressure)),
        (0.0, 0.12),
        capture_point(aim, scene),
        rtol=1e-10,
    )
    middle = np.array(support.middle(ends))
    way = run.y[:, -1] - middle
    goal = middle + way * (1.0 + aim.over / np.linalg.norm(way))
    assert landing(aim, scene, scene.step, 0.12) == pytest.approx(tuple(goal), abs=1e-6)


@pytest.mark.parametrize("side", [0, 1], ids=["left", "right"])
@pytest.mark.parametrize("heading", [0.0, 1.3, -2.8])
@pytest.mark.parametrize("seed", range(5))
def test_legs_do_not_cross_and_no_foot_goes_further_than_legs_reach(
    scenario, standing, side, heading, seed
):
    swing, stance = feet(scenario)[:: 1 - 2 * side]
    turn = np.array([np.cos(heading / 2), 0.0, 0.0, np.sin(heading / 2)])
    mujoco.mju_mulQuat(standing.qpos[3:7], turn, standing.qpos[3:7].copy())
    velocity = np.append(np.random.default_rng(seed).normal(size=2) * 1.5, 0.0)
    scene = scene_of(scenario, standing, velocity, step=Step(swing, stance, 0.0))
    aim, data = law(scenario), standing
    at = np.array(landing(aim, scene, scene.step, 0.1))
    middle = np.array(support.middle(support.ends(scenario.model, data, [stance])))
    outward = np.array([-np.sin(heading), np.cos(heading)]) * (1 - 2 * side)
    far = np.linalg.norm(at - middle)
    assert far <= np.hypot(aim.reach, aim.width) + 1e-9
    assert (at - middle) @ outward >= aim.width - 0.01  # the pelvis is tilted and turned a little


@pytest.mark.parametrize("facing", ["front", "left"])
@pytest.mark.parametrize("bow", [0.3, 1.3, 1.9, 2.6])
def test_who_bows_past_level_knows_its_sides_by_its_left(scenario, standing, facing, bow):
    """The pelvis's front points behind it then, and the left foot would be put on the right."""
    swing, stance = feet(scenario)
    pitch = np.array([np.cos(bow / 2), 0.0, np.sin(bow / 2), 0.0])
    mujoco.mju_mulQuat(standing.qpos[3:7], pitch, standing.qpos[3:7].copy())
    scene = scene_of(scenario, standing, step=Step(swing, stance, 0.0))
    aim = replace(law(scenario), facing=facing)
    across = support.middle(support.ends(scenario.model, standing, [stance]))[1]
    to_left = landing(aim, scene, scene.step, 0.1)[1] - across
    upright = bow < np.pi / 2
    assert (to_left > 0.0) == (upright or facing == "left")
    if facing == "left":
        assert to_left >= aim.width - 0.01


@pytest.mark.parametrize(
    ("apart", "beyond", "first"),
    [(0.2, 0.1, "near"), (0.5, 0.05, "far"), (0.2, 0.5, "near")],
    ids=["narrow", "wide", "narrow and far out"],
)
def test_in_a_wide_stance_the_other_foot_comes_in_first(scenario, standing, apart, beyond, first):
    """Feet so far apart [m]; the capture point so far beyond the left one [m]."""
    left, right = feet(scenario)
    scene = pushed_beyond(scenario, standing, apart, beyond)
    for narrow, expected in ((0.3, first), (0.0, "near")):
        aim = replace(by_sides(scenario), narrow=narrow)
        swing = chosen(aim, scene, [left, right])
        assert swing == {"near": left, "far": right}[expected]


def by_sides(scenario):
    """The law that goes by sides."""
    return replace(law(scenario), away=0.0, aside=0.12, reach=0.75, time=0.18, spin=0.0)


def spread(scenario, data, apart):
    """Put the feet so far apart [m]."""
    left, right = feet(scenario)
    mj, hips = scenario.model.mj, scenario.model.motors("hip_x", "here")
    places = mj.jnt_qposadr[mj.actuator_trnid[hips, 0]]
    for _ in range(4):  # the feet lie on arcs about the hips
        mujoco.mj_kinematics(mj, data)
        missing = apart - (data.xpos[left, 1] - data.xpos[right, 1])
        data.qpos[places] += 0.5 * missing / 0.85
    mujoco.mj_forward(mj, data)


def pushed_beyond(scenario, data, apart, beyond):
    """Feet so far apart [m], and the capture point so far beyond the left one [m]."""
    spread(scenario, data, apart)
    rate = np.sqrt(9.81 / data.subtree_com[1, 2])
    speed = rate * (data.xpos[feet(scenario)[0], 1] + beyond - data.subtree_com[1, 1])
    return scene_of(scenario, data, (0.0, speed, 0.0))


@pytest.mark.parametrize(
    ("apart", "beyond", "first"),
    [(0.25, 0.3, "near"), (0.7, 0.08, "far")],
    ids=["the other would not reach it", "the near one has just come out there"],
)
def test_the_foot_swings_whose_step_leaves_the_point_least_far_out(
    scenario, standing, apart, beyond, first
):
    left, right = feet(scenario)
    aim = replace(law(scenario), spin=0.0)
    scene = pushed_beyond(scenario, standing, apart, beyond)
    assert chosen(aim, scene, [left, right]) == {"near": left, "far": right}[first]


def test_a_foot_that_has_just_lost_the_ground_can_bear(scenario, standing):
    """As a push to a side takes the weight off it, and the loaded foot is the one to swing."""
    left, right = feet(scenario)
    aim = replace(law(scenario), spin=0.0)
    scene = pushed_beyond(scenario, standing, 0.25, 0.3)
    assert chosen(aim, scene, [left]) == left
    assert chosen(replace(aim, away=0.0), scene, [left]) == right


@pytest.mark.parametrize("apart", [0.4, 0.6])
@pytest.mark.parametrize("gather", [0.0, 0.5])
def test_who_rests_with_feet_far_apart_brings_them_together(scenario, standing, apart, gather):
    spread(scenario, standing, apart)
    model = scenario.model
    low = max(support.lowest_end(model, standing, foot)[2] for foot in feet(scenario))
    standing.qpos[2] -= low + 0.002
    aim, step = replace(law(scenario), gather=gather), Step()
    for speed in (0.0, 0.3):
        scene = scene_of(scenario, standing, (speed, 0.0, 0.0), step=step)
        assert {*feet(scenario)} <= {*scene.state.contacts.body.tolist()}
        assert (aim.next(scene) != step) == (speed == 0.0 and 0.0 < gather < apart)


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize(
    ("turned", "short", "spin", "steps"),
    [(50.0, 20.0, 0.0, True), (30.0, 20.0, 0.0, False), (50.0, 5.0, 0.0, False)]
    + [(50.0, 20.0, 1.0, False), (50.0, 360.0, 0.0, False)],
    ids=["short", "hips turn on", "there", "still turns", "a whole turn off"],
)
def test_who_rests_short_of_its_turn_steps_with_the_foot_that_is_turned_furthest(
    scenario, standing, side, turned, short, spin, steps
):
    """Its hip turned by so much [deg]; one turn more or less is the same attitude."""
    names, foot = scenario.model.joint_names, feet(scenario)[side]
    hip = names.index(f"hip_z_{'lr'[side]}")
    standing.qpos[scenario.model.angles][hip] = np.radians(turned)
    mujoco.mj_forward(scenario.model.mj, standing)
    low = max(support.lowest_end(scenario.model, standing, one)[2] for one in feet(scenario))
    standing.qpos[2] -= low + 0.002
    scene = scene_of(scenario, standing, spin=(0.0, 0.0, spin))
    scene.target, scene.turned = np.radians(360.0), np.radians(360.0 - short)
    assert {*feet(scenario)} <= {*scene.state.contacts.body.tolist()}
    assert law(scenario).next(scene) == Step()
    step = replace(law(scenario), twist=40.0).next(scene)
    assert step.swing == (foot if steps else 0)


@pytest.mark.parametrize(("way", "speed"), [(0.4, 0.0), (-0.2, 1.5), (0.0, -2.0)])
def test_who_does_as_a_swing_is_told_is_at_rest_there_in_time(way, speed):
    """The law over and again is the cubic from here to rest there, as that is the least effort."""
    time, end = 0.18, 0.01
    run = solve_ivp(
        lambda t, s: [s[1], arrival(way - s[0], s[1], time - t)],
        (0.0, time - end),
        [0.0, speed],
        rtol=1e-10,
        atol=1e-12,
    ).y[:, -1]
    cubic = CubicHermiteSpline([0.0, time], [0.0, way], [speed, 0.0])
    wanted = [float(cubic(time - end)), float(cubic(time - end, 1))]
    assert run.tolist() == pytest.approx(wanted, abs=1e-7)


# ---------------------------------------------------------------- who stands by steps


def stood(behaviour, direction, impulse, seed):
    """Its summary, and how many steps it took."""
    push = ["disturbance=push", "disturbance.time=[0.5,0.5]"] if impulse else []
    aimed = [f"disturbance.impulse={impulse}", f"disturbance.direction=[{direction},{direction}]"]
    overrides = [*push, *aimed] if push else []
    scenario = build(load([f"behaviour={behaviour}", f"seed={seed}", "duration=5", *overrides]))
    swings, number, usual = [], feet(scenario), scenario.controller.decide

    def noted(state, command, blend):
        swings.append(command.held_out[number])
        return usual(state, command, blend)

    scenario.controller.decide = noted
    buffer, breakdown = in_memory(scenario)
    steps = sum((now & ~before).any() for before, now in pairwise([swings[0] & False, *swings]))
    return summarise(scenario, buffer, breakdown, 1.0), steps


@pytest.mark.parametrize("seed", [2000, 2001])
def test_who_is_left_alone_takes_no_step(seed):
    summary, steps = stood("stand_step", 0, 0, seed)
    assert (summary["success"], steps) == (True, 0)


@pytest.mark.parametrize("direction", [0, 45, 135, 180, 225])
def test_a_push_that_fells_who_stands_is_stepped_out_of(direction):
    assert not stood("stand", direction, 38, 2001)[0]["success"]
    summary, steps = stood("stand_step", direction, 38, 2001)
    assert summary["success"]
    assert steps >= 1


@pytest.mark.parametrize("direction", [0, 90, 225])
def test_a_hard_push_takes_more_than_one_step(direction):
    """Two of the three starts at least: any single one may hang on a hair."""
    assert (
        sum(stood("stand_step", direction, 55, seed)[0]["success"] for seed in range(2003, 2006))
        >= 2
    )


# ---------------------------------------------------------------- on a slope


@pytest.mark.parametrize("terrain", ["incline", "decline"])
@pytest.mark.parametrize("lifted", [False, True])
def test_what_is_on_the_ground_is_upright_as_that_lies(terrain, lifted):
    """Its up is the ground's normal, six degrees off, or the world's; it faces as it did."""
    scenario = build(load(["behaviour=stand", f"terrain={terrain}", "start=standing"]))
    model, behaviour = scenario.model, scenario.behaviour
    data = mujoco.MjData(model.mj)
    place(model, data, scenario.start, behaviour.start(0.0), behaviour.axes)
    data.qpos[2] += 0.1 if lifted else -0.03
    data.qpos[3:7] = Rotation.from_euler("z", 0.6).as_quat(scalar_first=True)
    scene = scene_of(scenario, data)
    foot = model.mj.body("foot_l").id
    made = task(kind("attitude").number, scenario.config.controller.tasks["foot"], np.eye(3), foot)
    Upright("upright").fill(made[0], "attitude", scene)
    up = Rotation.from_quat(made["target"][0], scalar_first=True).as_matrix()[:, 2]
    slope = 0.0 if lifted else np.radians({"incline": 6.0, "decline": -6.0}[terrain])
    assert (foot in scene.state.contacts.body) != lifted
    assert up == pytest.approx([-np.sin(slope), 0.0, np.cos(slope)], abs=1e-9)


@pytest.mark.parametrize("terrain", ["incline", "decline"])
def test_who_is_pushed_on_a_slope_stays_up(terrain):
    """Each by itself of 12 did; with level soles 5 of 12 up the slope."""
    stood = 0
    for seed in (2000, 2001, 2002):
        config = load(
            ["behaviour=stand_step", f"terrain={terrain}", "disturbance=push", f"seed={seed}",
             "disturbance.impulse=40", "duration=5"]
        )  # fmt: skip
        scenario = build(config)
        buffer, breakdown = in_memory(scenario)
        stood += summarise(scenario, buffer, breakdown, wall=1.0)["success"]
    assert stood >= 2
