"""Two key poses over the phase."""

import math

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.motion import Poses, make_pose, make_pose_pair


def value(model, poses, name):
    return poses[model.joint_names.index(name)]


def test_constant_and_varying_angles(world):
    pair = make_pose_pair(world.model, Poses({"knee_l": 1.0}, {"hip_y_r": (1.0, 0.3, -0.4)}))
    for phase in (-9.0, 0.0, 1.3, 2.0, 50.0):
        a, b = pair.at(phase)
        assert value(world.model, a, "knee_l") == 1.0
        assert value(world.model, b, "hip_y_r") == pytest.approx(
            1.0 + 0.3 * math.cos(phase) - 0.4 * math.sin(phase), abs=1e-12
        )


def test_a_name_without_side_means_both(world):
    a, b = make_pose_pair(world.model, Poses({"elbow": 0.7, "waist_y": 0.2}, {})).at(0.0)
    named = {"elbow_l": 0.7, "elbow_r": 0.7, "waist_y": 0.2}
    assert a.tolist() == [named.get(name, 0.0) for name in world.model.joint_names]
    assert not b.any()


def test_a_later_name_wins(world):
    a, _ = make_pose_pair(world.model, Poses({"elbow": 0.7, "elbow_r": 1.1}, {})).at(0.0)
    assert value(world.model, a, "elbow_l") == 0.7
    assert value(world.model, a, "elbow_r") == 1.1


def test_whole_numbers_are_angles_too(world):
    a, _ = make_pose_pair(world.model, Poses({"knee": 1}, {})).at(0.0)
    assert value(world.model, a, "knee_r") == 1.0


def test_clipped_to_the_joint_ranges(world):
    a, b = make_pose_pair(world.model, Poses({"knee": 9.0}, {"knee": (0.0, 9.0, 0.0)})).at(math.pi)
    low, high = world.model.joint_range[world.model.joint_names.index("knee_l")]
    assert value(world.model, a, "knee_l") == high
    assert value(world.model, b, "knee_l") == low


@pytest.mark.parametrize("key", ["a", "b"])
def test_unknown_joint(world, key):
    poses = {"a": {}, "b": {}, key: {"kne": 1.0}}
    with pytest.raises(InputError) as error:
        make_pose_pair(world.model, Poses(poses["a"], poses["b"]))
    assert str(error.value) == (
        f"behaviour.poses.{key} names the unknown joint 'kne'; did you mean knee? "
        "valid: ankle_x, ankle_y, chest_x, "
        "chest_y, chest_z, elbow, hip_x, hip_y, hip_z, knee, neck_x, neck_y, neck_z, shoulder_x, "
        "shoulder_y, shoulder_z, waist_x, waist_y, waist_z, limb joints also with _l or _r"
    )


def test_shapes(world):
    pair = make_pose_pair(world.model, Poses({}, {}))
    assert pair.at(0.0).shape == (2, len(world.model.joint_names))
    assert np.array_equal(pair.low, world.model.joint_range[:, 0])


def test_waves_of_multiples_of_the_phase(world):
    """Beside shorter ones, in Python; and in C, which a roll looks its poses up in."""
    waves = (0.6, 0.1, -0.2, 0.05, 0.1, -0.1, 0.02)
    pair = make_pose_pair(world.model, Poses({"elbow": waves, "knee": (0.9, 0.1, 0.2)}))
    for phase in (-2.0, 0.7, 4.0):
        elbow = waves[0] + sum(
            waves[2 * n - 1] * math.cos(n * phase) + waves[2 * n] * math.sin(n * phase)
            for n in (1, 2, 3)
        )
        assert value(world.model, pair.at(phase)[0], "elbow_r") == pytest.approx(elbow, abs=1e-12)
        knee = 0.9 + 0.1 * math.cos(phase) + 0.2 * math.sin(phase)
        assert value(world.model, pair.at(phase)[1], "knee_l") == pytest.approx(knee, abs=1e-12)


@pytest.mark.parametrize("angle", ["[1,2]", "[1,2,3,4]", "[0,0,0,0,0,0,0,0,0,0,0]"])
def test_a_mean_and_pairs_and_nothing_else(angle):
    with pytest.raises(InputError):
        load([f"behaviour.poses.a.knee={angle}"])


def test_a_single_pose_keeps_to_the_ranges_of_joints(world):
    low, high = world.model.joint_range[world.model.joint_names.index("knee_l")].tolist()
    pose = make_pose(world.model, {"knee": high, "waist_y": 0.1}, "start")
    assert pose[world.model.joint_names.index("knee_r")] == high
    for angle in (low - 0.1, high + 0.1):
        with pytest.raises(InputError) as error:
            make_pose(world.model, {"knee": angle}, "behaviour.stages.4.glide.end")
        assert str(error.value) == (
            f"behaviour.stages.4.glide.end.knee={angle:g}: "
            f"this joint goes from {low:.4g} to {high:.4g} rad"
        )
