"""A roll that tips over its side catches itself with the arm on that side."""

from dataclasses import replace

import numpy as np
import pytest

from rotctl.behaviours.catching import Catch, CatchSettings
from rotctl.config import load
from rotctl.errors import InputError
from rotctl.metrics.judge import judge
from rotctl.run import in_memory
from rotctl.scenario import build

SETTINGS = CatchSettings(joint="shoulder_x", gain=4.0, free=0.03, most=1.0)


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
    ("about", "rise", "arm"),
    [
        ("left", -0.13, "shoulder_x_l"),
        ("left", 0.13, "shoulder_x_r"),
        ("right", -0.13, "shoulder_x_r"),  # whose back is to the way
        ("right", 0.13, "shoulder_x_l"),
    ],
)
def test_the_arm_on_the_low_side_goes_out_and_nothing_else_moves(model, about, rise, arm):
    assert moved(model, rise, about) == pytest.approx({arm: 4.0 * 0.1})


@pytest.mark.parametrize("rise", [0.0, 0.03, -0.03, 0.01])
def test_a_little_is_no_tipping(model, rise):
    assert moved(model, rise) == {}


def test_it_goes_out_without_a_jump_and_no_further_than_told(model):
    catch, rises = Catch(SETTINGS, model, "left"), np.linspace(-1.0, 1.0, 2001)
    out = [catch.out(rise) for rise in rises]
    assert np.abs(np.diff(out)).max() <= 4.0 * 0.001 + 1e-12
    assert (min(out), max(out)) == (0.0, 1.0)


def test_it_keeps_within_the_joint_and_leaves_a_pose_that_is_beyond_it(model):
    high = model.joint_range[model.joint_names.index("shoulder_x_l"), 1]
    assert moved(model, -1.0, pose=high - 0.1) == pytest.approx({"shoulder_x_l": 0.1})
    assert moved(model, -1.0, pose=high + 0.1) == {}


def test_what_cannot_catch_is_refused():
    with pytest.raises(InputError, match="lies on its side, and has nothing to catch"):
        load(["behaviour=sideways_roll", "+catch=arm"])
    with pytest.raises(InputError, match=r"behaviour\.catch\.joint names the unknown joint 'arm'"):
        build(load(["behaviour=forward_roll", "+catch=arm", "behaviour.catch.joint=arm"]))


def test_pushes_that_lay_a_squat_on_its_side_are_caught():
    """Of these twelve it overcomes four more at least than without."""
    recovered = {}
    for catch in ("", "+catch=arm"):
        for direction in (90, 120, 180, 210, 240, 270):
            for phase in (270, 315):
                config = load(
                    [
                        *("behaviour=forward_roll", "disturbance=push", "seed=2000", "duration=5"),
                        *("disturbance.time=2", "disturbance.impulse=50"),
                        f"disturbance.direction={direction}",
                        f"disturbance.phase={phase}",
                        *filter(None, [catch]),
                    ]
                )
                made = build(config)
                log = in_memory(made)[0].arrays()
                judged = judge(
                    log, config.criteria, config.behaviour.commanded, 1 / 60, 5.0, made.model.mj
                )
                recovered.setdefault(catch, []).append(judged.columns["recovered"])
    assert sum(recovered["+catch=arm"]) >= sum(recovered[""]) + 4
