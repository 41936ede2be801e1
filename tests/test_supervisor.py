"""Which contacts the controller may use: truth tables."""

from dataclasses import replace
from typing import get_args

import numpy as np
import pytest

from rotctl.control import Controller
from rotctl.control.supervisor import RULES, Evidence, SupervisorName, Thresholds

LIMITS = Thresholds(force=20.0, torque=10.0, separation=0.3, hull=0.5)
LOW, AT, HIGH = 0, 1, 2
FORCE, TORQUE, SPEED = (0.0, 20.0, 20.1), (0.0, 10.0, 10.1), (-0.5, 0.3, 0.4)


def seen(force, torque, separation, place=None, realised=None):
    """Evidence of contacts on level ground that push up and turn about x."""
    m = len(force)
    push = np.zeros((m, 6))
    push[:, 2], push[:, 3] = force, torque
    place = np.zeros((m, 2)) if place is None else np.asarray(place, dtype=float)
    return Evidence(
        push=push,
        separation=np.asarray(separation, dtype=float),
        place=place,
        edges=np.array([edges(x, y) for x, y in place]).reshape(m, 4, 6),
        realised=lambda: push if realised is None else realised,
    )


def edges(x, y, mu=0.5):
    """Force and torque about the origin, 1 m up, of a pyramid's edges at a place on the ground."""
    forces = [np.array([a * mu, b * mu, 1.0]) for a in (1, -1) for b in (1, -1)]
    return [np.concatenate((f, np.cross([x, y, -1.0], f))) for f in forces]


def kept(rule, force, torque, speed):
    evidence = seen([force], [torque], [speed])
    mask = RULES[rule](evidence, LIMITS)
    assert mask.dtype == bool
    return bool(mask[0])


@pytest.mark.parametrize("speed", [LOW, AT, HIGH])
@pytest.mark.parametrize("torque", [LOW, AT, HIGH])
@pytest.mark.parametrize("force", [LOW, AT, HIGH])
def test_truth_table(force, torque, speed):
    """Above a threshold, not at it; `modified` adds what does not separate fast."""
    found = FORCE[force], TORQUE[torque], SPEED[speed]
    pushes = force == HIGH or torque == HIGH
    assert kept("as_written", *found) is pushes
    assert kept("modified", *found) is (pushes or speed == LOW)


def test_each_contact_is_judged_by_itself():
    evidence = seen([30.0, 0.0, 0.0, 0.0], [0.0, 30.0, 0.0, 0.0], [1.0, 1.0, 0.0, 1.0])
    assert RULES["as_written"](evidence, LIMITS).tolist() == [True, True, False, False]
    assert RULES["modified"](evidence, LIMITS).tolist() == [True, True, True, False]


@pytest.mark.parametrize("rule", RULES)
def test_no_contacts(rule):
    assert RULES[rule](seen([], [], []), LIMITS).shape == (0,)


def test_zero_thresholds_keep_whatever_pushes():
    zero = Thresholds(force=0.0, torque=0.0, separation=0.0, hull=0.0)
    evidence = seen([0.0, 1e-9], np.zeros(2), np.ones(2))
    assert RULES["as_written"](evidence, zero).tolist() == [False, True]


def test_none_is_no_rule():
    assert "none" not in RULES


# ---------------------------------------------------------------- the others that the paper tried


def test_minimal_leaves_out_what_the_others_can_do():
    """Three feet in a line carry a load over the middle one: that one alone can."""
    place = [[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0]]
    force = [100.0, 200.0, 100.0]
    evidence = carrying(place, force)
    assert RULES["minimal"](evidence, LIMITS).tolist() == [False, True, False]


def test_minimal_keeps_what_nobody_else_can_do():
    """A load that is off to one side needs two of the three."""
    place = [[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0]]
    keep = RULES["minimal"](carrying(place, [5.0, 100.0, 300.0]), LIMITS)
    assert keep.tolist() == [False, True, True]


def carrying(place, force):
    """Evidence of contacts that push straight up, with the torques that follow."""
    evidence = seen(force, np.zeros(len(force)), np.zeros(len(force)), place)
    up = evidence.edges.mean(axis=1)  # the four edges lean against each other
    return Evidence(
        push=up * np.asarray(force)[:, None],
        separation=evidence.separation,
        place=evidence.place,
        edges=evidence.edges,
        realised=evidence.realised,
    )


def test_on_the_hull_less_is_enough():
    """A square and its middle: 15 N is half of 20 N and more, at the corners."""
    place = [[0, 0], [2, 0], [2, 2], [0, 2], [1, 1]]
    evidence = seen([15.0, 15.0, 15.0, 9.0, 15.0], np.zeros(5), np.zeros(5), place)
    assert RULES["convex_hull"](evidence, LIMITS).tolist() == [True, True, True, False, False]


@pytest.mark.parametrize(
    "place", [[[0, 0]], [[0, 0], [1, 0]], [[0, 0], [1, 0], [2, 0]], [[1, 1]] * 3]
)
def test_few_contacts_or_those_in_a_line_are_all_on_the_hull(place):
    """The middle one of a line is on its edge."""
    m = len(place)
    evidence = seen(np.full(m, 15.0), np.zeros(m), np.zeros(m), place)
    assert RULES["convex_hull"](evidence, LIMITS).all()


@pytest.mark.parametrize("rule", ["simulated", "simulated_free"])
def test_what_the_physics_answers_counts_not_what_was_planned(rule):
    realised = np.zeros((3, 6))
    realised[0, 2], realised[1, 4] = 25.0, 11.0
    evidence = seen([0.0, 0.0, 100.0], np.zeros(3), np.zeros(3), realised=realised)
    assert RULES[rule](evidence, LIMITS).tolist() == [True, True, False]


def whole(data):
    """The bytes of a state, of what has been evaluated, and of what a solver starts from."""
    parts = data.qpos, data.qvel, data.qacc_warmstart, data.ctrl, data.qfrc_bias, data.efc_J
    return [part.tobytes() for part in parts]


@pytest.mark.parametrize("name", [name for name in get_args(SupervisorName) if name != "none"])
def test_every_test_rolls_and_leaves_the_state_as_it_was(world, name):
    """A first pass that is simulated is undone: the same state decides the same again."""
    settings = replace(world.settings, supervisor=name, backend="reference")
    controller = Controller(world.model, settings)
    for step in world.steps[10:40:10]:
        state = controller.read(world.data(step.position, step.velocity))
        before = whole(state.data)
        command = step.command._replace(supervisor=name)
        one, two = (controller.decide(state, command, step.blend) for _ in range(2))
        assert np.array_equal(one.torque, two.torque)
        assert whole(state.data) == before
        assert np.isfinite(one.torque).all()
