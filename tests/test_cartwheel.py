"""A cartwheel: the ways that it goes, what is set down where, and what it is judged by."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.behaviours import support
from rotctl.behaviours.facing import frame_of
from rotctl.behaviours.staged.conditions import Passed
from rotctl.behaviours.staged.stages import Otherwise, mirrored
from rotctl.behaviours.staged.touching import Touches
from rotctl.behaviours.standing.tipping import share_of, ways
from rotctl.behaviours.standing.wheeling import Carry, Place, Stride
from rotctl.config.loading import load
from rotctl.control.task import TASK
from rotctl.metrics.criteria.acrobatic import judge
from rotctl.metrics.criteria.flip import turn
from rotctl.metrics.touching import touch_downs
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

PERIOD = 1 / 240
STILL = ["start.scatter=0", "start.tilt=0", "start.speed_x=[0,0]", "start.speed_y=[0,0]"]
SEEDS = (2001, 2003, 2004)
RIGHT = "behaviour.target_excursion=360"


@pytest.fixture(scope="module")
def wheels():
    """Scenario and rows of three starts, until the first foot is down and more."""
    found = []
    for seed in SEEDS:
        config = load(["behaviour=cartwheel", f"seed={seed}", "plant=varied", "duration=3.4"])
        scenario = build(config)
        buffer, ending = in_memory(scenario)
        assert not ending
        found.append((scenario, buffer.arrays()))
    return found


def still(*overrides):
    """Rows of a run that starts without scatter."""
    config = load(["behaviour=cartwheel", "seed=1", "duration=1.7", *STILL, *overrides])
    return in_memory(build(config))[0].arrays()


def test_foot_hand_hand_foot_foot(wheels):
    for _, log in wheels:
        order = [body for time, body in touch_downs(log, PERIOD) if time > 0.8]
        first = list(dict.fromkeys(order))
        assert first[:4] == ["foot_l", "forearm_l", "forearm_r", "foot_r"]
        assert "foot_l" in order[order.index("foot_r") :]


def test_it_turns_in_its_plane_head_down_over_straight_arms(wheels):
    """Sideways: the trunk's front stays across the way while its up goes round."""
    for _, log in wheels:
        turned = turn(log, "forward")
        assert turned.min() < -250.0
        over = (turned < -150.0) & (turned > -210.0)
        front = log["trajectory/trunk_axes"][over][:, :, 0]
        assert ((front * log["command/axes"][0, 0]).sum(axis=1) > 0.7).all()
        assert (log["trajectory/com"][over, 2] > 0.7).all()  # [m] a roll's is at 0.3


def test_feet_in_the_air_are_seldom_pressed_past_their_stops(wheels):
    """Without `limits` an ankle is, by 0.1 rad or more, in nine tenths of the time."""
    shares = []
    for scenario, log in wheels:
        model, names = scenario.model, [s.name for s in scenario.config.behaviour.stages]
        stage = log["command/stage"]
        over_hands = (stage >= names.index("tip")) & (stage <= names.index("first_foot"))
        ankles = [i for i, name in enumerate(model.joint_names) if name.startswith("ankle")]
        angles = log["trajectory/qpos"][over_hands][:, model.angles][:, ankles]
        low, high = model.joint_range[ankles].T
        past = np.maximum(low - angles, angles - high).max(axis=1)
        shares.append((past > 0.1).mean())
    assert np.mean(shares) < 0.7


def test_to_the_right_it_is_the_mirror_image():
    """Without scatter, until hands come down: what grows from rounding stays small till then."""
    left, right = still(), still(RIGHT)
    assert right["trajectory/com"] == pytest.approx(left["trajectory/com"] * [-1, 1, 1], abs=1e-6)
    assert turn(right, "forward") == pytest.approx(-turn(left, "forward"), abs=1e-4)


def test_the_order_to_the_right_is_the_mirror_image():
    config = load(["behaviour=cartwheel"])
    names = ["foot_l", "forearm_l", "forearm_r", "foot_r", "foot_l"]
    for target, order in ((-360.0, names), (360.0, [other(name) for name in names])):
        log = rows(order)
        _, reason = judge(log, config.criteria, target, PERIOD)
        assert "out of order" not in reason
        _, reason = judge(log, config.criteria, -target, PERIOD)
        assert reason == f"{order[1]} came down out of order, at 0.25 s"


def test_stages_twice_mirrored_are_the_stages():
    scenario = build(load(["behaviour=cartwheel"]))
    for stage in scenario.config.behaviour.stages:
        again = mirrored(mirrored(stage, scenario.model), scenario.model)
        assert again.tasks == stage.tasks
        assert again.until == stage.until
        assert again.held_out == stage.held_out
        if stage.turn:
            assert again.turn.angles == stage.turn.angles
            assert again.turn.end == pytest.approx(stage.turn.end)
    tip = next(s for s in scenario.config.behaviour.stages if s.name == "tip")
    assert mirrored(tip, scenario.model).tasks["reach"].point == tip.tasks["reach"].point
    sided = replace(tip.tasks["reach"], point=(0.1, 0.2, -0.3))
    otherwise = Otherwise(Touches("touches", ("forearm_r",)), "stand")
    tip = replace(tip, tasks={**tip.tasks, "reach": sided}, otherwise=otherwise)
    image = mirrored(tip, scenario.model)
    assert image.otherwise == Otherwise(Touches("touches", ("forearm_l",)), "stand")
    assert image.tasks["reach"].point == (0.1, -0.2, -0.3)
    assert mirrored(image, scenario.model).otherwise == tip.otherwise
    assert mirrored(image, scenario.model).tasks == tip.tasks
    assert image.tasks["reach"].body == other(tip.tasks["reach"].body)
    assert image.tasks["reach"].aim.beyond == other(tip.tasks["reach"].aim.beyond)
    assert image.until.bodies == tuple(map(other, tip.until.bodies))
    assert image.held_out == tuple(map(other, tip.held_out))


# ---------------------------------------------------------------- the ways


@pytest.mark.parametrize("heading", [0.0, -90.0, 37.0])
def test_a_turn_about_forward_is_the_trunks_up(heading):
    """By scipy: turned to the right about forward, whichever way it faces."""
    frame = frame_of("left", heading, "forward")
    facing = Rotation.from_euler("z", heading, degrees=True)
    for angle in (-170.0, -30.0, 0.0, 100.0):
        trunk = (facing * Rotation.from_euler("x", angle, degrees=True)).as_matrix()
        assert np.degrees(frame.turned(trunk)) == pytest.approx(angle, abs=1e-9)
        assert frame.axis(trunk) == pytest.approx(frame.axes[0])


def test_the_way_lies_where_the_head_goes():
    axes = np.eye(3)
    for turning, target, along in (
        (axes[0], -6.3, [0, 1, 0]),  # to its left, facing x
        (axes[0], 6.3, [0, -1, 0]),
        (axes[1], 6.3, [1, 0, 0]),  # forward
    ):
        scene = SimpleNamespace(target=target, turning=turning)
        assert ways(scene).along == pytest.approx(along)
        small = Rotation.from_rotvec(np.sign(target) * 0.1 * turning).apply([0.0, 0.0, 1.0])
        assert small @ ways(scene).along > 0.0


def test_a_share_of_the_turn_counts_in_its_sense():
    for target, turned in ((-6.3, np.radians(-45.0)), (6.3, np.radians(45.0))):
        scene = SimpleNamespace(target=target, turned=turned)
        assert share_of(scene, (30.0, 60.0)) == pytest.approx(0.5)
        assert share_of(scene, (50.0, 60.0)) == 0.0
        assert share_of(scene, (10.0, 40.0)) == 1.0


# ---------------------------------------------------------------- aims, at the start of a run


@pytest.fixture(scope="module")
def standing():
    """What aims see of somebody who stands, a little askew."""
    scenario = build(load(["behaviour=cartwheel", "seed=4", "duration=1"]))
    seen = []
    behaviour = scenario.behaviour
    plain = behaviour._scene

    def look(memory, state):
        scene = plain(memory, state)
        seen.append(scene)
        return scene

    behaviour._scene = look
    in_memory(scenario, look=lambda _, done: done > 40)
    return seen[-1]


def test_carried_along_the_way_and_balanced_across(standing):
    """Forward as an inverted pendulum over the soles does; along the way at its rate."""
    scene = standing
    aim = Carry("carry", ("foot",), (), 1.5, 4.0, 1.0, 0.0, (0.9, 0.7), (0.0, 90.0))
    row = np.zeros(1, TASK)[0]
    aim.fill(row, "linear", scene)
    momentum, (along, across) = scene.state.momentum, ways(scene)
    assert row["acceleration"] @ along == pytest.approx(4.0 * (1.5 - momentum.com_velocity @ along))
    mj = scene.model.mj
    feet = [mj.body(name).id for name in ("foot_l", "foot_r")]
    ends = support.ends(scene.model, scene.state.data, feet)
    middle = np.array([*support.middle(ends), 0.0]) @ across
    rate = np.sqrt(9.81 / momentum.com[2])
    place, speed = momentum.com @ across, momentum.com_velocity @ across
    pressure = middle + 2.0 * (place + speed / rate - middle)
    assert row["acceleration"] @ across == pytest.approx(rate**2 * (place - pressure), rel=1e-6)
    assert row["target"][2] == pytest.approx(0.9, abs=2e-3)  # upright still


def test_pressure_from_beyond_the_feet_stops_what_they_cannot(standing):
    """A capture point beyond the toes: some of what is missing, or all of it and no more."""
    momentum, across = standing.state.momentum, ways(standing).across
    fast = momentum._replace(com_velocity=momentum.com_velocity + 1.0 * across)
    scene = standing._replace(state=standing.state._replace(momentum=fast))
    found = {}
    for throw in (0.0, 0.05, 10.0):
        row = np.zeros(1, TASK)[0]
        aim = Carry("carry", ("foot",), (), 1.5, 4.0, 1.0, 0.0, (0.9, 0.7), (0.0, 90.0), throw)
        aim.fill(row, "linear", scene)
        found[throw] = row["acceleration"] @ across
    square = 9.81 / momentum.com[2]
    assert found[0.05] - found[0.0] == pytest.approx(-0.05 * square, rel=1e-6)
    mj = scene.model.mj
    feet = [mj.body(name).id for name in ("foot_l", "foot_r")]
    middle = np.array([*support.middle(support.ends(scene.model, scene.state.data, feet)), 0.0])
    off = (momentum.com - middle) @ across
    out = off + fast.com_velocity @ across / np.sqrt(square)
    assert found[10.0] == pytest.approx(square * (off - 2.0 * out), rel=1e-6)


def test_a_limb_is_lowered_over_the_turn(standing):
    """Along the way beyond the foot, across it where the body comes to rest; slides, stage 2."""
    scene = standing._replace(turned=np.radians(-45.0))
    body = scene.model.mj.body("forearm_l").id
    row = np.zeros(1, TASK)[0]
    row["body"], row["weight"] = body, 1.0
    Place("place", "foot_l", 0.8, (30.0, 60.0), 0.03, 0.04).fill(row, "point", scene)
    along, across = ways(scene)
    foot = scene.state.data.xpos[scene.model.mj.body("foot_l").id]
    assert (row["target"][:3] - foot) @ along == pytest.approx(0.8)
    momentum = scene.state.momentum
    rests = momentum.com + momentum.com_velocity / np.sqrt(9.81 / momentum.com[2])
    assert (row["target"][:3] - rests) @ across == pytest.approx(0.04, abs=1e-9)
    high = scene.begin.place[body][2]
    assert row["target"][2] == pytest.approx(0.5 * (high + 0.03))


def test_a_limb_is_set_down_where_the_body_will_come_to_rest(standing):
    """Along the way by the turn that is left, and no further from `distance` than there is room."""
    momentum, (along, across) = standing.state.momentum, ways(standing)
    moving = momentum._replace(
        com_velocity=0.8 * along, angular_velocity=2.0 * np.sign(standing.target) * standing.turning
    )
    scene = standing._replace(
        turned=np.sign(standing.target) * np.radians(60.0),
        state=standing.state._replace(momentum=moving),
    )
    hand = scene.state.data.xpos[scene.model.mj.body("forearm_r").id]
    left = np.radians(30.0) / 2.0  # [s]
    rests = momentum.com @ along + 0.8 * (left + np.sqrt(momentum.com[2] / 9.81)) - 0.07
    far = rests - hand @ along
    for distance, room, wanted in (
        (far + 0.1, 0.2, far),
        (far + 0.1, 0.05, far + 0.05),
        (far - 0.1, 0.05, far - 0.05),
        (far + 0.1, 0.0, far + 0.1),
    ):
        row = np.zeros(1, TASK)[0]
        row["body"], row["weight"] = scene.model.mj.body("forearm_l").id, 1.0
        short = 0.07 if room else 0.0
        aim = Place("place", "forearm_r", distance, (30.0, 90.0), 0.03, 0.0, room, short)
        aim.fill(row, "point", scene)
        assert (row["target"][:3] - hand) @ along == pytest.approx(wanted, abs=1e-9)
        assert row["target"][:3] @ across == pytest.approx(momentum.com @ across, abs=1e-9)


def test_a_foot_that_strides_is_there_in_time(standing):
    """By integrating what it asks for: at the place, at rest."""
    scene = standing
    body, along = scene.model.mj.body("foot_l").id, ways(scene).along
    aim = Stride("stride", 0.3, 0.4, 0.05, 0.03)
    row = np.zeros(1, TASK)[0]
    row["body"] = body
    begin = scene.begin._replace(time=scene.state.time)
    aim.fill(row, "point", scene._replace(begin=begin))
    com = scene.state.momentum.com + 0.4 * scene.state.momentum.com_velocity
    goal = com @ along + 0.3
    place = scene.state.data.xpos[body] @ along
    # At rest now, least in the square: 6 s / T^2 at first.
    assert row["acceleration"] @ along == pytest.approx(6.0 * (goal - place) / 0.4**2, abs=0.5)


def test_passing_a_foot_and_touching_after_a_while(standing):
    scene = standing
    foot = scene.model.mj.body("foot_l").id
    ends = support.ends(scene.model, scene.state.data, [foot])
    beyond = (scene.state.momentum.com - [*support.middle(ends), 0.0]) @ ways(scene).along
    assert Passed("passed", ("foot_l",), float(beyond) - 1e-6).met(scene)
    assert not Passed("passed", ("foot_l",), float(beyond) + 1e-6).met(scene)
    gone = scene.state.time - scene.begin.time
    assert Touches("touches", ("foot",), gone - 1e-3).met(scene)
    assert not Touches("touches", ("foot",), gone + 1e-3).met(scene)


# ---------------------------------------------------------------- help


def other(name):
    return name[:-1] + {"l": "r", "r": "l"}[name[-1]]


def rows(order):
    """A log of parts that come down one after the other and stay."""
    names = ["world", "foot_l", "foot_r", "forearm_l", "forearm_r"]
    on = np.full((len(order) * 30 + 30, 8), -1)
    for i, name in enumerate(order):
        on[30 * i + 30 : 30 * i + 50, i] = names.index(name)
    n = len(on)
    return {
        "model/body": np.array([name.encode() for name in names]),
        "contacts/body": on,
        "contacts/count": (on > 0).sum(axis=1),
        "contacts/force_realised": np.zeros((n, 8, 3)),
        "trajectory/time": PERIOD * np.arange(n),
        "trajectory/com": np.ones((n, 3)),
        "trajectory/com_velocity": np.zeros((n, 3)),
        "trajectory/ground_height": np.zeros(n),
        "trajectory/trunk_axes": np.tile(np.eye(3), (n, 1, 1)),
        "command/axes": np.eye(3)[None],
    }
