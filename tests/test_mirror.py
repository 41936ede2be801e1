"""The symmetric part of a motion, whichever way it faces."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.config.loading import load
from rotctl.motion.mirror import symmetric
from rotctl.motion.turning import Motion
from rotctl.runs.scenario import model_of


@pytest.mark.parametrize("yaw", [0.0, 180.0])
def test_a_turn_in_the_plane_stays_and_what_leaves_it_goes(yaw):
    """Forward and backward: a body whose back is to the way has no w and no y."""
    model, turn = model_of(load([])), np.linspace(0.0, 350.0, 36)
    facing = Rotation.from_euler("z", yaw, degrees=True)
    in_plane = Rotation.from_euler("y", turn[:, None], degrees=True) * facing
    aside = Rotation.from_euler("x", 10.0, degrees=True)
    poses = np.zeros((len(turn), len(model.joint_names)))
    for pelvis in (in_plane, in_plane * aside):
        found = symmetric(model, Motion(poses, pelvis)).pelvis
        assert np.abs((found * in_plane.inv()).magnitude()).max() < 1e-6
