"""A training run has the columns that are asked for, and is cut once it is hopeless."""

from dataclasses import replace
from math import cos, isnan, pi, radians, sin

import numpy as np
import pytest

from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.log import TrajectoryBuffer
from rotctl.metrics.expressions.expression import read
from rotctl.tune.attempt import Attempt, attempt, hopeless
from rotctl.tune.space import Stopping

STOPPING = Stopping(stall_time=1.5, stall_progress=0.1, off_axis=70.0)


def test_a_run_has_the_columns_that_are_asked_for():
    item = Attempt(
        load(["behaviour=forward_roll_1_on_head", "seed=1000000", "duration=3"]),
        STOPPING,
        ("head_share", "rate_error"),
    )
    found = attempt(item).columns
    assert list(found) == ["head_share", "rate_error"]
    assert 0.01 < found["head_share"] < 0.5


def test_metrics_of_ones_own_are_among_them():
    config = load(["seed=1000000", "duration=3"])
    top = read("top", "max(com[:, 2])")
    found = attempt(Attempt(config, STOPPING, ("top", "jerk"), (top,))).columns
    assert list(found) == ["top", "jerk"]
    assert 0.4 < found["top"] < 0.8
    late = Attempt(config, STOPPING, ("late",), (read("late", "com[179, 2]"),))
    assert 0.0 < attempt(late).columns["late"] < 0.8
    cut = replace(late, stopping=replace(STOPPING, stall_time=0.1))
    assert isnan(attempt(cut).columns["late"])
    with pytest.raises(InputError, match="metric bad: index 9 is out of bounds"):
        attempt(Attempt(config, STOPPING, ("bad",), (read("bad", "com[0, 9]"),)))


@pytest.mark.parametrize(
    ("override", "success"),
    [("duration=4", True), ("criteria.trunk_turn=2", False), ("criteria.height=[0.6,0.8]", False)],
)
def test_what_the_criteria_refuse_is_no_success(override, success):
    """Of a roll that goes on to its end all the same."""
    run = attempt(Attempt(load(["seed=1000000", "duration=4", override]), STOPPING))
    assert run.to_the_end
    assert run.success is success


def cut_at(progress, commanded=1.3, tilt=lambda t: 0.0):
    """The time [s] at which a run of this progress(t) [rev] and tilt(t) [deg] is cut, or None."""
    stop, buffer = hopeless(STOPPING, commanded), TrajectoryBuffer.allocate(600, 7, 6, 0, 0, 0, 2)
    for i in range(600):
        t, angle = i / 60, radians(tilt(i / 60))
        buffer.trajectory.time[i], buffer.command.axes[i] = t, np.eye(3)
        buffer.trajectory.trunk_axis[i] = 0.0, cos(angle), sin(angle)
        buffer.trajectory.angular_excursion[i] = 0.0, 2 * pi * progress(t), 0.0
        if stop(buffer, i + 1):
            return t
    return None


def test_a_run_is_cut_after_so_long_without_progress():
    assert cut_at(lambda t: 0.65 * t) is None
    assert cut_at(lambda t: 0.0) == pytest.approx(1.5)
    assert cut_at(lambda t: min(0.65 * t, 1.3)) == pytest.approx(2.0 + 1.5, abs=0.16)
    assert cut_at(lambda t: 0.06 * t) == pytest.approx(1.5)
    assert cut_at(lambda t: 0.07 * t) is None


def test_progress_is_in_the_direction_commanded():
    assert cut_at(lambda t: -0.65 * t) == pytest.approx(1.5)
    assert cut_at(lambda t: -0.65 * t, commanded=-1.3) is None


def test_a_run_that_left_its_axis_is_cut():
    assert cut_at(lambda t: t, tilt=lambda t: 69.0) is None
    assert cut_at(lambda t: t, tilt=lambda t: 35.0 * t) == pytest.approx(2.0, abs=0.02)


def test_a_hopeless_run_takes_no_longer_than_it_must():
    # Commanded not to turn and not to go, it rocks to a standstill.
    still = ["behaviour.speed=0", "behaviour.angular_velocity=0.01", "start=rest", "duration=8"]
    run = attempt(Attempt(load(still), STOPPING))
    assert 1.5 <= run.survived < 4.0
    assert run.wanted == 8.0
    assert not run.to_the_end


def test_a_good_run_is_not_cut_and_repeats_itself():
    item = Attempt(load(["seed=1000000", "duration=3"]), STOPPING)
    run = attempt(item)
    assert run.to_the_end
    assert run.survived == pytest.approx(3.0)
    assert run.revolutions > 1.0
    assert attempt(item) == run
