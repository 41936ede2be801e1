"""Which of the trunk's axes lies on the rolling axis, and how a character is put there."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.behaviours.facing import FACING
from rotctl.config.loading import load
from rotctl.mechanics.state import read
from rotctl.runs import scenario
from rotctl.simulation.placing import place
from rotctl.simulation.start import Start

# World direction of the trunk's front, left and up at phase 0.
AT_PHASE_0 = {
    "left": ([1, 0, 0], [0, 1, 0], [0, 0, 1]),  # upright, facing the way it rolls
    "right": ([-1, 0, 0], [0, -1, 0], [0, 0, 1]),  # upright, its back to the way it rolls
    "head": ([0, 0, 1], [1, 0, 0], [0, 1, 0]),  # on its back, the head to the left of the way
}


@pytest.mark.parametrize("about", FACING)
def test_orientation_at_phase_0(about):
    axes = Rotation.from_quat(FACING[about].orientation, scalar_first=True).as_matrix()
    assert np.abs(axes.T - AT_PHASE_0[about]).max() < 1e-12
    assert axes @ FACING[about].trunk_axis == pytest.approx([0, 1, 0], abs=1e-12)


@pytest.mark.parametrize("about", FACING)
def test_a_start_turns_about_the_rolling_axis(about):
    made = scenario.build(
        load(["behaviour.alighting=null", "behaviour.catch=null", f"behaviour.roll_about={about}"])
    )
    data = mujoco.MjData(made.model.mj)
    for pitch in (0.0, 0.7, 2.0):
        usual = replace(made.behaviour.start(pitch), pose=np.zeros(made.model.mj.nu))
        place(made.model, data, Start(pitch, *np.zeros((2, 3))), usual, made.behaviour.axes)
        mujoco.mj_kinematics(made.model.mj, data)
        pelvis = data.xmat[1].reshape(3, 3)
        expected = Rotation.from_euler("y", pitch).as_matrix() @ np.array(AT_PHASE_0[about]).T
        assert pelvis == pytest.approx(expected, abs=1e-12)
        mujoco.mj_step1(made.model.mj, data)
        state = read(made.model, data)
        memory = made.behaviour.begin(pitch, state)
        axis = made.behaviour.signals(memory, state).axis
        assert axis == pytest.approx([0, 1, 0], abs=1e-12)
