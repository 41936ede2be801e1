"""A roll that tips over its side catches itself with its limbs on that side."""

from dataclasses import replace
from itertools import product

import mujoco
import numpy as np
import pytest

from rotctl.behaviours.rolling.catching import Catch, CatchSettings
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.maths.rotations import advanced
from rotctl.metrics.criteria.judge import judge
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

SETTINGS = CatchSettings(out={"shoulder_x": 1.0, "elbow": -0.5}, gain=4.0, free=0.03, lead=0.1)


@pytest.fixture(scope="module")
def model():
    return build(load(["behaviour=forward_roll"])).known


def moved(model, rise, about="left", pose=0.2, **changes):
    """By how much each joint goes out, of those that do [rad]."""
    before = np.full(len(model.joint_names), pose)
    after = Catch(replace(SETTINGS, **changes), model, about).spread(before, rise)
    out = zip(model.joint_names, (after - before).tolist(), strict=True)
    return {name: by for name, by in out if by != 0.0}


@pytest.mark.parametrize(
    ("about", "rise", "side"),
    [
        ("left", -0.13, "_l"),
        ("left", 0.13, "_r"),
        ("right", -0.13, "_r"),  # whose back is to the way
        ("right", 0.13, "_l"),
    ],
)
def test_the_limbs_on_the_low_side_move_and_nothing_else_does(model, about, rise, side):
    share = 4.0 * 0.1
    expected = {f"shoulder_x{side}": share, f"elbow{side}": -0.5 * share}
    assert moved(model, rise, about, pose=0.6) == pytest.approx(expected)


@pytest.mark.parametrize("rise", [0.0, 0.03, -0.03, 0.01])
def test_a_little_is_no_tipping(model, rise):
    assert moved(model, rise) == {}


def test_they_go_without_a_jump_and_no_further_than_told(model):
    catch, rises = Catch(SETTINGS, model, "left"), np.linspace(-1.0, 1.0, 2001)
    share = [catch.share(rise) for rise in rises]
    assert np.abs(np.diff(share)).max() <= 4.0 * 0.001 + 1e-12
    assert (min(share), max(share)) == (0.0, 1.0)


def test_they_keep_within_their_joints_and_leave_a_pose_that_is_beyond(model):
    low, high = model.joint_range[model.joint_names.index("shoulder_x_l")]
    for out, end in ((1.0, high), (-1.0, low)):
        inside, beyond = end - 0.1 * out, end + 0.1 * out
        only = {"out": {"shoulder_x": out}}
        assert moved(model, -1.0, pose=inside, **only) == pytest.approx({"shoulder_x_l": 0.1 * out})
        assert moved(model, -1.0, pose=beyond, **only) == {}


def test_what_is_about_to_tip_counts_as_far_as_it_would_get(model):
    """A unit that turns, a lead later, is where its end's rise was reckoned to be."""
    catch, rng = Catch(SETTINGS, model, "left"), np.random.default_rng(3)
    for _ in range(20):
        axis, turning = rng.normal(size=(2, 3))
        axis /= np.linalg.norm(axis)
        step = 1e-6
        later = np.array(advanced([1.0, 0.0, 0.0, 0.0], (turning * step).tolist()))
        matrix = np.zeros(9)
        mujoco.mju_quat2Mat(matrix, later)
        rate = ((matrix.reshape(3, 3) @ axis)[2] - axis[2]) / step
        assert catch.rise(axis, turning) == pytest.approx(axis[2] + 0.1 * rate, abs=1e-5)


def test_what_cannot_catch_is_refused():
    with pytest.raises(InputError, match="lies on its side, and has nothing to catch"):
        load(["behaviour=sideways_roll", "+catch=arm"])
    for joint, said in {
        "arm": r"behaviour\.catch\.out\.arm names the unknown joint 'arm'",
        "waist_y": "waist_y is of no limb on either side; valid joints: ankle_x, ankle_y, elbow,",
        "elbow_l": "elbow_l is of no limb on either side",
    }.items():
        with pytest.raises(InputError, match=said):
            build(load(["behaviour=forward_roll", "+catch=arm", f"+behaviour.catch.out.{joint}=1"]))


@pytest.mark.parametrize("side", ["_l", "_r"])
def test_a_joint_that_only_one_side_has_catches_nothing(model, side):
    names = tuple("stump" if name == f"elbow{side}" else name for name in model.joint_names)
    with pytest.raises(InputError) as caught:
        Catch(SETTINGS, replace(model, joint_names=names), "left")
    assert str(caught.value) == (
        "behaviour.catch.out.elbow is of one side alone; "
        "valid joints: ankle_x, ankle_y, hip_x, hip_y, hip_z, knee, shoulder_x, shoulder_y, "
        "shoulder_z"
    )


@pytest.mark.parametrize(
    ("behaviour", "without", "catching", "impulse", "starts"),
    [
        ("forward_roll", [], ["+catch=arm"], 50, (2000, 2001)),
        ("forward_roll_1", ["~behaviour.catch"], [], 75, (2010, 2011)),
    ],
)
def test_pushes_that_lay_a_squat_on_its_side_are_caught(
    behaviour, without, catching, impulse, starts
):
    """Of such eight most are overcome, and few without; chaos may turn some, hardly those."""
    recovered = [0, 0]
    for caught, seed, direction, phase in product((0, 1), starts, (120, 240), (270, 315)):
        config = load(
            [
                *(f"behaviour={behaviour}", f"seed={seed}", "duration=6", "disturbance=push"),
                *("disturbance.time=2", f"disturbance.impulse={impulse}"),
                *(catching if caught else without),
                *(f"disturbance.direction={direction}", f"disturbance.phase={phase}"),
            ]
        )
        made = build(config)
        log = in_memory(made)[0].arrays()
        commanded = config.behaviour.commanded
        judged = judge(log, config.criteria, commanded, 1 / 60, 6.0, made.model.mj)
        recovered[caught] += judged.columns["recovered"] == 1.0
    assert recovered[1] > recovered[0] + 2
