"""Who stands anyhow comes to stand as a move begins: feet beside each other, arms overhead."""

from math import cos, degrees, radians

import mujoco
import numpy as np
import pytest

from rotctl.behaviours.standing.gathering import Beside
from rotctl.config.loading import load
from rotctl.control.task import TASK
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

POSE = "start.postures.left.pose"
# One foot a quarter of a metre behind the other, and turned out by 17 degrees.
ANYHOW = [
    *(f"~{POSE}.{joint}" for joint in ("hip_y", "ankle_y")),
    *(f"+{POSE}.{joint}" for joint in ("hip_y_l=0.25", "hip_y_r=-0.03", "hip_z_l=0.3")),
    *(f"+{POSE}.{joint}" for joint in ("ankle_y_l=0.004", "ankle_y_r=0.285")),
]


@pytest.mark.parametrize("seed", [2000, 2001, 2002])
def test_feet_come_beside_each_other(seed):
    log, model = simulated("behaviour=gather", f"seed={seed}", "duration=5", *ANYHOW)
    (ahead, _), turned = stance(model, log, 0)
    assert abs(ahead) > 0.2
    assert abs(turned) > 10.0
    (ahead, wide), turned = stance(model, log, -1)
    assert abs(ahead) < 0.05
    assert 0.18 < wide < 0.3
    assert abs(turned) < 6.0
    assert np.abs(log["trajectory/com_velocity"][-240:]).max() < 0.05  # for a second
    touching = {int(body) for body in log["contacts/body"].ravel() if body >= 0}
    assert touching == {model.mj.body(name).id for name in ("foot_l", "foot_r")}


@pytest.mark.parametrize("seed", [2000, 2001])
def test_arms_come_overhead_and_knees_stay_off_their_stops(seed):
    log, model = simulated("behaviour=raise", f"seed={seed}", "duration=2.3", "start=poised")
    angles = dict(zip(model.joint_names, log["trajectory/qpos"][-1][model.angles], strict=True))
    up = log["trajectory/trunk_axes"][-1, 2, 2]
    assert up > cos(radians(5.0))
    for side in ("l", "r"):
        assert angles[f"shoulder_y_{side}"] == pytest.approx(2.9, abs=0.05)
        assert angles[f"knee_{side}"] > 0.1
    assert np.abs(log["trajectory/com_velocity"][-1]).max() < 0.05


@pytest.mark.parametrize("seed", [2001, 2003])
def test_knees_are_off_their_stops_until_a_cartwheel_steps(seed):
    """It stands for 0.8 s first, and comes up to its full height meanwhile."""
    parts = "behaviour.parts=[raise,cartwheel]"
    chain = ["behaviour=chain", parts, "behaviour.between=null", f"seed={seed}", "duration=3.5"]
    log, model = simulated(*chain)
    angles = dict(zip(model.joint_names, log["trajectory/qpos"][-1][model.angles], strict=True))
    assert log["command/stage"][-1] == 3  # the cartwheel's first
    assert min(angles["knee_l"], angles["knee_r"]) > 0.08


@pytest.mark.parametrize(
    ("body", "other", "side"), [("foot_r", "foot_l", -1), ("foot_l", "foot_r", 1)]
)
def test_a_foot_that_is_put_beside_the_other_is_there_in_time(body, other, side):
    """At rest as it begins, least in the square: 6 s / T^2."""
    scenario = build(load(["behaviour=gather", "seed=2000", "duration=0.1"]))
    behaviour, seen = scenario.behaviour, []
    plain = behaviour._scene
    behaviour._scene = lambda memory, state: seen.append(plain(memory, state)) or seen[-1]
    in_memory(scenario)
    scene = seen[0]
    mj, data = scene.model.mj, scene.state.data
    row = np.zeros(1, TASK)[0]
    row["body"], row["point"] = mj.body(body).id, [0.0475, 0.0, -0.038]
    Beside("beside", other, 0.3, 0.4, 0.05, 0.029).fill(row, "point", scene)
    soles = {
        name: data.body(name).xpos + data.body(name).xmat.reshape(3, 3) @ row["point"]
        for name in ("foot_l", "foot_r")
    }
    forward, left, _ = scene.axes
    way = soles[other] + side * 0.3 * left - soles[body]
    for axis in (forward, left):
        wanted = 6.0 * (way @ axis) / 0.4**2
        assert row["acceleration"] @ axis == pytest.approx(wanted, abs=0.6)  # it sways a little
    assert row["velocity"][2] == pytest.approx(0.05 * np.pi / 0.4)


# ---------------------------------------------------------------- help


def simulated(*overrides):
    scenario = build(load([*overrides]))
    buffer, ending = in_memory(scenario)
    assert not ending
    return buffer.arrays(), scenario.model


def stance(model, log, row):
    """Of the left foot from the right one: ahead and to the left [m], and turned to it [deg]."""
    data = mujoco.MjData(model.mj)
    data.qpos[:] = log["trajectory/qpos"][row]
    mujoco.mj_kinematics(model.mj, data)
    left, right = data.body("foot_l"), data.body("foot_r")
    fronts = [foot.xmat.reshape(3, 3)[:2, 0] for foot in (left, right)]
    front = sum(fronts) / np.linalg.norm(sum(fronts))
    way = (left.xpos - right.xpos)[:2]
    angles = [np.arctan2(y, x) for x, y in fronts]
    return (way @ front, way @ [-front[1], front[0]]), degrees(angles[0] - angles[1])
