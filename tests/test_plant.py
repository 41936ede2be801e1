"""A simulated character that is another than the one that control knows."""

from itertools import islice

import mujoco
import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.mechanics.bodies import is_character
from rotctl.mechanics.plant import Motors
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build, model_of
from rotctl.simulation.episode import Episode

RANDOMISED = ("plant=randomised",)


def made(*overrides):
    return build(load(["seed=2001", *overrides]))


def moments(seconds, *overrides):
    scenario = made(*overrides)
    return list(islice(Episode(scenario), round(60 * seconds)))


# ---------------------------------------------------------------- another body


def test_each_segment_has_its_own_mass_and_inertia_within_the_share():
    scenario = made("plant=randomised", "plant.mass=0.1")
    plant, known = scenario.model.mj, scenario.known.mj
    ours = np.flatnonzero(is_character(known))
    factor = plant.body_mass[ours] / known.body_mass[ours]
    assert factor.min() >= 0.9 - 1e-5
    assert factor.max() <= 1.1 + 1e-5
    assert len(set(factor.round(4))) > len(ours) / 2  # left and right differ, too
    inertia = plant.body_inertia[ours] / known.body_inertia[ours]
    assert inertia == pytest.approx(np.repeat(factor[:, None], 3, axis=1), rel=1e-4)


def test_motors_and_ground_differ_and_control_keeps_what_it_knew():
    scenario = made("plant=randomised", "plant.friction=[0.5,0.6]")
    strength = scenario.model.torque_limit / scenario.known.torque_limit
    assert 0.9 - 1e-5 <= strength.min() < 0.97 < 1.03 < strength.max() <= 1.1 + 1e-5
    floor, known = (
        model.mj.geom("ground").friction[0] for model in (scenario.model, scenario.known)
    )
    assert 0.5 <= floor / known <= 0.6
    assert scenario.known is model_of(scenario.config)
    assert scenario.controller.model is scenario.known


def test_loose_things_on_the_ground_are_as_they_were():
    scenario = made("plant=randomised", "terrain=hazards", "behaviour=terrain_roll")
    plant, known = scenario.model.mj, scenario.known.mj
    loose = ~is_character(known)
    assert plant.body_mass[loose] == pytest.approx(known.body_mass[loose])


def test_it_is_drawn_from_the_seed():
    bodies = [made("plant=randomised", f"seed={seed}").model.mj.body_mass for seed in (7, 7, 8)]
    assert np.array_equal(bodies[0], bodies[1])
    assert not np.array_equal(bodies[0], bodies[2])


def test_a_nominal_plant_is_the_known_model_itself():
    scenario = made()
    assert scenario.model is scenario.known
    assert scenario.observer is scenario.controller
    assert all(moment.state is moment.truth for moment in moments(0.1))


def test_the_log_has_the_body_that_was_simulated():
    scenario = made(*RANDOMISED, "duration=0.2")
    buffer, _ = in_memory(scenario)
    mj = mujoco.MjModel.from_xml_string(scenario.model.mjcf)
    data = mujoco.MjData(mj)
    data.qpos[:], data.qvel[:] = buffer.trajectory.qpos[0], buffer.trajectory.qvel[0]
    for torque, position in zip(buffer.trajectory.ctrl, buffer.trajectory.qpos, strict=True):
        assert np.array_equal(data.qpos, position)
        data.ctrl[:] = torque
        mujoco.mj_step(mj, data, scenario.config.physics.substeps)


# ---------------------------------------------------------------- late torques


@pytest.mark.parametrize("delay", [0, 1, 3])
def test_torques_act_so_many_control_steps_later(delay):
    motors = Motors(made().model, delay)
    asked = [np.full(29, float(i)) for i in range(8)]
    acting = [motors.act(torque)[0] for torque in asked]
    assert acting == [float(max(0, i - delay)) for i in range(8)]
    assert [torque[0] for torque in motors.pending] == [8.0 - delay + i for i in range(delay)]


def test_what_the_body_has_not_does_not_act():
    scenario = made("plant=randomised")
    limit = scenario.model.torque_limit
    assert np.array_equal(Motors(scenario.model, 0).act(np.full(29, 1e9)), limit)
    assert np.array_equal(Motors(scenario.model, 0).act(np.full(29, -1e9)), -limit)


@pytest.mark.parametrize("delay", [1, 2])
def test_a_prediction_is_the_state_in_which_the_torque_acts(delay):
    """Where nothing but the delay differs, to within the tolerance of the contact solver."""
    steps = moments(1.0, f"plant.delay={delay}", "plant.predicted=true")
    for seen, later in zip(steps, steps[delay:], strict=False):
        assert np.array_equal(later.torque, seen.decision.torque)
    for seen, later in zip(steps[1:], steps[1 + delay :], strict=False):  # none is pending at first
        assert seen.state.position == pytest.approx(later.truth.position, abs=1e-4)
        assert seen.state.velocity == pytest.approx(later.truth.velocity, abs=1e-3)


def test_a_prediction_that_breaks_down_is_told_and_not_used():
    """Control saw joints that move at up to 300 rad/s; what is simulated goes on."""
    scenario = made("plant.delay=2", "plant.predicted=true", "plant.rate_noise=100", "duration=0.5")
    buffer, _ = in_memory(scenario)
    told = [t for t, text in buffer.events if text.startswith("the prediction broke down")]
    assert told
    assert min(told) < buffer.trajectory.time[-1] - 0.1


@pytest.mark.parametrize("key", ["angle_noise", "rate_noise", "velocity_noise"])
def test_nobody_sees_that_badly(key):
    with pytest.raises(InputError, match=f"plant.{key}=1000000.0: must be less than or equal to"):
        load([f"plant.{key}=1e6"])


def test_a_prediction_without_a_delay_is_refused():
    with pytest.raises(InputError, match="predicted is about a delay, and there is none"):
        load(["plant.predicted=true"])


def test_a_prediction_by_other_physics_than_the_simulated_is_refused():
    with pytest.raises(InputError) as caught:
        made("plant=randomised", "physics=lockstep")
    assert str(caught.value) == (
        "plant=randomised predicts with MuJoCo's own contacts; with physics=lockstep give "
        "plant.predicted=false"
    )


# ---------------------------------------------------------------- noisy senses


def test_noise_has_the_standard_deviations_that_are_asked_for():
    steps = moments(
        2.0, "plant.angle_noise=0.01", "plant.rate_noise=0.2", "plant.velocity_noise=0.05"
    )
    angle = [step.state.position[7:] - step.truth.position[7:] for step in steps]
    rate = [step.state.velocity[3:] - step.truth.velocity[3:] for step in steps]
    velocity = [step.state.velocity[:3] - step.truth.velocity[:3] for step in steps]
    assert np.std(angle) == pytest.approx(0.01, rel=0.1)
    assert np.std(rate) == pytest.approx(0.2, rel=0.1)
    assert np.std(velocity) == pytest.approx(0.05, rel=0.2)
    lengths = [np.linalg.norm(step.state.position[3:7]) for step in steps]
    assert lengths == pytest.approx([1.0] * len(steps))


def test_the_log_tells_what_there_was_and_not_what_was_seen():
    scenario = made("plant.angle_noise=0.01", "duration=0.5")
    buffer, _ = in_memory(scenario)
    steps = moments(0.5, "plant.angle_noise=0.01")
    assert np.array_equal(buffer.trajectory.qpos, [step.truth.position for step in steps])
    assert np.array_equal(buffer.trajectory.com, [step.truth.momentum.com for step in steps])


# ---------------------------------------------------------------- and it rolls


@pytest.mark.parametrize("behaviour", ["forward_roll_1", "backward_roll_1"])
def test_a_randomised_body_rolls(behaviour):
    """Measured from 20 of 20 starts over 20 s: see docs/robustness.md."""
    ends = []
    for seed in range(2000, 2003):
        scenario = made(f"behaviour={behaviour}", *RANDOMISED, f"seed={seed}", "duration=6")
        buffer, broken = in_memory(scenario)
        assert not broken
        ends.append(abs(buffer.trajectory.phase[-1] - buffer.trajectory.phase[0]))
    assert np.median(ends) > 2.5 * 2 * np.pi
