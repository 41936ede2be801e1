"""Runs that are too short for what they are asked: the reason is that they end, and where."""

import re

import pytest

from rotctl.config.loading import load
from rotctl.metrics.criteria.early_end import of_a_part
from rotctl.runs.run import make

STANDS = ("behaviour=forward_roll", "+finish=stand", "behaviour.finish.after=1")
PUSHED = ("disturbance=push", "disturbance.impulse=80", "disturbance.direction=0")
COUNTED = (*STANDS[:2], "behaviour.finish.after=0")


@pytest.mark.parametrize(
    ("overrides", "reason"),
    [
        (["duration=0.5"], r"0.50 s, before a whole revolution: it turned 0.\d\d rev"),
        (["behaviour=back_flip", "duration=0.3"], "0.30 s, before it takes off"),
        (["behaviour=dive_forward", "duration=0.3"], "0.30 s, before it takes off"),
        (["behaviour=dive_forward", "duration=2.4"], "2.40 s, in the air"),
        (
            ["behaviour=turn_over", "duration=0.5"],
            r"0.50 s, turned by \d+ of 180 deg: it has 7 s",
        ),
        (
            ["behaviour=stand", "duration=0.5"],
            "0.50 s, 0.50 s after it began: it is to rest for 1 s, 0.50 s more at least",
        ),
        (
            [*STANDS, "duration=1.2"],
            "1.20 s, 0.20 s after it was told to end: it still rolls",
        ),
        (
            [*COUNTED, "behaviour.finish.revolutions=3", "duration=1"],
            r"1.00 s, before it is told to end, after 2.1 rev: it turned 0.\d\d rev",
        ),
        (
            [*COUNTED, "behaviour.finish.revolutions=1", "duration=1"],
            r"1.00 s, 0.\d\d s after it was told to end: it still rolls",
        ),
        (["behaviour=pirouette_one_foot", "duration=1"], "1.00 s, before it turns"),
        (["behaviour=handstand", "duration=1"], "1.00 s, before forearm_l and forearm_r come down"),
        (["behaviour=handstand", "duration=7"], "7.00 s, on its hands"),
        (["behaviour=handstand", "duration=4"], "4.00 s, before foot_l and foot_r come down"),
        (
            ["behaviour=pirouette_one_foot", "behaviour.target_excursion=-360", "duration=2.3"],
            r"2.30 s, turned by -\d+ of -360 deg",
        ),
        (
            ["behaviour=pirouette_one_foot", "duration=4", "seed=2014"],
            r"4.00 s, \d.\d\d s after it was there: it is to rest for 2 s, \d.\d\d s more at least",
        ),
        (
            ["behaviour=get_up", "duration=2"],
            "2.00 s, before it is up: it has 4 s, and is to rest for 2 s",
        ),
        (
            ["behaviour=stand_step", *PUSHED, "disturbance.time=0.5", "duration=1"],
            "1.00 s, 0.38 s after it was pushed: it is to rest for 2 s, 1.62 s more at least",
        ),
    ],
)
def test_the_end_of_a_short_run_is_its_reason(overrides, reason):
    found = make(load(["seed=2000", *overrides])).summary["failure_reason"]
    assert re.fullmatch(f"the run ends at {reason}", found), found


@pytest.mark.parametrize(
    ("duration", "begins"),
    [
        (2.3, "in the air"),
        (3.0, r"0.\d\d s after it landed: it is to rest for 2 s, 1.\d\d s more at least"),
        (6.0, ""),
    ],
)
def test_a_flip_goes_through_all_of_them(duration, begins):
    config = load(["behaviour=front_flip", "seed=2000", f"duration={duration}"])
    found = make(config).summary["failure_reason"]
    wanted = f"the run ends at {duration:.2f} s, {begins}" if begins else ""
    assert re.fullmatch(wanted, found), found


@pytest.mark.parametrize(
    ("overrides", "reason"),
    [
        (["behaviour=stand", "disturbance=push", "disturbance.impulse=300"], "touched the ground"),
        (["behaviour=reference_roll", "behaviour.reference.clip=forward_roll"], "stalled for"),
    ],
)
def test_a_run_that_had_the_time_fails_for_its_own_reason(overrides, reason):
    found = make(load([*overrides, "seed=2000", "duration=4"])).summary["failure_reason"]
    assert found.startswith(reason)
    assert "the run ends" not in found


def test_a_part_that_is_cut_before_it_is_told_to_end_says_so():
    """A run whose end is told too late is refused; a part may begin too late for that."""
    part = f"'forward_roll {' '.join(STANDS[1:])}'"
    chain = ("behaviour=chain", f"behaviour.parts=[stand,{part}]", "behaviour.between=null")
    rest = ("behaviour.rest.seconds=1", "controller=standing", "duration=1.4")
    found = make(load([*chain, *rest, "seed=2000"])).summary["failure_reason"]
    assert found.startswith("part 2 of 2, forward_roll: the run ends at 1.40 s, before it is told")


def test_a_part_that_the_runs_end_cuts_says_so_in_the_runs_time():
    parts = ("behaviour=chain", "behaviour.parts=[stand,back_flip]", "seed=3")
    rests = "1.00 s after it began: it is to rest for 2 s, 1.00 s more at least, and then back_flip"
    for duration, said in (
        (3.0, f"part 2 of 3, square: the run ends at 3.00 s, {rests}"),
        (4.2, "part 3 of 3, back_flip: the run ends at 4.20 s, before it takes off"),
    ):
        found = make(load([*parts, f"duration={duration}"])).summary["failure_reason"]
        assert found == said
    assert (
        of_a_part("the run ends at 4.00 s, in the air", 2.5, 6.5, True)
        == "it ends at 6.50 s, in the air"
    )
    assert of_a_part("leans by 30 deg at the end", 2.5, 6.5, True) == "leans by 30 deg at the end"


@pytest.mark.parametrize(
    ("reason", "of_the_run"),
    [
        ("stalled for 1.60 s from t = 0.00 s", "stalled for 1.60 s from t = 2.50 s"),
        ("fell: head came down at 1.25 s", "fell: head came down at 3.75 s"),
        ("told to halt at 3 s, and not still", "told to halt at 5.50 s, and not still"),
        ("is 0.70 m high at the end", "is 0.70 m high at the end"),
    ],
)
def test_a_part_s_reason_tells_the_time_of_the_run(reason, of_the_run):
    assert of_a_part(reason, 2.5, 6.5, True) == of_the_run
