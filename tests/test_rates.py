"""Control at other rates, with the same numbers: no gain and no weight carries the period."""

from dataclasses import replace

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

RATES = [(30, 8), (60, 4), (120, 2), (240, 1)]  # [Hz], physics steps a control step


@pytest.mark.parametrize(("rate", "substeps"), RATES)
@pytest.mark.parametrize("behaviour", ["forward_roll_2", "backward_roll_1"])
def test_it_rolls_at_any_rate(rate, substeps, behaviour):
    """The physics' own step is the same. Of three starts two or more turn so far in 4 s."""
    rates = [f"controller.rate={rate}", f"physics.substeps={substeps}"]
    turns = []
    for seed in (2000, 2001, 2002):
        scenario = build(load([f"behaviour={behaviour}", *rates, f"seed={seed}", "duration=4"]))
        buffer, breakdown = in_memory(scenario)
        assert not breakdown
        turned = buffer.trajectory.angular_excursion @ scenario.behaviour.axes[1]
        turns.append(turned[-1] - turned[0])
    assert np.median(turns) > 2.0 * 2 * np.pi


@pytest.mark.parametrize(("rate", "fades"), [(30.0, 30.0), (60.0, 60.0), (120.0, 60.0)])
def test_contacts_fade_at_their_damping_and_no_faster_than_in_a_period(
    world, supported, rate, fades
):
    """With damping 60 1/s: at 60 Hz, to zero by the end of the period."""
    settings = replace(world.settings, rate=rate)
    for step in supported[::20]:
        state, stack = world.stack(step, settings=settings)
        assert step.command.contact.damping == 60.0
        m = stack.contacts
        expected = -fades * (stack.jacobian @ state.velocity)
        assert stack.wanted[: 3 * m] == pytest.approx(expected, abs=1e-9)
        assert (stack.weight[: 3 * m] == step.command.contact.weight).all()


def test_the_blend_is_weighed_by_its_rate(world, supported):
    """The same change of gamma a second costs the same in any number of steps."""
    costs = []
    for rate in (30.0, 60.0, 240.0):
        _, stack = world.stack(supported[0], settings=replace(world.settings, rate=rate))
        stack = replace(stack, pose_a=world.stack(supported[0])[1].pose_a)
        stack = replace(stack, pose_b=world.stack(supported[0])[1].pose_b)
        change = 0.3 / rate  # of gamma in one period, at 0.3 a second
        costs.append(stack.blend_weight * change**2)
    assert costs == pytest.approx([costs[0]] * 3, rel=1e-12)


def test_poses_look_equally_far_ahead(world, supported):
    """The horizon is a time of its own where it is longer than a period."""
    ahead = replace(supported[0].command.pose, horizon=1 / 30)
    command = supported[0].command._replace(pose=ahead)
    torques = []
    for rate in (30.0, 60.0, 240.0):
        _, stack = world.stack(supported[0], command, replace(world.settings, rate=rate))
        torques.append(stack.pose_a)
    assert torques[1] == pytest.approx(torques[0], rel=1e-9)
    assert torques[2] == pytest.approx(torques[0], rel=1e-9)
