"""Real simulations that are no rolls, though they turn: the verdict is not fooled."""

import re
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.metrics.criteria.rolling import measure
from rotctl.metrics.criteria.rolling_rules import failure_reason
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.runs.summary import summarise

DOCS = Path(__file__).parents[1] / "docs"


def judged(*overrides):
    scenario = build(load(list(overrides)))
    buffer, breakdown = in_memory(scenario)
    return summarise(scenario, buffer, breakdown, 1.0)


def test_spinning_in_the_air():
    """Nearly without gravity the start's spin goes on, and no stall is seen."""
    summary = judged(
        "behaviour=forward_roll_1_on_head", "physics.gravity=[0,0,-0.01]", "duration=6"
    )
    assert summary["revolutions"] > 3.0
    assert summary["longest_stall"] < 1.5
    assert summary["failure_reason"].startswith("turned in the air: 1.")


@pytest.mark.parametrize("seed", range(3))
def test_leaping_down_a_steep_slope(seed):
    summary = judged(
        "behaviour=decline_flowing", "terrain.angle=-30", "duration=12", f"seed={seed}"
    )
    assert summary["revolutions"] > 10.0
    assert summary["flight_turn"] > 0.7
    assert not summary["success"]


def test_falling_limp_for_less_than_a_stall_may_last():
    summary = judged("controller.pose.stiffness=0", "duration=1.4")
    assert summary["longest_stall"] < 1.5
    assert "before a whole revolution: it turned 0." in summary["failure_reason"]


@pytest.mark.parametrize("overrides", [["terrain.angle=-20"], ["behaviour.angular_velocity=1.3"]])
def test_sliding_down_an_icy_slope(overrides):
    ice = ["terrain.friction=0.02"]
    assert not judged("behaviour=decline_flowing", "duration=6", *ice, *overrides)["success"]


@pytest.fixture(scope="module")
def roll():
    """Config and arrays of a real roll, which is one."""
    scenario = build(load(["duration=8"]))
    buffer, _ = in_memory(scenario)
    arrays = buffer.arrays()
    assert verdict(scenario.config, arrays) == ""
    return scenario.config, arrays


def verdict(config, arrays):
    rate, period = config.behaviour.angular_velocity, 1 / config.controller.rate
    metrics = measure(arrays, config.criteria, rate, period, whole=True)
    return failure_reason(metrics, config.criteria, config.duration)


def test_a_roll_whose_ground_ends(roll):
    """From the sixth second on, by Newton."""
    config, arrays = roll
    com, force = arrays["trajectory/com"].copy(), arrays["contacts/ground_force"].copy()
    fall = np.maximum(arrays["trajectory/time"] - 6.0, 0.0)
    com[:, 2] -= 0.5 * 9.81 * fall**2
    force[fall > 0] = 0.0
    changed = arrays | {"trajectory/com": com, "contacts/ground_force": force}
    assert verdict(config, changed).startswith("fell: centre of mass -1")
    assert verdict(config, arrays | {"contacts/ground_force": force}).startswith("turned in the")


def test_a_roll_of_a_body_whose_trunk_is_held(roll):
    """Everything as in the roll, but the pelvis keeps its attitude."""
    config, arrays = roll
    position = arrays["trajectory/qpos"].copy()
    position[:, 3:7] = position[0, 3:7]
    reason = verdict(config, arrays | {"trajectory/qpos": position})
    assert reason == "the trunk did not turn along: 0.00 rev in a revolution"


@pytest.mark.parametrize("criteria", ["rolling", "terrain"])
def test_the_numbers_of_the_criteria_are_those_of_a_roller(criteria):
    """An upright body is 0.99 m high, its thickest part 0.12 m; see the reasons in conf/."""
    config = load([f"criteria={criteria}"])
    model = build(config).model.mj
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    limits = config.criteria
    assert limits.height[0] < min(model.geom_size[model.geom_contype == 1, 0].max(), 0.12)
    assert limits.height[1] < data.subtree_com[1][2] + 0.02
    assert limits.penetration <= model.geom_size[model.geom_contype == 1, 0].max()


# ---------------------------------------------------------------- the height of the ground


@pytest.mark.parametrize(
    ("overrides", "within"),
    [
        (["behaviour=forward_roll_1"], 1e-5),
        (["behaviour=incline"], 1e-5),
        (["behaviour=stairs"], 1e-5),
        (["behaviour=terrain_roll", "terrain=obstacles", "seed=2"], 1e-5),
        (["behaviour=uneven_terrain", "seed=1"], 0.005),  # flat triangles in MuJoCo
    ],
)
def test_the_ground_below_is_what_a_ray_downwards_meets(overrides, within):
    scenario = build(load([*overrides, "duration=5"]))
    model = scenario.model.mj
    trajectory = in_memory(scenario)[0].trajectory
    data = mujoco.MjData(model)
    data.qpos[:3] = 1e3  # the character is out of the way
    mujoco.mj_forward(model, data)
    heights, hit = [], np.zeros(1, dtype=np.int32)
    for com, found in zip(trajectory.com, trajectory.ground_height, strict=True):
        above = np.array([com[0], com[1], 20.0])
        down = np.array([0.0, 0.0, -1.0])
        distance = mujoco.mj_ray(model, data, above, down, None, 1, -1, hit)
        heights.append(20.0 - distance)
        assert found == pytest.approx(heights[-1], abs=within)
    assert np.ptp(heights) > 0.02 or overrides == ["behaviour=forward_roll_1"]


def test_without_a_ground_nothing_is_a_roll(roll):
    config, arrays = roll
    nowhere = np.full_like(arrays["trajectory/ground_height"], np.nan)
    assert verdict(config, arrays | {"trajectory/ground_height": nowhere}).startswith("fell: ")
    assert verdict(replace(config, duration=9.0), arrays) == "ended after 8.00 of 9 s"


# ---------------------------------------------------------------- the page


@pytest.mark.parametrize(("criteria", "column"), [("rolling", 2), ("terrain", 3)])
def test_docs_verdict_has_the_limits(criteria, column):
    """Each cell begins with the limit; `the same` is that of level ground."""
    limits, told = load([f"criteria={criteria}"]).criteria, {}
    page = (DOCS / "verdict.md").read_text(encoding="utf-8")
    for line in re.findall(r"^\| .*`.* \|$", page, flags=re.MULTILINE):
        cells = line.split("|")
        cell = cells[2] if cells[column].strip() == "the same" else cells[column]
        numbers = [float(n) for n in re.findall(r"\d+(?:\.\d+)?", cell.split(";")[0])]
        for name in re.findall(r"`(\w+)`", cells[1]):
            told.setdefault(name, []).extend(numbers[: 2 if name == "travel" else 1])
            numbers = numbers[1:] or numbers
    wanted = {
        name: list(value) if isinstance(value, tuple) else [value]
        for name, value in vars(limits).items()
        if isinstance(value, float | tuple) and name != "settle" and "recovery" not in name
    }
    assert told == wanted
