"""Short real rolls: the character must keep rolling, straight, within its limits."""

from dataclasses import replace

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.runs.summary import summarise


def roll(*overrides):
    """Summary and buffer of a simulated roll."""
    scenario = build(load(list(overrides)))
    buffer, breakdown = in_memory(scenario)
    return summarise(scenario, buffer, breakdown, 1.0), buffer


@pytest.mark.parametrize("behaviour", ["forward_roll_1", "forward_roll_1_phase"])
@pytest.mark.parametrize("seed", [0, 17])
def test_it_keeps_rolling(behaviour, seed):
    summary, buffer = roll(f"behaviour={behaviour}", f"seed={seed}", "duration=8")
    assert summary["success"], summary["failure_reason"]
    assert summary["revolutions"] > 4.0
    assert 1.0 < summary["speed_mean"] < 2.0
    assert np.ptp(buffer.trajectory.com[:, 2]) < 0.6  # on the ground, no leaps


def test_it_uses_the_whole_body():
    """Feet, hands, back and pelvis take turns."""
    scenario = build(load([]))
    _, buffer = roll("duration=6")
    body, used = buffer.contacts.body, buffer.contacts.used
    names = {scenario.model.mj.body(int(b)).name for b in np.unique(body[used])}
    assert {"foot_l", "foot_r", "forearm_l", "forearm_r", "chest", "pelvis"} <= names


def test_a_symmetric_start_stays_in_plane():
    _, buffer = roll("start=symmetric", "duration=3")
    assert np.abs(buffer.trajectory.com[:, 1]).max() <= 1e-4
    assert np.abs(buffer.trajectory.trunk_axis[:, [0, 2]]).max() <= 1e-4


def test_forces_in_the_log_explain_the_momentum():
    """Newton's second law over the log, at a step fine enough for first-order integration."""
    scenario = build(load([]))
    _, buffer = roll("controller.rate=960", "physics.substeps=1", "duration=0.5")
    force = buffer.contacts.force_realised.astype(float).sum(axis=1)
    weight = scenario.model.mass * scenario.model.gravity
    impulse = np.cumsum(force[:-1] + weight, axis=0) / 960.0
    gained = buffer.trajectory.linear_momentum[1:] - buffer.trajectory.linear_momentum[0]
    assert np.abs(gained).max() > 20.0  # [N s]
    assert np.abs(gained - impulse).max() < 0.05 * np.abs(gained).max()


def test_without_the_pose_objective_it_does_not_roll():
    """A test that can fail: the measures tell a limp body from a roll."""
    summary, _ = roll("controller.pose.stiffness=0", "duration=6")
    assert not summary["success"]
    assert summary["failure_reason"].startswith("stalled for ")


def test_the_commanded_direction_counts():
    """Rolling forwards under a backward command is a stall."""
    scenario = build(load(["duration=2"]))
    buffer, _ = in_memory(scenario)
    backward = replace(scenario.config.behaviour, angular_velocity=-1.3)
    config = replace(scenario.config, behaviour=backward)
    summary = summarise(replace(scenario, config=config), buffer, "", 1.0)
    assert not summary["success"]
