"""Start states are drawn from their ranges, the same for the same seed."""

from dataclasses import replace

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.runs import scenario
from rotctl.runs.run import in_memory
from rotctl.simulation.episode import Episode
from rotctl.simulation.sampling import draw
from rotctl.simulation.start import Posture, StartSettings

RANGES = StartSettings(
    name="test",
    pitch=(-0.6, 0.0),
    speed_x=(0.6, 1.4),
    speed_y=(-0.1, 0.1),
    angular_velocity_x=(-0.4, 0.4),
    angular_velocity_y=(3.0, 7.0),
    angular_velocity_z=(-0.5, -0.4),
)


def test_draw_stays_in_its_ranges_and_fills_them(world):
    generator = np.random.default_rng(0)
    drawn = [draw(RANGES, world.model, "left", generator) for _ in range(200)]
    for values, (low, high) in (
        ([s.pitch for s in drawn], RANGES.pitch),
        ([s.velocity[0] for s in drawn], RANGES.speed_x),
        ([s.velocity[1] for s in drawn], RANGES.speed_y),
        ([s.angular_velocity[0] for s in drawn], RANGES.angular_velocity_x),
        ([s.angular_velocity[1] for s in drawn], RANGES.angular_velocity_y),
        ([s.angular_velocity[2] for s in drawn], RANGES.angular_velocity_z),
    ):
        assert low <= min(values) < low + 0.1 * (high - low)
        assert high - 0.1 * (high - low) < max(values) <= high
    assert all(s.velocity[2] == 0.0 for s in drawn)


@pytest.mark.parametrize("override", ["start.speed_x=[0.0,-0.0]", "start.scatter=-0.0"])
def test_what_is_zero_with_a_sign_is_zero(override):
    begun = [
        Episode(scenario.build(load(["behaviour=stand", more]))).data
        for more in (override, override.replace("-0.0", "0.0"))
    ]
    assert begun[0].qpos.tobytes() == begun[1].qpos.tobytes()
    assert begun[0].qvel.tobytes() == begun[1].qvel.tobytes()


def test_same_seed_same_state(world):
    def first_state(seed):
        made = scenario.build(replace(world.config, seed=seed, start=RANGES))
        data = Episode(made).data
        return data.qpos.tobytes() + data.qvel.tobytes()

    assert first_state(5) == first_state(5)
    assert first_state(5) != first_state(6)


def test_an_empty_range_draws_its_value(world):
    fixed = replace(RANGES, pitch=(-0.3, -0.3))
    assert draw(fixed, world.model, "left", np.random.default_rng(1)).pitch == -0.3


# ---------------------------------------------------------------- postures

WAITING = replace(
    RANGES,
    scatter=0.1,
    postures={"left": Posture(pitch=1.0, pose={"hip_y": 1.5, "knee_l": 2.69, "waist_x": -0.2})},
)


def test_a_posture_is_drawn_around_what_it_says(world):
    generator = np.random.default_rng(0)
    drawn = [draw(WAITING, world.model, "left", generator) for _ in range(200)]
    poses = np.array([start.pose for start in drawn])
    low, high = world.model.joint_range.T
    wanted = dict.fromkeys(world.model.joint_names, 0.0) | {
        "hip_y_l": 1.5,
        "hip_y_r": 1.5,
        "knee_l": 2.69,
        "waist_x": -0.2,
    }
    for found, middle, least, most in zip(poses.T, wanted.values(), low, high, strict=True):
        assert found.min() >= max(middle - 0.1, least)
        assert found.max() <= min(middle + 0.1, most)
        assert found.min() < max(middle - 0.09, least + 1e-9)
        assert found.max() > min(middle + 0.09, most - 1e-9)
    assert np.corrcoef(poses[:, :2].T)[0, 1] == pytest.approx(0.0, abs=0.2)  # each by itself
    assert 0.4 <= min(s.pitch for s in drawn) < max(s.pitch for s in drawn) <= 1.0


def test_a_posture_leaves_the_other_draws_alone(world):
    with_posture = draw(WAITING, world.model, "left", np.random.default_rng(3))
    without = draw(RANGES, world.model, "left", np.random.default_rng(3))
    assert without.pose is None
    assert with_posture.pitch == without.pitch + 1.0
    assert with_posture.velocity.tolist() == without.velocity.tolist()
    assert with_posture.angular_velocity.tolist() == without.angular_velocity.tolist()


@pytest.mark.parametrize("behaviour", ["forward_roll_1", "forward_roll_1_phase", "decline"])
def test_a_roll_begins_from_still(behaviour):
    made = scenario.build(load([f"behaviour={behaviour}", "start=still", "duration=3", "seed=1"]))
    buffer, breakdown = in_memory(made)
    assert not breakdown
    angle = buffer.arrays()["trajectory/angular_excursion"][:, 1]
    assert angle[-1] - angle[0] > 2 * np.pi


def test_a_posture_that_does_not_fit(world):
    generator = np.random.default_rng(0)
    with pytest.raises(InputError) as error:
        draw(WAITING, world.model, "head", generator)
    assert str(error.value) == (
        "start=test is for who faces along the way (roll_about=left), and the behaviour is for who "
        "lies across the way (behaviour.roll_about=head); "
        "valid: long, prone, rest, side, still, supine, symmetric, tucked, tucked_back"
    )
    tailed = replace(WAITING, postures={"left": Posture(pitch=0.0, pose={"tail": 1.0})})
    with pytest.raises(InputError) as error:
        draw(tailed, world.model, "left", generator)
    assert str(error.value).startswith(
        "start.postures.left.pose names the unknown joint 'tail'; valid: ankle_x, ankle_y, "
    )
