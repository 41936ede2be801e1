"""A config becomes parts that fit together, and an identity."""

import re

import numpy as np
import pytest

from rotctl.choices.config_folders import conf_dir
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.runs.scenario import build


def run_id(*overrides):
    return build(load(list(overrides))).run_id


def test_the_same_config_is_the_same_run():
    assert re.fullmatch("[0-9a-f]{12}", run_id())
    assert run_id() == run_id("seed=0", "start=tucked") == run_id("duration=20")
    assert run_id() == run_id("plant.mass=-0.0")
    zeros = ("behaviour.heading", "physics.gravity.0", "start.pitch.1")
    assert {run_id(f"{key}=-0.0") for key in zeros} == {run_id()}


@pytest.mark.parametrize(
    "others",
    [
        ["disturbance.time=[1,1]", "disturbance.time=1.0"],
        ["disturbance.direction=-0.0", "disturbance.direction=0", "disturbance.direction=[0,0]"],
    ],
)
def test_a_range_without_width_is_the_number_that_it_is(others):
    assert len({run_id("disturbance=push", other) for other in others}) == 1


def test_whatever_changes_the_run_changes_its_id():
    ids = [
        run_id(*overrides)
        for overrides in (
            [],
            ["seed=1"],
            ["duration=19"],
            ["start=rest"],
            ["physics.substeps=5"],
            ["controller.solver=osqp"],
            ["controller.pose.damping=1"],
            ["character.mass=71"],
            ["behaviour.poses.a.hip_x=0.21"],
        )
    ]
    assert len(set(ids)) == len(ids)


def test_the_start_is_drawn_from_the_seed_within_its_ranges():
    config = load(["seed=4"])
    start, again = build(config).start, build(config).start
    other = build(load(["seed=5"])).start
    assert start.pitch == again.pitch != other.pitch
    assert np.array_equal(start.velocity, again.velocity)
    assert np.array_equal(start.angular_velocity, again.angular_velocity)
    low, high = config.start.pitch
    assert low <= start.pitch <= high
    low, high = config.start.speed_x
    assert low <= start.velocity[0] <= high
    low, high = config.start.angular_velocity_y
    assert low <= start.angular_velocity[1] <= high


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        (
            ["behaviour=back_flip", "physics.gravity=[0,0,0]"],
            "physics.gravity.2=0: must be less than 0, as behaviour=back_flip stands or falls "
            "by its weight; a roll without a finish turns without it",
        ),
        (
            ["behaviour=chain", "behaviour.parts=[stand,stand]", "physics.gravity=[0,0,9.81]"],
            "physics.gravity.2=9.81: must be less than 0, as behaviour=chain stands or falls "
            "by its weight; a roll without a finish turns without it",
        ),
        (
            ["controller.solver=foo"],
            "controller.solver='foo' is unknown; valid: boxqp, osqp, qpsolvers:<name> "
            "(for example qpsolvers:daqp)",
        ),
        (
            ["controller.form=literal"],
            "controller.form=literal has equality rows, which boxqp cannot solve; choose "
            "controller.solver=osqp or controller.solver=qpsolvers:<name>",
        ),
        (
            ["character.drawn=null", "character.height=2"],
            "character.height is 2 m, but the bodies stand 1.750 m tall",
        ),
    ],
)
def test_parts_that_do_not_fit_are_refused_in_one_line(overrides, message):
    with pytest.raises(InputError) as caught:
        build(load(overrides))
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("override", "start"),
    [
        ("controller.solver=qpsolvers:nope", "controller.solver: qpsolvers has no solver 'nope' "),
        ("character.trunk=[nope]", "character.trunk names the unknown body 'nope'; bodies: "),
        ("+behaviour.poses.a.nope=1", "behaviour.poses.a names the unknown joint 'nope'; valid: "),
    ],
)
def test_unknown_names_are_answered_with_the_known_ones(override, start):
    with pytest.raises(InputError) as caught:
        build(load([override]))
    assert str(caught.value).startswith(start)


def test_the_run_id_knows_what_is_in_the_clip(tmp_path):
    """A path stays the same when its file changes; a resumed sweep must not take old for new."""
    path = tmp_path / "clip.yaml"
    overrides = ["behaviour=reference_roll", f"behaviour.reference.clip={path}"]
    shipped = (conf_dir() / "motion" / "forward_roll.yaml").read_text()
    path.write_text(shipped)
    before = run_id(*overrides)
    assert run_id(*overrides) == before
    path.write_text(shipped.replace("chest_y: [0.45,", "chest_y: [0.46,"))
    assert run_id(*overrides) != before
