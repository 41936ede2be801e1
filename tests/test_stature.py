"""Another height, weight and strength: the same motion, slower, by the law of similarity."""

from dataclasses import fields
from types import NoneType
from typing import get_args, get_type_hints

import numpy as np
import pytest

from rotctl.behaviours.aerial.launch import Launch, Whirl
from rotctl.behaviours.chain.ways import Posture
from rotctl.behaviours.rolling.settings import RollingSettings
from rotctl.behaviours.similarity import UNITS
from rotctl.behaviours.similarity import similar as asking
from rotctl.behaviours.staged.aims import Aim
from rotctl.behaviours.staged.conditions import Until
from rotctl.behaviours.standing.wheeling import Carry, Place, Stride
from rotctl.config.loading import load
from rotctl.control.similarity import similar
from rotctl.errors import InputError
from rotctl.mechanics.stature import Likeness, grown, likeness
from rotctl.runs.run import in_memory, make
from rotctl.runs.scenario import build, model_of
from rotctl.simulation import aloft, falling

CHILD = ("character.height=1.2", "character.mass=23")
GIANT = ("character.height=7.0", "character.mass=4480")  # 4 times as tall, 64 times as heavy


def test_as_drawn_nothing_changes():
    character = load([]).character
    assert likeness(character).same
    assert grown(character) is character
    config = load([])
    assert similar(config.controller, Likeness(), {}) is config.controller


def test_a_body_grows_as_a_whole():
    adult, child = model_of(load([])).mj, model_of(load(list(CHILD))).mj
    size, mass = 1.2 / 1.75, 23.0 / 70.0
    for name, power in (("body_pos", size), ("geom_size", size), ("body_ipos", size)):
        assert getattr(child, name)[1:] == pytest.approx(
            power * getattr(adult, name)[1:], rel=1e-4, abs=1e-6
        ), name
    assert child.body_mass == pytest.approx(mass * adult.body_mass, rel=1e-4)
    assert child.body_inertia == pytest.approx(mass * size**2 * adult.body_inertia, rel=1e-4)
    assert child.actuator_ctrlrange == pytest.approx(
        mass * size * adult.actuator_ctrlrange, rel=1e-4
    )
    assert child.dof_damping == pytest.approx(mass * size**1.5 * adult.dof_damping, rel=1e-4)


def test_strength_is_of_the_motors_alone():
    weak, usual = model_of(load(["character.strength=0.5"])), model_of(load([]))
    assert weak.torque_limit == pytest.approx(0.5 * usual.torque_limit)
    assert np.array_equal(weak.mj.body_mass, usual.mj.body_mass)
    assert np.array_equal(weak.mj.dof_damping, usual.mj.dof_damping)


@pytest.mark.parametrize("behaviour", ["forward_roll_1", "stand"])
def test_the_first_torques_of_a_giant_are_the_adults_grown(behaviour):
    """At rest in the same posture, with no command: the same problem in other units."""
    size, mass = 4.0, 64.0
    rest = ("start=rest", "behaviour.speed=0", "behaviour.angular_velocity=0")
    still = rest if behaviour == "forward_roll_1" else ("start.speed_x=[0,0]", "start.scatter=0")
    first = []
    for other, time in (((), 1.0), (GIANT, 2.0)):
        # The physics, too, takes steps as much longer, and its contacts are as much softer.
        rate = f"controller.rate={60 / time:g}"
        soft = f"physics.contact_solref=[{0.02 * time:g},1.0]"
        stops = f"character.limit_solref=[{0.03 * time:g},1.0]"
        config = load([f"behaviour={behaviour}", *still, *other, rate, soft, stops, "duration=0.5"])
        first.append(in_memory(build(config))[0].trajectory.ctrl[0])
    assert first[1] == pytest.approx(mass * size * first[0], rel=2e-3, abs=0.05 * mass * size)


TALL = ("character.height=2.0", "character.mass=110")


@pytest.mark.parametrize("who", [CHILD, TALL])
@pytest.mark.parametrize("behaviour", ["stand", "back_flip", "land"])
def test_who_stands_and_flips_does_so_at_any_height(who, behaviour):
    """Aims have heights, speeds and times of the body, and so has a start in the air."""
    seconds = 6 if behaviour == "back_flip" else 3
    results = [
        make(load([f"behaviour={behaviour}", *who, f"duration={seconds}", f"seed={seed}"])).summary
        for seed in (2000, 2001)
    ]
    assert any(result["success"] for result in results), [r["failure_reason"] for r in results]


def _aims(settings, shape):
    tasks = [task for stage in settings.stages for task in stage.tasks.values()]
    return [task.aim for task in tasks if isinstance(task.aim, shape)]


def test_what_is_asked_for_has_its_units():
    by = Likeness(size=4.0, mass=3.0)
    settings = load(["behaviour=front_flip"]).behaviour
    found = asking(settings, by)
    assert asking(settings, Likeness()) is settings
    (launch, *_), (other, *_) = _aims(settings, Launch), _aims(found, Launch)
    assert (other.up, other.height) == (2 * launch.up, 4 * launch.height)
    (whirl, *_), (more, *_) = _aims(settings, Whirl), _aims(found, Whirl)
    assert (more.most, more.amount) == (3 * 4 * 2 * whirl.most, whirl.amount)  # kg m2/s
    before, after = (next(x.flight for x in s.stages if x.flight) for s in (settings, found))
    assert (after.change, after.tuck) == (2 * before.change, before.tuck)
    start = load(["start=falling"]).start
    air = asking(start, by, falling.UNITS)
    assert air.falling.gap == tuple(4 * x for x in start.falling.gap)
    assert air.falling.momentum == tuple(24 * x for x in start.falling.momentum)
    assert air.speed_x == start.speed_x


WITHOUT = {  # shares, phases, angles, gains and a roll's commands, which are for all the same
    "Bow.angle", "Face.share", "Turn.most", "Capture.gain", "Capture.lunge", "Stepping.spin",
    "Stepping.away", "Stepping.twist",
    "Lean.gain", "Launch.gain", "Whirl.amount", "Poise.gain", "Carry.gain", "Carry.angles",
    "Place.angles", "Turned.share", "Turned.angle", "Near.angle", "Near.level", "Tilted.angle",
    "Leant.angle", "FaceDown.angle", "OnFeet.lean", "Rolls.tilt",
    "Launched.knee", "Leaves.angle", "CatchSettings.free", "CatchSettings.gain",
    "CatchSettings.out", "AlightingSettings.most", "FinishSettings.after",
    "FinishSettings.revolutions", "FinishSettings.within", "PaceSettings.approach",
    "PaceSettings.back", "PaceSettings.brake", "PaceSettings.calm", "PaceSettings.gain",
    "PaceSettings.leave", "PaceSettings.most", "PaceSettings.patience", "PaceSettings.pose",
    "PaceSettings.schedule", "PaceSettings.surge", "PaceSettings.surge_from",
    "PaceSettings.swing", "PaceSettings.swing_from", "PaceSettings.wait", "PaceSettings.width",
    "PathSettings.ahead", "PathSettings.legs", "PathSettings.most", "PathSettings.pull",
    "RatesSettings.schedule",
}  # fmt: skip


def numbers(shape):
    """Names of the fields of settings that are numbers."""
    return {name for name, kind in get_type_hints(shape).items() if "float" in str(kind)}


def parts_of_a_roll():
    """What keeps a roll at its pace, on its course and off its side, and ends it."""
    kinds = get_type_hints(RollingSettings)
    named = [kinds[name] for name in ("pace", "finish", "course", "catch", "alighting")]
    return [part for kind in named for part in get_args(kind) if part is not NoneType]


def test_every_number_of_an_aim_or_a_condition_has_a_unit_or_is_known_to_have_none():
    shapes = [shape for union in (Aim, Until, Posture) for shape in get_args(get_args(union)[0])]
    assert len(shapes) > 30
    shapes += parts_of_a_roll()
    said = {f"{shape.__name__}.{name}" for shape in shapes for name in UNITS.get(shape, {})}
    assert not said & WITHOUT
    assert {f"{s.__name__}.{name}" for s in shapes for name in numbers(s)} == said | WITHOUT


def test_a_cartwheel_is_asked_for_in_its_units():
    settings = load(["behaviour=cartwheel"]).behaviour
    found = asking(settings, Likeness(size=4.0, mass=3.0))  # a time is twice as long
    (carry, *_), (other, *_) = _aims(settings, Carry), _aims(found, Carry)
    assert (other.speed, other.eager) == (2 * carry.speed, 0.5 * carry.eager)
    assert (other.heights, other.angles) == (tuple(4 * x for x in carry.heights), carry.angles)
    (place, *_), (other, *_) = _aims(settings, Place), _aims(found, Place)
    assert (other.distance, other.height) == (4 * place.distance, 4 * place.height)
    (stride, *_), (other, *_) = _aims(settings, Stride), _aims(found, Stride)
    assert (other.time, other.lift) == (2 * stride.time, 4 * stride.lift)
    before, after = settings.stages, found.stages
    assert after[1].until.after == 2 * before[1].until.after
    assert after[2].until.distance == 4 * before[2].until.distance


def test_a_taller_body_looks_further_ahead_for_what_tips_it():
    settings = load(["behaviour=forward_roll", "+catch=arm"]).behaviour
    found = asking(settings, Likeness(size=4.0, mass=3.0))
    assert (found.catch.lead, found.catch.out) == (2 * settings.catch.lead, settings.catch.out)


def test_a_taller_body_is_told_to_rise_higher():
    build(load(["behaviour=backward_roll_1", "character.height=10"]))
    settings = load(["behaviour=backward_roll_1"]).behaviour
    found = asking(settings, Likeness(size=4.0, mass=3.0))
    assert found.lift == tuple(4 * wave for wave in settings.lift)
    assert (found.speed, found.angular_velocity) == (settings.speed, settings.angular_velocity)


@pytest.mark.parametrize("known", [aloft.UNITS, falling.UNITS, UNITS])
def test_units_are_of_fields_that_there_are(known):
    for shape, units in known.items():
        assert set(units) <= {part.name for part in fields(shape)}, shape


@pytest.mark.parametrize("who", [CHILD, TALL])
def test_a_child_and_a_tall_adult_roll(who):
    results = [make(load([*who, "duration=4", f"seed={seed}"])).summary for seed in (2000, 2001)]
    assert all(result["revolutions"] > 1.5 for result in results)


def test_gains_have_their_units():
    settings = load(["controller=rolling"]).controller
    by = Likeness(size=4.0, mass=3.0)
    found = similar(settings, by, {})
    assert found.pose.stiffness == pytest.approx(settings.pose.stiffness / 4)
    assert found.pose.damping == pytest.approx(settings.pose.damping / 2)
    assert found.pose.weight == pytest.approx(settings.pose.weight / 144)
    assert found.tasks["spin"].weight[0] == pytest.approx(settings.tasks["spin"].weight[0] / 144)
    assert found.tasks["linear"].weight[0] == pytest.approx(1 / 9)
    assert found.thresholds.force == pytest.approx(3 * settings.thresholds.force)
    assert found.thresholds.separation == pytest.approx(2 * settings.thresholds.separation)
    turned = similar(settings, by, {"spin": "attitude"})
    assert turned.tasks["spin"].weight[0] == pytest.approx(settings.tasks["spin"].weight[0] * 16)


def test_a_height_that_is_none():
    said = r"character\.height=9: must be within a tenth and ten times 0\.74 m"
    with pytest.raises(InputError, match=said):
        load(["character=baby", "character.height=9"])
