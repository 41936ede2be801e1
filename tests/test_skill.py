"""What of a run is shown: on logs made by hand, and the words below the frames."""

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.log import LOG_NAME, RunLog
from rotctl.report.moments import moments, turns_done
from rotctl.report.skill import parts
from rotctl.report.stage_names import stage_names
from rotctl.runs.run import run

RATE = 60.0


def log_of(seconds, stages=(), flies=(), moves=(), pushed=(), waves=(), turns=0.0, falls=False):
    """A log of which only what `parts` looks at is there; times in seconds.

    Args:
        stages: when each stage but the first begins.
        flies: from when to when nothing touches the ground.
        moves: from when to when it moves.
        waves: from when to when a joint does.
        turns: rate [rev/s] up to the first stage's end.
    """
    time = np.arange(round(seconds * RATE)) / RATE

    def within(span):
        return (time >= span[0]) & (time < span[1]) if span else np.zeros(len(time), dtype=bool)

    end = stages[0] if stages else seconds
    none = np.zeros((len(time), 3))
    turned = none.copy()
    turned[:, 1] = 2 * np.pi * turns * np.minimum(time, end)
    velocity = none.copy()
    velocity[:, 0] = within(moves)
    joints = np.zeros((len(time), 8))
    joints[within(waves), 7] = 2.0
    wrench = np.zeros((len(time), 6))
    wrench[within(pushed), 0] = 100.0
    count = np.where(within(flies), 0, 4)
    count[0] *= not falls
    return {
        "trajectory/time": time,
        "command/stage": sum((time >= begin).astype(int) for begin in stages)
        if stages
        else np.zeros(len(time), dtype=int),
        "contacts/count": count,
        "trajectory/com_velocity": velocity,
        "trajectory/angular_velocity": none,
        "trajectory/qvel": joints,
        "trajectory/ctrl": np.zeros((len(time), 2)),
        "trajectory/angular_excursion": turned,
        "trajectory/trunk_axis": np.tile([0.0, 1.0, 0.0], (len(time), 1)),
        "disturbance/wrench": wrench,
    }


def seconds_of(log):
    found = parts(log, log["trajectory/time"])
    return [(round(part.first / RATE, 2), round(part.last / RATE, 2)) for part in found]


@pytest.mark.parametrize(
    ("log", "shown"),
    [
        # A flip: the crouch, the flight, until it stands still for half a second.
        (
            log_of(6.0, stages=(1.0, 2.0, 3.0), flies=(2.2, 2.8), moves=(1.8, 3.6)),
            [(1.7, 4.1)],
        ),
        # One that never stands still has fallen.
        (
            log_of(9.0, stages=(1.0, 2.0, 2.8), flies=(2.2, 2.8), moves=(1.8, 9.0)),
            [(1.7, 5.8)],
        ),
        # One that does not fly, and tumbles after its last stage began: the skill, and the fall.
        (log_of(9.0, stages=(1.0, 2.0), flies=(2.5, 2.8), moves=(0.8, 9.0)), [(0.3, 5.8)]),
        # A dive: until it is in the water, where nothing touches it for long.
        (
            log_of(6.0, stages=(1.0, 3.0), flies=(2.0, 5.0), moves=(1.8, 6.0)),
            [(1.5, 3.1)],
        ),
        # A hop is no flight.
        (log_of(6.0, stages=(1.0,), flies=(2.0, 2.1), moves=(1.8, 3.0)), [(0.5, 3.5)]),
        # Who only moves the arms: from before the first stage ends until they hang still.
        (log_of(6.0, stages=(1.0, 2.5), moves=(0.0, 0.2), waves=(1.0, 3.0)), [(0.0, 3.5)]),
        # The last revolution of a roll that ends on its feet.
        (log_of(9.0, stages=(4.0,), moves=(0.0, 5.0), turns=0.5), [(2.0, 5.5)]),
        # A push, and a fall.
        (log_of(6.0, pushed=(1.0, 1.1), moves=(1.0, 2.5)), [(0.5, 3.0)]),
        (log_of(6.0, pushed=(1.0, 1.1), moves=(1.0, 2.5), waves=(1.0, 3.5)), [(0.5, 4.0)]),
        (log_of(6.0, moves=(0.0, 1.0), falls=True), [(0.0, 1.5)]),
        # Rolls, pushed ones too, and what only stands.
        (log_of(9.0, moves=(0.0, 9.0), turns=0.5), []),
        (log_of(9.0, moves=(0.0, 9.0), turns=0.5, pushed=(3.0, 3.1)), []),
        (log_of(6.0), []),
        (log_of(1 / RATE), []),
    ],
)
def test_what_is_shown(log, shown):
    assert seconds_of(log) == shown


def test_a_dive_from_the_hands_is_shown_from_when_the_handstand_is_left():
    log = log_of(6.0, stages=(1.0, 3.0), flies=(2.0, 5.0), moves=(1.8, 6.0))
    upside_down = np.diag([-1.0, 1.0, -1.0])
    log["trajectory/trunk_axes"] = np.tile(upside_down, (len(log["command/stage"]), 1, 1))
    assert seconds_of(log) == [(0.5, 3.1)]


def test_of_a_chain_each_part_is_shown():
    """A flight, a stand, a flight: each as by itself, the stand by one look."""
    log = log_of(15.0, stages=(1.0, 3.0, 5.0, 9.0, 10.0, 12.0), flies=(2.0, 3.0), moves=(1.8, 3.6))
    again = slice(round(9.0 * RATE), round(14.0 * RATE))
    for name in ("contacts/count", "trajectory/com_velocity"):
        log[name][again] = log[name][: round(5.0 * RATE)]
    found = parts(log, log["trajectory/time"], (3, 1, 3))
    seconds = [(round(part.first / RATE, 2), round(part.last / RATE, 2)) for part in found]
    flip = [(1.5, 4.1)]
    later = [(first + 9.0, last + 9.0) for first, last in flip]
    assert seconds == [*flip, (5.0, 8.98), *later]
    assert [part.share for part in found] == [6.0, 1.0, 6.0]


def test_who_begins_again_is_shown_from_the_first():
    """Two tries of two parts: one look at the whole, in the order of time."""
    log = log_of(8.0, stages=(2.0, 3.0), moves=(1.0, 7.0))
    second = slice(round(4.0 * RATE), None)
    log["command/stage"][second] = log["command/stage"][: round(4.0 * RATE)]
    found = parts(log, log["trajectory/time"], (2, 1))
    assert [(round(part.first / RATE, 2), round(part.last / RATE, 2)) for part in found] == [
        (0.5, 7.5)
    ]


def test_a_part_that_goes_back_within_itself_is_a_part_still():
    log = log_of(8.0, stages=(1.0, 2.0, 5.0), moves=(1.0, 7.0))
    log["command/stage"][round(3.0 * RATE) : round(4.0 * RATE)] = 0
    found = parts(log, log["trajectory/time"], (3, 1))
    assert found[-1].first == round(5.0 * RATE)


def test_an_older_log_tells_no_stages():
    log = log_of(6.0, moves=(0.0, 6.0))
    del log["command/stage"], log["disturbance/wrench"]
    assert parts(log, log["trajectory/time"]) == []


@pytest.mark.parametrize("time", [[0.0, 1e-320], [0.0, 9e4], [-9e4, 9e4]])
def test_a_clock_that_makes_no_sense(time):
    log = log_of(2 / RATE, stages=(1 / RATE,), moves=(0.0, 1.0))
    assert all(0 <= p.first <= p.last < 2 for p in parts(log, np.array(time)))


def test_below_a_frame_stands_the_blend_or_else_the_stage(tmp_path):
    def log(*overrides, duration=0.3):
        made = run(load([*overrides, f"duration={duration}"]), tmp_path)
        return RunLog.open(made.folder / LOG_NAME)

    rolls = log("behaviour=forward_roll_1")
    assert all(moment.note.startswith("blend 0.") for moment in moments(rolls, [0, 10]))
    assert stage_names(rolls) == []
    flips = log("behaviour=back_flip", duration=1.3)
    assert stage_names(flips) == ["stand", "crouch", "tilt", "launch", "flight", "land"]
    assert [moment.note for moment in moments(flips, [0, flips.steps - 1])] == ["stand", "crouch"]
    ends = log("behaviour=forward_roll", "+finish=stand", "behaviour.finish.after=0.1")
    assert stage_names(ends) == ["roll", "stand"]


def test_each_part_of_a_chain_counts_the_turns_about_its_own_axis():
    """A flip, a stand, then a pirouette; a roll goes on counting after the one before it."""
    log = log_of(4.0, stages=(1.0, 2.0, 3.0))
    time, left, up = log["trajectory/time"], np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])
    flips, turns = np.minimum(time, 1.0), np.clip(time - 2.0, 0.0, 1.0)
    log["trajectory/angular_excursion"] = 2 * np.pi * (np.outer(flips, left) + np.outer(turns, up))
    log["trajectory/trunk_axis"] = np.where((time >= 2.0)[:, None], up, left)
    chained = turns_done(log, [1, 1, 1, 1])
    at = [round(when * RATE) for when in (0.5, 0.99, 1.5, 2.5, 3.5)]
    assert chained[at] == pytest.approx([0.5, 1.0, 1.0, 0.5, 1.0], abs=0.02)
    assert turns_done(log)[at] == pytest.approx([0.5, 1.0, 1.0, 1.0, 1.0], abs=0.02)
