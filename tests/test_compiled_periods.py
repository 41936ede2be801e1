"""Whole control periods in C against the loop in Python: every bit of every row of a run."""

import gc
from dataclasses import fields

import mujoco
import numpy as np
import pytest

from rotctl.behaviours.rolling.compiled import PACE
from rotctl.behaviours.rolling.pace_settings import PaceSettings
from rotctl.behaviours.rolling.settings import RollingSettings
from rotctl.config.loading import load
from rotctl.control import compiled, handover
from rotctl.mechanics import pair_limit
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.simulation import compiled_periods, loop

pytestmark = [
    pytest.mark.exact,
    pytest.mark.skipif(
        compiled.library() is None,
        reason="the compiled control step is not built here (no C compiler at installation)",
    ),
]

ROWS = [
    *("forward_roll_1", "forward_roll_2", "forward_roll_3", "backward_roll_1", "backward_roll_2"),
    *("sideways_roll", "uneven_terrain", "incline", "decline", "stairs"),
]


@pytest.fixture
def both(monkeypatch):
    """A run of some overrides both ways: its rows, end and events, and how many periods C made."""
    usual, made = compiled_periods.CompiledPeriods.make, []

    def told(self, i):
        made.append(usual(self, i))
        return made[-1]

    monkeypatch.setattr(compiled_periods.CompiledPeriods, "make", told)

    def run(*overrides, before=lambda scenario: None, look=loop.nobody):
        found = []
        for chosen in (lambda *parts: None, compiled_periods.compiled_periods):
            monkeypatch.setattr(loop, "compiled_periods", chosen)
            scenario = build(load(list(overrides)))
            before(scenario)
            buffer, end = in_memory(scenario, look=look)
            found.append((buffer, end))
        (slow, slow_end), (fast, fast_end) = found
        here, there = slow.arrays(), fast.arrays()
        differ = [name for name in here if here[name].tobytes() != there[name].tobytes()]
        assert (differ, slow.events, slow_end) == ([], fast.events, fast_end)
        return fast, sum(made)

    return run


@pytest.mark.parametrize("behaviour", [*ROWS, "hazards", "forward_roll_1_phase"])
def test_rolls_have_the_same_bits(both, behaviour):
    buffer, made = both(f"behaviour={behaviour}", "duration=1", "seed=2003")
    assert buffer.steps == 60
    assert made > 50  # the first is the episode's, and what the reference had to solve


PACED = ("behaviour=forward_roll", "duration=2", "seed=2003")


@pytest.mark.parametrize(
    "overrides",
    [
        PACED,
        (*PACED, "behaviour.heading=-70", "physics.substeps=2"),
        (*PACED, "behaviour.pace.keep=speed", "behaviour.pace.over=[foot_l,shin]"),
        (*PACED, "behaviour.pace.schedule=[[0.5,0.3],[1.0,1.2]]"),
        (*PACED, "behaviour.pace.schedule=[[0.3,0],[1.5,0.8]]", "behaviour.pace.easing=1"),
        (*PACED, "behaviour.angular_velocity=0.3", "behaviour.pace.pose={knee:2.5,elbow_l:0.3}"),
        ("excursion=integral", "duration=1"),
        ("+behaviour.oblique=[12,5,-3,2,1]", "duration=1"),
        ("+behaviour.lift=[0.1,0.2,-0.3,0.1,0.2]", "duration=1"),
        (*PACED, "+behaviour.lift=[0.1,0.2,-0.3]", "duration=1"),
        ("behaviour.poses.a.knee=[1.9,0.1,-0.2,0.1,0.1,-0.05,0.07]", "duration=1"),
        ("behaviour.angular_momentum=30", "duration=1"),
        ("controller.supervisor=modified", "duration=1"),
        ("physics.contact_capacity=2", "duration=1"),
    ],
    ids=" ".join,
)
def test_whatever_is_asked_of_a_roll(both, overrides):
    assert both(*overrides)[1] > 50


def test_every_number_of_a_pace_acts_alike(both):
    """All of them others, late and early: one that C takes for another would be seen."""
    pace, rng = load(list(PACED)).behaviour.pace, np.random.default_rng(3)
    changed = {name: getattr(pace, name) * rng.uniform(0.7, 1.0) for name in PACE}
    changed |= {"brake": 1.2 * pace.brake, "most": 1.02, "back": 0.05}
    assert len(set(changed.values())) == len(PACE)
    both(
        *PACED,
        "behaviour.angular_velocity=1.3",
        "behaviour.pace.schedule=[[0.8,0.2]]",
        "behaviour.pace.settling=[2.5,3.5]",
        "behaviour.pace.approach=0.2",
        "behaviour.pace.leave=0.3",
        *(f"behaviour.pace.{name}={value}" for name, value in changed.items()),
    )


@pytest.mark.parametrize("behaviour", ["forward_roll", "backward_roll_1"])
@pytest.mark.parametrize("direction", [90, 270])
def test_c_catches_as_python_does(both, behaviour, direction):
    both(
        *(f"behaviour={behaviour}", "duration=2", "+catch=arm", "disturbance=push"),
        *("disturbance.time=0.5", f"disturbance.direction={direction}"),
    )


@pytest.mark.parametrize("heading", [0, -70])
def test_c_brings_limbs_aside_as_python_does(both, heading):
    """A joint that is told for two limbs, or twice for one, turns for each."""
    both(
        *("behaviour.alighting.limbs={foot:[hip_x,hip_z],forearm:[shoulder_x,shoulder_x]}",),
        *("+behaviour.alighting.limbs.shin=[hip_x]", f"behaviour.heading={heading}"),
        *("disturbance=push", "disturbance.time=0.3", "disturbance.direction=90", "duration=1"),
    )


def test_c_knows_what_a_roll_can_be_asked():
    """Whoever adds a setting gives it to C, or has `Rolling.compiled` refuse it."""
    assert {field.name for field in fields(PaceSettings)} == {
        *PACE,
        *("keep", "over", "settling", "schedule", "easing", "approach", "leave", "pose"),
    }
    assert {field.name for field in fields(RollingSettings)} == {
        *("name", "kind", "roll_about", "angular_velocity", "speed", "heading"),
        *("align_with_slope", "poses", "reference", "angular_momentum", "pace", "finish"),
        *("course", "catch", "oblique", "alighting", "lift"),
        *("source", "description"),
    }


@pytest.mark.parametrize(
    "overrides",
    [
        ("excursion=root",),
        ("disturbance=wind",),
        ("plant=randomised",),
        ("physics=lockstep",),
        ("controller.backend=reference",),
        ("behaviour=forward_roll", "+finish=stand", "behaviour.finish.after=0.05"),
        ("behaviour=forward_roll", "+course=circle"),
    ],
    ids=" ".join,
)
def test_what_c_has_not_is_made_in_python(both, overrides):
    assert both(*overrides, "duration=0.1")[1] == 0


@pytest.mark.parametrize(
    ("overrides", "python"),
    [
        (("disturbance=push", "disturbance.time=0.5", "disturbance.duration=0.2"), (14, 20)),
        (("disturbance=push", "disturbance.time=1.98"), (1, 9)),  # to the end of the run
        (("disturbance=push", "disturbance.time=0.3", "disturbance.phase=40"), (14, 90)),
        (("disturbance=gust", "disturbance.time=0.5", "disturbance.duration=0.3"), (20, 26)),
    ],
    ids=lambda value: " ".join(map(str, value)),
)
def test_what_disturbs_is_left_to_python_while_it_does(both, overrides, python):
    buffer, made = both(*overrides, "duration=2", "seed=1")
    assert buffer.disturbance.wrench.any()
    least, most = python
    assert least <= 120 - made <= most


def test_a_period_whose_solver_fails_is_left_to_the_reference(both, monkeypatch):
    """And C goes on after it; here it is made to doubt good solutions."""
    monkeypatch.setattr(handover, "TOLERANCE", 1e-10)
    buffer, made = both("behaviour=forward_roll_1_on_head", "seed=2004", "duration=1")
    assert 5 < made < 50
    assert buffer.events  # the reference's first solver stopped short, too


@pytest.mark.parametrize(
    "overrides",
    [
        ("terrain=obstacles", "start.speed_x=[-14,-14]"),  # it leaves the ground
        ("controller.pose.stiffness=1e7", "controller.pose.damping=1e5", "physics.substeps=1"),
    ],
    ids=" ".join,
)
def test_a_run_ends_alike(both, overrides):
    buffer, _ = both("seed=1", "duration=3", *overrides)
    assert buffer.steps < 180


def test_who_looks_may_end_a_run(both):
    buffer, made = both("duration=1", look=lambda buffer, done: done == 20)
    assert (buffer.steps, made) == (20, 19)


def test_a_full_pair_is_told_alike(both, monkeypatch):
    for module in (pair_limit, compiled_periods):
        monkeypatch.setattr(module, "LIMIT", 2)
    monkeypatch.setattr("rotctl.simulation.stepping.crowded", pair_limit.crowded)
    buffer, made = both("duration=1", "seed=2001")
    assert made > 50
    assert any("all that MuJoCo keeps of a pair" in text for _, text in buffer.events)


def test_mujoco_may_give_up(both):
    """With its own error, and not with the process."""
    model = None

    def before(scenario):
        nonlocal model
        model = scenario.model.mj

    def look(buffer, done):
        model.opt.integrator = 99 if done == 10 else model.opt.integrator

    overrides = ("duration=0.5", "physics.impratio=3.7")  # a model that nobody shares
    with pytest.raises(mujoco.FatalError, match="integrator") as slow:
        both(*overrides, before=before, look=look)
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    scenario = build(load(list(overrides)))
    before(scenario)
    with pytest.raises(mujoco.FatalError) as fast:
        in_memory(scenario, look=look)
    assert str(fast.value) == str(slow.value)


def test_a_run_leaves_nothing_to_the_garbage_collector():
    scenario = build(load(["duration=0.1"]))
    in_memory(scenario)
    gc.collect()
    in_memory(scenario)
    assert gc.collect() == 0
