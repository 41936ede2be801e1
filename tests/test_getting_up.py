"""Getting up: frames of who lies, stages that go back, where a foot is put, who stands."""

from dataclasses import replace
from math import cos, pi, sin
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.behaviours.facing import lying
from rotctl.behaviours.staged.conditions import Low
from rotctl.behaviours.staged.gliding import ReachSettings
from rotctl.behaviours.staged.placing import Above, Opposite
from rotctl.behaviours.staged.stages import Stage, mirrored
from rotctl.config.loading import load
from rotctl.control.kinds import kind
from rotctl.control.task import task
from rotctl.mechanics.state import read
from rotctl.metrics.criteria.finish import upright
from rotctl.metrics.criteria.getting_up import GettingUpCriteria, judge
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.simulation.placing import place

FEET = ("foot_l", "foot_r")
UP = GettingUpCriteria("up", "getting_up", FEET, 4.0, 2.0, 0.8, 20.0, 0.25)
UPRIGHT = 1.0  # [m] of the centre of mass


def lies(head, rolled):
    """Trunk axes of who lies, the head towards an angle, rolled about that from the back."""
    long = np.array([cos(head), sin(head), 0.0])
    front = Rotation.from_rotvec(rolled * long).apply([0.0, 0.0, 1.0])
    return np.stack((front, np.cross(long, front), long), axis=1)


@pytest.mark.parametrize("head", [0.0, 1.0, -2.5])
@pytest.mark.parametrize(("rolled", "ahead"), [(0.3, -1.0), (pi - 0.3, 1.0)])
def test_along_is_where_the_face_goes_as_it_comes_up(head, rolled, ahead):
    """Feet ahead on the back and head ahead on the front, so that its left is to the left."""
    axes = lies(head, rolled)
    frame = lying("along", axes)
    assert frame.axes[0] == pytest.approx(ahead * axes[:, 2])
    assert frame.axes[1] @ axes[:, 1] == pytest.approx(cos(0.3))
    assert frame.turned(axes) == pytest.approx(ahead * pi / 2, abs=0.3)  # leant back, or over


@pytest.mark.parametrize("head", [0.0, 1.0, -2.5])
@pytest.mark.parametrize("rolled", [0.0, 1.2, -1.2, pi])
def test_across_is_turned_about_the_long_axis_from_the_back(head, rolled):
    axes = lies(head, rolled)
    frame = lying("across", axes)
    assert frame.turning == pytest.approx(axes[:, 2])
    assert cos(frame.turned(axes) - rolled) == pytest.approx(1.0)


@pytest.fixture(scope="module")
def prone():
    """Who lies on the front gets up: the scenario, and the rows of some starts."""
    made = []
    for seed in (2001, 2005, 2020, 2023):
        scenario = build(load(["behaviour=press_up", f"seed={seed}", "duration=6"]))
        made.append(in_memory(scenario)[0].arrays())
    return scenario, made


def test_of_four_starts_two_stand_within_four_seconds(prone):
    """Nine of ten do, each by itself: that one of four does at most is no chance."""
    _, logs = prone
    assert sum(not judge(log, UP, 1 / 120, UPRIGHT)[1] for log in logs) >= 2


def test_of_three_starts_from_a_side_one_stands_within_five_seconds():
    later = replace(UP, within=5.0)
    for seed in (2002, 2004, 2009):
        scenario = build(load(["behaviour=press_up", "start=side", f"seed={seed}", "duration=7.2"]))
        if not judge(in_memory(scenario)[0].arrays(), later, 1 / 120, UPRIGHT)[1]:
            return
    pytest.fail("none of three, where two of three do")


def test_hands_are_free_of_the_ground_until_they_are_beside_the_chest(prone):
    """They lie on it, and control plans no force at them."""
    _, logs = prone
    touched = False
    for log in logs:
        arms = [n for n, name in enumerate(log["model/body"]) if name.startswith(b"forearm")]
        rows = log["command/stage"] == 1
        used, bodies = log["contacts/used"][rows], log["contacts/body"][rows]
        touched = touched or bool(np.isin(bodies, arms).any())
        assert not used[np.isin(bodies, arms)].any()
    assert touched


def test_it_kneels_before_it_stands(prone):
    """By the contacts of those that stand: on the hands first, on a knee while the foot comes."""
    _, logs = prone
    standing = [log for log in logs if not judge(log, UP, 1 / 120, UPRIGHT)[1]]
    assert standing
    for log in standing:
        names = [name.decode() for name in log["model/body"]]
        rows = [np.unique(log["contacts/body"][log["command/stage"] == stage]) for stage in (2, 6)]
        hands, knees = ({names[body] for body in found if body > 0} for found in rows)
        assert {"forearm_l", "forearm_r"} <= hands
        assert knees & {"thigh_r", "shin_r"}
        assert not knees & {"forearm_l", "forearm_r", "pelvis", "chest"}


def test_who_lies_on_the_back_turns_onto_the_front_first():
    config = load(["behaviour=press_up", "start=supine", "seed=2000", "duration=2.5"])
    log = in_memory(build(config))[0].arrays()
    stage, up = log["command/stage"], log["trajectory/trunk_axes"][:, 2, 0]
    row = int(np.argmax(stage == 1))
    assert stage[0] == 0
    assert row > 0
    assert up[0] > 0.8  # its front up
    assert up[row] < -0.5  # and down: within 50 degrees, from where it kneels


def test_a_stage_that_comes_to_nothing_goes_back():
    """Who falls while it stands is low, and begins again from how it lies."""
    config = load(["behaviour=press_up", "seed=2001", "duration=0.3"])
    again = config.behaviour.stages[-1].otherwise  # low: over
    gather = config.behaviour.stages[1]
    changed = replace(gather, otherwise=replace(again, stage="gather"))
    stages = (config.behaviour.stages[0], changed, *config.behaviour.stages[2:])
    log = in_memory(build(replace(config, behaviour=replace(config.behaviour, stages=stages))))[0]
    stage = log.arrays()["command/stage"]
    assert set(stage[2:].tolist()) == {1}  # lower than that all the while: it begins anew each step


@pytest.mark.parametrize(("speed", "gathers"), [(0.0, True), (2.0, False)])
def test_who_still_moves_fast_comes_to_lie_first(speed, gathers):
    """On its front it needs no turn, and gathers its hands at once if it is calm."""
    config = load(["behaviour=press_up", "seed=2001", "duration=0.05"])
    moving = replace(config.start, speed_x=(speed, speed))
    log = in_memory(build(replace(config, start=moving)))[0].arrays()
    assert (log["command/stage"][-1] == 1) == gathers


def test_it_can_go_to_stages_alone_that_there_are():
    def wrong(stage):
        if not stage.otherwise:
            return stage
        return replace(stage, otherwise=replace(stage.otherwise, stage="ovre"))

    settings = load(["behaviour=press_up"]).behaviour
    stages = tuple(wrong(stage) for stage in settings.stages)
    with pytest.raises(ValueError, match="otherwise: no stage 'ovre'; valid: over, gather, kneel"):
        replace(settings, stages=stages)


@pytest.fixture
def standing():
    """One who stands and drifts as one piece, as a stage sees it."""
    scenario = build(load(["behaviour=stand_step", "seed=2000"]))
    model, behaviour = scenario.model, scenario.behaviour
    data = mujoco.MjData(model.mj)
    place(model, data, scenario.start, behaviour.start(0.0), behaviour.axes)
    data.qvel[:3] = [0.4, -0.3, 0.0]
    mujoco.mj_forward(model.mj, data)
    state = read(model, data)
    return SimpleNamespace(model=model, state=state, axes=behaviour.axes, floor=0.0)


def soles(scene):
    """The middle of each sole's capsules (2, 2), seen from above."""
    mj = scene.model.mj
    return [
        np.mean(
            [
                scene.state.data.geom_xpos[geom][:2]
                for geom in range(mj.ngeom)
                if mj.geom_contype[geom] and mj.body(mj.geom_bodyid[geom]).name == name
            ],
            axis=0,
        )
        for name in FEET
    ]


def rests(scene):
    """Where it would come to rest: c + v / omega."""
    c, v = scene.state.momentum.com, scene.state.momentum.com_velocity
    return c[:2] + v[:2] * np.sqrt(c[2] / 9.81)


def filled(aim, kind_name, scene):
    made = task(kind(kind_name).number, load([]).controller.tasks["linear"], np.eye(3), 0)[0]
    aim.fill(made, kind_name, scene)
    return made["target"][:3]


def test_a_foot_is_put_where_the_capture_point_lies_between(standing):
    """On the line from the other foot through it, so far beyond, at the height of a sole."""
    target = filled(Opposite("opposite", "foot_r", 0.25, 0.03), "point", standing)
    point, other = rests(standing), soles(standing)[1]
    way = target[:2] - point
    assert np.hypot(*way) == pytest.approx(0.25)
    assert way[0] * (point - other)[1] - way[1] * (point - other)[0] == pytest.approx(0.0, abs=1e-9)
    assert way @ (point - other) > 0.0
    assert target[2] == pytest.approx(0.03)


@pytest.mark.parametrize("most", [0.05, 10.0])
def test_the_centre_of_mass_goes_over_the_middle_of_the_feet(standing, most):
    aim = Above("above", ("foot",), 0.6, most, ahead=0.1)
    com = standing.state.momentum.com
    goal = np.array([*np.mean(soles(standing), axis=0), 0.6]) + [0.1, 0.0, 0.0]
    far = np.sqrt(((goal - com) ** 2).sum())
    expected = com + min(1.0, most / far) * (goal - com)
    assert filled(aim, "linear", standing) == pytest.approx(expected, abs=1e-9)


def test_low_is_the_centre_of_mass(standing):
    height = float(standing.state.momentum.com[2])
    assert Low("low", height + 1e-6).met(standing)
    assert not Low("low", height - 1e-6).met(standing)


def test_a_pose_is_reached_from_rest_to_rest():
    """Half way in half the time; its speeds are those of its way, by finite differences."""
    scenario = build(load(["behaviour=press_up", "duration=0.1"]))
    law = ReachSettings({"knee": 1.0, "hip_y_l": -0.4}, 0.8).make(scenario.model, "")
    start = np.linspace(-0.2, 0.3, len(law.end))

    def at(time):
        begin = type("Begin", (), {"time": 2.0, "angles": start})
        state = type("State", (), {"time": 2.0 + time})
        poses, speeds = law.poses(type("Scene", (), {"begin": begin, "state": state}), None)
        assert (poses[0] == poses[1]).all()
        return poses[0], speeds[0]

    assert at(0.0)[0] == pytest.approx(start)
    assert at(0.4)[0] == pytest.approx(0.5 * (start + law.end))
    assert at(5.0)[0] == pytest.approx(law.end)
    for time in (0.0, 0.1, 0.55, 0.8, 3.0):
        slope = (at(time + 1e-6)[0] - at(max(time - 1e-6, 0.0))[0]) / (1e-6 + min(time, 1e-6))
        assert at(time)[1] == pytest.approx(slope, abs=1e-4)


def test_a_pose_that_is_reached_is_mirrored():
    scenario = build(load(["behaviour=press_up", "duration=0.1"]))
    stage = Stage("one", reach=ReachSettings({"knee_l": 1.0, "waist_x": 0.2}, 0.5))
    other = mirrored(stage, scenario.model).reach
    assert other.seconds == 0.5
    assert (other.pose["knee_r"], other.pose["waist_x"]) == (1.0, -0.2)


def log_of(height, lean, bodies, stage, speed=0.0, period=0.1):
    """A log of rows of those heights, leans, bodies on the ground and stages."""
    rows = len(height)
    axes = np.zeros((rows, 3, 3))
    axes[:, 2, 2] = np.cos(np.radians(lean))
    com = np.stack((np.zeros(rows), np.zeros(rows), height), axis=1)
    return {
        "trajectory/time": np.arange(rows) * period,
        "trajectory/com": com,
        "trajectory/com_velocity": np.full((rows, 3), [speed, 0.0, 0.0]),
        "trajectory/ground_height": np.zeros(rows),
        "trajectory/trunk_axes": axes,
        "contacts/body": np.array(bodies)[:, None],
        "command/stage": np.array(stage),
        "model/body": np.array([b"world", b"foot_l", b"foot_r", b"shin_l"]),
    }


def rows_of(down, up, again=0):
    """Down for so many rows of 0.1 s, in which it began again so often, then up."""
    stage = [0, 1] * (again + 1) + [2] * (down + up)
    return {
        "height": np.array([0.3] * down + [0.9] * up),
        "lean": np.array([70.0] * down + [5.0] * up),
        "bodies": [3] * down + [1] * up,
        "stage": stage[: down + up],
    }


@pytest.mark.parametrize(
    ("rows", "change", "reason"),
    [
        (rows_of(30, 30), {}, ""),
        (rows_of(40, 30), {}, ""),
        (rows_of(41, 30), {}, "is up from 4.10 s only"),
        (rows_of(30, 15), {}, "the run ends 1.50 s after it is up, not 2"),
        (rows_of(60, 0), {}, "is not on its feet in the end"),
        (rows_of(30, 30), {"bodies": [3] * 60}, "is not on its feet in the end"),
        (rows_of(30, 30), {"height": np.full(60, 0.7)}, "is not on its feet in the end"),
        (rows_of(30, 30), {"lean": np.full(60, 25.0)}, "is not on its feet in the end"),
        (rows_of(30, 30), {"speed": 0.3}, "still moves at 0.30 m/s in the end"),
    ],
)
def test_what_counts_as_getting_up(rows, change, reason):
    columns, told = judge(log_of(**(rows | change)), UP, 0.1, UPRIGHT)
    assert told == reason
    if not reason:
        assert columns["up_from"] == pytest.approx(0.1 * rows["bodies"].count(3))
        assert columns["lowest_in_the_end"] == 0.9


@pytest.mark.parametrize(
    ("height", "upright", "stands"),
    [(0.65, 0.68, True), (0.5, 0.68, False), (0.9, 1.2, False), (0.1, np.nan, True)],
)
def test_how_high_it_is_up_is_judged_by_its_size(height, upright, stands):
    rows = rows_of(30, 30) | {"height": np.full(60, height)}
    reason = judge(log_of(**rows), UP, 0.1, upright)[1]
    assert reason == ("" if stands else "is not on its feet in the end")


def test_an_adult_is_up_from_80_centimetres():
    config = load(["behaviour=press_up"])
    limit = config.criteria.height * upright(build(config).model.mj)
    assert limit == pytest.approx(0.8, abs=1e-6)


def test_attempts_are_counted():
    assert judge(log_of(**rows_of(30, 30)), UP, 0.1, UPRIGHT)[0]["attempts"] == 1
    assert judge(log_of(**rows_of(30, 30, again=2)), UP, 0.1, UPRIGHT)[0]["attempts"] == 3


def test_a_log_without_rows_never_is_up():
    empty = {name: array[:0] for name, array in log_of(**rows_of(1, 1)).items()}
    columns, reason = judge(empty, UP, 0.1, UPRIGHT)
    assert reason == "is not on its feet in the end"
    assert np.isnan(columns["up_from"])
