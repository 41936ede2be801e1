"""What the paper tried and rejected: each config asks the controller for what its name says."""

import re

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rotctl.behaviours.facing import FACING
from rotctl.config.loading import load
from rotctl.control.kinds import KINDS
from rotctl.errors import InputError
from rotctl.maths.rotations import rotate
from rotctl.mechanics.state import read
from rotctl.runs import scenario
from rotctl.runs.run import in_memory


def at_a_state(overrides):
    """A scenario with a state in it, in which pelvis and whole body turn differently."""
    made = scenario.build(load(overrides))
    mj, rng = made.model.mj, np.random.default_rng(4)
    data = mujoco.MjData(mj)
    data.qpos[2] = 50.0
    turned = Rotation.from_rotvec([0.3, 2.0, -0.2])
    upright = made.behaviour.start(0.0).orientation
    data.qpos[3:7] = (turned * Rotation.from_quat(upright, scalar_first=True)).as_quat(
        scalar_first=True
    )
    data.qvel[:] = rng.normal(size=mj.nv)
    data.time = 0.8
    mujoco.mj_step1(mj, data)
    state = read(made.model, data)
    now = made.behaviour.advance(made.behaviour.begin(0.1, state), state)
    return made, state, now, turned


def asked(made, state, now, name):
    """A roll's task of that name."""
    return made.behaviour.command(now, state).tasks[made.behaviour.tasks.index(name)]


@pytest.mark.parametrize("about", FACING)
def test_root_control_sees_the_pelvis_alone(about):
    made, state, now, turned = at_a_state(
        ["excursion=root", "behaviour.alighting=null", "behaviour.catch=null"]
        + [f"behaviour.roll_about={about}"]
    )
    gains = made.config.controller.tasks["spin"]
    task = asked(made, state, now, "spin")
    found = KINDS["spin"].rows(task, made.model, state).wanted
    velocity = np.empty(6)
    body = mujoco.mjtObj.mjOBJ_BODY
    mujoco.mj_objectVelocity(made.model.mj, state.data, body, 1, velocity, 0)
    assert np.abs(velocity[:3] - state.momentum.angular_velocity).max() > 0.3
    wanted = [0.0, 2 * np.pi * 1.3, 0.0]
    lateral = turned.apply([0, 1, 0])
    axis = np.cross(lateral, [0, 1, 0])
    missing = axis / np.linalg.norm(axis) * np.arccos(lateral[1])
    assert gains.stiffness[1] == 0.0
    expected = state.momentum.inertia @ (
        np.array(gains.stiffness) * missing + np.array(gains.damping) * (wanted - velocity[:3])
    )
    assert found == pytest.approx(expected, rel=1e-9)
    assert rotate(now.excursion.orientation, np.array([0.0, 1.0, 0.0])) == pytest.approx(lateral)


def test_progress_under_root_control_is_still_the_whole_body_s():
    _, _, root, _ = at_a_state(["excursion=root"])
    _, state, usual, _ = at_a_state([])
    assert root.excursion.angle.tolist() == usual.excursion.angle.tolist()
    expected = [0.0, 0.1, 0.0] + state.momentum.angular_velocity / 60
    assert root.excursion.angle == pytest.approx(expected)


def test_a_tracked_excursion_has_stiffness_and_a_target_that_turns():
    made, state, now, _ = at_a_state(["controller=tracked_excursion"])
    assert made.config.controller.tasks["spin"].stiffness[1] > 0
    missing = asked(made, state, now, "spin")["target"]
    turned = now.excursion.angle[1]
    assert missing[1] == pytest.approx(0.1 + 2 * np.pi * 1.3 * 0.8 - turned)  # from phi_0 on


@pytest.mark.parametrize(
    ("name", "stiffness", "damping"), [("free_axis", 0.0, 23.0), ("free_rotation", 0.0, 0.0)]
)
def test_free_out_of_plane(name, stiffness, damping):
    gains = load([f"controller={name}"]).controller.tasks["spin"]
    usual = load(["controller=rolling"]).controller.tasks["spin"]
    assert gains.stiffness == (stiffness, 0.0, stiffness)
    assert gains.damping == (damping, usual.damping[1], damping)


@pytest.mark.parametrize(
    ("name", "climb"), [("decline_flowing", -np.sin(np.radians(6))), ("decline_unaligned", 0.0)]
)
def test_the_commanded_velocity_on_the_decline(name, climb):
    made, state, now, _ = at_a_state([f"behaviour={name}"])
    velocity = asked(made, state, now, "linear")["velocity"]
    assert velocity[2] == pytest.approx(climb)
    assert velocity @ velocity == pytest.approx(1.0)


@pytest.mark.parametrize(
    "chosen", [["behaviour=reference_roll"], ["behaviour=backward_roll_2", "behaviour.lift=null"]]
)
def test_the_clock_looks_poses_up_by_time_whatever_the_body_does(chosen):
    """AE and what is asked of the momenta, but for a lift, are those of the body all the same."""
    overrides = [*chosen, "behaviour.angular_velocity=0.75"]
    by_phase, state, measured, _ = at_a_state(overrides)
    made, state, now, _ = at_a_state([*overrides, "excursion=clock"])
    after = made.behaviour.advance(now, state)
    turn = 2.0 * np.pi * 0.75 / 60.0
    assert after.excursion.phase - now.excursion.phase == pytest.approx(turn, rel=1e-12)
    assert now.excursion.phase == pytest.approx(0.1 + turn, rel=1e-12)
    assert measured.excursion.phase != pytest.approx(0.1 + turn, abs=0.01)
    assert now.excursion.angle == pytest.approx(measured.excursion.angle, rel=1e-12)
    for name in ("linear", "spin"):
        assert asked(made, state, now, name) == asked(by_phase, state, measured, name)
    shown = made.behaviour.command(now, state).pose_a
    phase = by_phase.behaviour.command(
        measured._replace(excursion=measured.excursion._replace(phase=0.1 + turn)), state
    )
    assert shown == pytest.approx(phase.pose_a, abs=1e-12)


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (
            ["behaviour=forward_roll"],
            "behaviour.pace: waits at a phase of the body, excursion=clock goes by time",
        ),
        (
            ["behaviour=stand"],
            "excursion=clock: looks poses up by time, which behaviour=stand, "
            "a list of stages, does not; choose excursion=oriented",
        ),
    ],
)
def test_the_clock_is_refused_where_it_would_do_nothing_or_nonsense(overrides, message):
    with pytest.raises(InputError, match=re.escape(message)):
        scenario.build(load([*overrides, "excursion=clock"]))


@pytest.mark.parametrize(
    ("behaviour", "measure", "why"),
    [
        ("turn_over", "root", "is about the velocity of a roll, which {} has not"),
        ("stand", "integral", "acts where a task turns or holds, and in {} none does"),
    ],
)
def test_what_no_task_looks_at_is_refused(behaviour, measure, why):
    why = why.format(f"behaviour={behaviour}, a list of stages,")
    message = f"excursion={measure}: {why}; choose excursion=oriented"
    with pytest.raises(InputError, match=re.escape(message)):
        scenario.build(load([f"behaviour={behaviour}", f"excursion={measure}"]))


@pytest.mark.parametrize(
    ("chosen", "message"),
    [
        (["behaviour=stand", "excursion.correction_time=0.5"],
         "excursion.correction_time=0.5: acts on nothing, as no task of behaviour=stand turns or "
         "holds; leave it at 0.37"),
        (["behaviour=turn_over", "excursion=integral", "excursion.correction_time=0.5"],
         "excursion.correction_time=0.5: acts on nothing, as measure=integral has no pull; leave "
         "it at 0.37"),
        (["excursion=root", "excursion.correction_time=0.5"],
         "excursion.correction_time=0.5: acts on nothing, as measure=root has no pull; leave it "
         "at 0.37"),
        (["excursion=clock", "excursion.phase_time=1"],
         "excursion.phase_time=1: acts on nothing, as with measure=clock the phase goes by time; "
         "leave it at 3"),
    ],
)  # fmt: skip
def test_a_pull_that_acts_on_nothing_is_refused(chosen, message):
    with pytest.raises(InputError, match=re.escape(message)):
        scenario.build(load(chosen))


@pytest.mark.parametrize("behaviour", ["forward_roll_1", "turn_over", "land", "forward_roll_twice"])
def test_a_pull_that_acts_is_not(behaviour):
    """In a chain on those of its parts that are measured as the run is."""
    scenario.build(load([f"behaviour={behaviour}", "excursion.correction_time=0.5"]))


def test_the_integral_of_a_turn_is_another_run():
    turns = [
        in_memory(
            scenario.build(load(["behaviour=turn_over", f"excursion={measure}", "duration=1"]))
        )
        for measure in ("oriented", "integral")
    ]
    one, other = (buffer.arrays()["trajectory/qpos"] for buffer, _ in turns)
    assert np.abs(one - other).max() > 1e-6
