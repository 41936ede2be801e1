"""Dives into water, and what they are judged by."""

from dataclasses import replace
from types import SimpleNamespace

import mujoco
import numpy as np
import pytest

from rotctl.config.fit import require_fit
from rotctl.config.loading import load
from rotctl.metrics.criteria import dive
from rotctl.metrics.criteria.platform import touched
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.simulation.episode import Episode

PERIOD = 1 / 240


@pytest.fixture(scope="module")
def back():
    """A backward dive, its scenario and its rows."""
    scenario = build(load(["behaviour=dive_backward", "seed=2000", "duration=5"]))
    buffer, _ = in_memory(scenario)
    return scenario, buffer.arrays()


def placed(scenario, log, row):
    """MuJoCo's own kinematics of a row."""
    data = mujoco.MjData(scenario.model.mj)
    data.qpos[:] = log["trajectory/qpos"][row]
    mujoco.mj_kinematics(scenario.model.mj, data)
    return data


def ends(scenario, log, row):
    """The middles of the hands and of the feet, the crown and the pelvis in a row, world [m]."""
    mj, data = scenario.model.mj, placed(scenario, log, row)

    def middle(point, *names):
        at = [mj.body(name).id for name in names]
        return np.mean([data.xpos[i] + data.xmat[i].reshape(3, 3) @ point for i in at], axis=0)

    hands = middle([0.0, 0.0, -0.3], "forearm_l", "forearm_r")
    feet = middle(np.zeros(3), "foot_l", "foot_r")
    return hands, feet, middle([0.0, 0.0, 0.17], "head"), middle(np.zeros(3), "pelvis")


def test_it_enters_head_first_and_straight(back):
    scenario, log = back
    columns, reason = dive.judge(log, scenario.config.criteria, -540.0, PERIOD)
    assert reason == ""
    assert columns["revolved"] == pytest.approx(-540.0, abs=15.0)


def test_the_entry_is_when_and_how_the_body_is_there(back):
    """By kinematics of the logged state: hands at the water, and the line to them."""
    scenario, log = back
    row = dive.entry(log)
    hands, feet, _, _ = ends(scenario, log, row)
    line = hands - feet
    angle = np.degrees(np.arccos(-line[2] / np.linalg.norm(line)))
    found = dive.measure(log, scenario.config.criteria, -540.0, PERIOD)
    assert found.entry_angle == pytest.approx(angle, abs=0.01)
    assert hands[2] == pytest.approx(-10.0, abs=0.15)
    assert found.entry_time == pytest.approx(row * PERIOD)


def test_all_of_it_stays_clear_of_the_platform_that_it_stands_at_the_edge_of():
    """By MuJoCo's distances; with the edge of `terrain=pool` the head passes at 0.15 m."""
    start = ["terrain.height=5", "plant=varied", "seed=2000", "duration=3.5"]
    scenario = build(load(["behaviour=dive_backward", *start]))
    log, mj = in_memory(scenario)[0].arrays(), scenario.model.mj
    first, row = dive.longest_flight(log)[0], dive.entry(log)
    top = first + int(np.argmax(log["trajectory/com"][first:row, 2]))
    limbs = [g for g in range(mj.ngeom) if mj.geom_bodyid[g] and mj.geom_contype[g]]
    edge = mj.geom("platform").id
    near = min(
        mujoco.mj_geomDistance(mj, placed(scenario, log, each), limb, edge, 5.0, None)
        for each in range(top, row, 4)
        for limb in limbs
    )
    assert near > 0.3
    assert not touched(log, row)


def test_who_touches_the_platform_on_the_way_down_is_told_so(back):
    """And not who still has the feet at the edge on the way up."""
    scenario, log = back
    first, row = dive.longest_flight(log)[0], dive.entry(log)
    top = first + int(np.argmax(log["trajectory/com"][first:row, 2]))
    for at, reason in ((top - 1, ""), (top + 9, "touched the platform on its way down")):
        bodies = log["contacts/body"].copy()
        bodies[at, 0] = 1
        grazed = {**log, "contacts/body": bodies}
        assert dive.judge(grazed, scenario.config.criteria, -540.0, PERIOD)[1] == reason


def test_the_clearances_are_how_near_it_comes_to_where_it_last_stood_and_to_the_edge(back):
    """And to the edge; by kinematics of the logged states, from the highest one on, along x."""
    scenario, log = back
    first, row = dive.longest_flight(log)[0], dive.entry(log)
    last = log["contacts/position"][first - 1][log["contacts/body"][first - 1] >= 0]
    top = first + int(np.argmax(log["trajectory/com"][first:row, 2]))
    found = dive.measure(log, scenario.config.criteria, -540.0, PERIOD)
    for measured, (x, z), within in (
        (found.clearance, (last[:, 0].max(), last[0, 2]), 1e-3),
        (found.edge_clearance, (scenario.config.terrain.edge, 0.0), 0.01),
    ):
        places = [place for each in range(top, row) for place in ends(scenario, log, each)]
        near = min(np.hypot(max(p[0] - x, 0.0), max(p[2] - z, 0.0)) for p in places)
        assert measured == pytest.approx(near, abs=within)
    assert found.edge_clearance < found.clearance - 0.1


@pytest.mark.parametrize(
    ("behaviour", "target", "heading"),
    [("dive_backward", -540, 148), ("dive_forward", 540, 35), ("dive_armstand_forward", 360, 20)],
)
def test_the_edge_lies_across_x_whichever_way_a_dive_heads(behaviour, target, heading):
    """By kinematics of the logged states, from the highest one on, or from below the hands."""
    way = [f"behaviour={behaviour}", f"behaviour.target_excursion={target}", "terrain.height=5"]
    scenario = build(load([*way, f"behaviour.heading={heading}", "seed=2000", "duration=5"]))
    log, edge = in_memory(scenario)[0].arrays(), scenario.config.terrain.edge
    criteria = scenario.config.criteria
    (first, _), row = dive.longest_flight(log), dive.entry(log)
    heights = log["trajectory/com"][first:row, 2]
    top = first + int(np.argmax(heights < 0.0 if criteria.held else heights))
    places = [place for each in range(top, row) for place in ends(scenario, log, each)]
    near = min(np.hypot(max(p[0] - edge, 0.0), max(p[2], 0.0)) for p in places)
    found = dive.measure(log, criteria, float(target), PERIOD).edge_clearance
    assert found == pytest.approx(near, abs=0.003)


def test_who_never_enters_has_no_numbers(back):
    scenario, log = back
    stays = {**log, "command/stage": np.zeros_like(log["command/stage"])}
    columns, reason = dive.judge(stays, scenario.config.criteria, -540.0, PERIOD)
    assert reason == "did not enter the water"
    assert np.isnan(columns["entry_angle"])


def test_each_limit_has_its_reason(back):
    scenario, log = back
    strict = scenario.config.criteria
    for limits, words in (
        ({"angle": 1e-6}, "off the vertical"),
        ({"bent": 1e-6}, "with a joint bent"),
        ({"clearance": 5.0}, "of where it last stood"),
        ({"edge": 5.0}, "of the platform's edge"),
    ):
        assert words in dive.judge(log, replace(strict, **limits), -540.0, PERIOD)[1]
    assert dive.judge(log, replace(strict, edge=None), -540.0, PERIOD)[1] == ""  # an older run
    assert "of 540" in dive.judge(log, strict, 540.0, PERIOD)[1]


def test_a_joint_of_the_straight_pose_may_be_one_of_a_side(back):
    scenario, log = back
    knee = 7 + log["model/joint"].tolist().index(b"knee_l")
    one = replace(scenario.config.criteria, straight={"knee_l": 1.0})
    told = dive.judge(log, one, -540.0, PERIOD)[0]["bent_most"]
    bend = log["trajectory/qpos"][dive.entry(log), knee]
    assert told == pytest.approx(np.degrees(1.0 - bend))


def test_what_a_chest_that_is_not_there_would_bend_the_waist_bends():
    log = {"model/joint": np.array([b"waist_y", b"knee_l"]), "trajectory/qpos": np.zeros((2, 9))}
    log["trajectory/qpos"][:, 7] = 0.3, 0.5
    straight = {"waist_y": 0.2, "chest_y": 0.1}
    found = dive._bent(log, SimpleNamespace(straight=straight))
    assert found == pytest.approx([0.0, np.degrees(0.2)])
    with_chest = log | {"model/joint": np.array([b"waist_y", b"chest_y"])}
    found = dive._bent(with_chest, SimpleNamespace(straight=straight))
    assert found == pytest.approx(np.degrees([0.1, 0.3]))


def test_an_older_dive_is_judged_by_a_pose_that_no_joint_reaches(back):
    """As it was when it was made; a new one with it is refused."""
    config = back[0].config
    odd = replace(config, criteria=replace(config.criteria, straight={"knee": 9.0}))
    require_fit(odd, back[0].known)
    assert build(odd, again=True).run_id == back[0].run_id


def test_water_is_lower_than_the_platform_and_stops_nobody():
    ground = build(load(["behaviour=dive_backward", "terrain.height=3"])).model.ground
    assert ground.height(0.0, 0.0) == 0.0
    assert ground.height(0.19, 0.0) == ground.height(5.0, 2.0) == -3.0
    text = build(load(["behaviour=dive_backward", "terrain.height=3"])).model.mjcf
    model = mujoco.MjModel.from_xml_string(text)
    water = model.geom("water").id
    assert model.geom_contype[water] == model.geom_conaffinity[water] == 0


@pytest.mark.parametrize(
    ("behaviour", "target", "height", "shape"),
    [
        ("dive_forward", 540, 10, "tuck"),
        ("dive_forward", 900, 10, "tuck"),
        ("dive_backward", -180, 3, "tuck"),
        ("dive_backward", -540, 10, "pike"),
    ],
)
def test_other_dives_enter_straight_too(behaviour, target, height, shape):
    """Of two starts at least one; of others, nearly all."""
    entered = 0
    for seed in (2002, 2003):
        turns = [f"behaviour.target_excursion={target}", f"behaviour.shape={shape}"]
        way = [f"behaviour={behaviour}", f"terrain.height={height}", "duration=4.5"]
        config = load([*way, *turns, f"seed={seed}"])
        log = in_memory(build(config))[0].arrays()
        entered += not dive.judge(log, config.criteria, float(target), PERIOD)[1]
    assert entered >= 1


def test_a_loose_box_is_not_what_it_stood_on():
    """Two metres down where the ground is higher, it is not the lowest of the body."""
    words = ["behaviour=press_up", "terrain=hazards", "terrain.run_in=0", "duration=5"]
    scenario = build(load(words))
    staged, state = scenario.behaviour, next(iter(Episode(scenario))).state
    memory = staged.begin(0.0, state)
    place = memory.begin.place.copy()
    place[-1] = [9.0, 0.0, -2.0]
    box = scenario.model.mj.body(len(place) - 1)
    assert box.name.startswith("box")
    lost = replace(state.contacts, position=np.zeros((0, 3)))
    begun = memory._replace(begin=memory.begin._replace(place=place))
    scene = staged._scene(begun, state._replace(contacts=lost))
    ground = SimpleNamespace(height=lambda x, y: 1.0 if x > 8.0 else 0.0)
    high = SimpleNamespace(mj=scenario.model.mj, ground=ground)
    assert scene._replace(model=high).floor == 0.0


def test_who_leans_over_the_edge_and_loses_it_for_a_step_is_not_over_the_abyss():
    """The height of a launch is measured from the platform: over the water it would end."""
    scenario = build(load(["behaviour=dive_forward"]))
    staged, state = scenario.behaviour, next(iter(Episode(scenario))).state
    lost = replace(state.contacts, position=np.zeros((0, 3)))
    ahead = state.momentum._replace(com=np.array([0.5, 0.0, 0.9]))
    leaning = state._replace(contacts=lost, momentum=ahead)
    assert staged._scene(staged.begin(0.0, state), leaning).floor == 0.0
    away = staged.begin(0.0, state)
    gone = away._replace(begin=away.begin._replace(place=away.begin.place + [1.0, 0.0, 0.0]))
    assert staged._scene(gone, leaning).floor == -10.0


def test_who_begins_in_the_air_may_head_anywhere():
    build(load(["behaviour=flight", "behaviour.target_excursion=-540", "behaviour.heading=90"]))
