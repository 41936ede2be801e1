"""What a behaviour asks for in metres and seconds, for a body of another size.

A behaviour was made for the body that the controller's gains are for. By the law of
`rotctl.mechanics.stature` another one has its lengths, times and speeds; shapes, shares and
commands of a roll are for all the same.
"""

from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar

from rotctl.behaviours.aerial.flight_settings import FlightSettings
from rotctl.behaviours.aerial.landing import LandingSettings
from rotctl.behaviours.aerial.launch import Launch, Lean, Whirl
from rotctl.behaviours.aerial.levelling import LevellingSettings
from rotctl.behaviours.chain.resting import RestSettings
from rotctl.behaviours.chain.settings import ChainSettings, PartSettings
from rotctl.behaviours.chain.ways import OnFeet, Rolls, Way
from rotctl.behaviours.rolling.alighting import AlightingSettings
from rotctl.behaviours.rolling.catching import CatchSettings
from rotctl.behaviours.rolling.finishing import FinishSettings
from rotctl.behaviours.rolling.pace_settings import PaceSettings
from rotctl.behaviours.rolling.settings import RollingSettings
from rotctl.behaviours.staged.conditions import After, Leant, Leaves, Low, Near, Over, Passed, Still
from rotctl.behaviours.staged.following import RiseSettings
from rotctl.behaviours.staged.gliding import GlideSettings, ReachSettings
from rotctl.behaviours.staged.placing import Above, Ground, Opposite
from rotctl.behaviours.staged.posing import Beyond
from rotctl.behaviours.staged.stages import TaskSettings
from rotctl.behaviours.staged.touching import Airborne, Launched, Touches
from rotctl.behaviours.standing.balance import Capture, Lunge
from rotctl.behaviours.standing.gathering import Beside
from rotctl.behaviours.standing.pivoting import Bring, Escapes
from rotctl.behaviours.standing.poising import Poise, Shift
from rotctl.behaviours.standing.stepping import Stepping
from rotctl.behaviours.standing.wheeling import Carry, Place, Stride
from rotctl.control.similarity import similar_gains
from rotctl.mechanics.stature import Likeness

T = TypeVar("T")
Unit = Callable[[Likeness], float]
Units = Mapping[type, Mapping[str, Unit]]


def length(by: Likeness) -> float:
    """[m]."""
    return by.size


def time(by: Likeness) -> float:
    """[s]."""
    return by.time


def speed(by: Likeness) -> float:
    """[m/s]."""
    return by.size / by.time


def rate(by: Likeness) -> float:
    """[1/s]."""
    return 1.0 / by.time


def turning(by: Likeness) -> float:
    """Angular momentum [kg m2/s]."""
    return by.mass * by.size * by.time


def all_of(unit: Unit, *names: str) -> dict[str, Unit]:
    """Fields that have a unit."""
    return dict.fromkeys(names, unit)


UNITS: Units = {
    After: all_of(time, "seconds"),
    Airborne: all_of(time, "seconds"),
    Still: all_of(time, "seconds"),
    Leaves: all_of(time, "after"),
    Touches: all_of(time, "after"),
    Passed: all_of(length, "distance"),
    Over: all_of(length, "within") | all_of(speed, "speed"),
    Launched: all_of(speed, "up") | all_of(length, "height"),
    Ground: all_of(length, "height"),
    Capture: all_of(length, "margin", "height", "sink", "lunge_margin", "lunge_most")
    | all_of(speed, "rise"),
    Lunge: all_of(length, "fade"),
    Stepping: all_of(
        length, "margin", "lift", "height", "over", "reach", "width", "aside", "narrow", "gather"
    )
    | all_of(time, "time")
    | all_of(speed, "fall"),
    Lean: all_of(length, "margin", "height", "ahead")
    | all_of(speed, "speed", "sink")
    | all_of(rate, "eager", "steady"),
    Launch: all_of(length, "margin", "height")
    | all_of(speed, "forward", "up", "most")
    | all_of(time, "soonest"),
    Whirl: all_of(turning, "most", "least", "ceiling") | all_of(rate, "calm"),
    Bring: all_of(length, "point") | all_of(time, "seconds", "soonest"),
    Poise: all_of(length, "margin") | all_of(rate, "rate"),
    Shift: all_of(length, "most", "ahead") | all_of(rate, "rate"),
    Carry: all_of(length, "margin", "heights", "throw")
    | all_of(speed, "speed")
    | all_of(rate, "eager"),
    Place: all_of(length, "distance", "height", "ahead", "room", "short"),
    Stride: all_of(length, "distance", "lift", "height") | all_of(time, "time"),
    Beside: all_of(length, "width", "lift", "height") | all_of(time, "time"),
    Beyond: all_of(time, "time"),
    RiseSettings: all_of(length, "height"),
    GlideSettings: all_of(time, "seconds"),
    ReachSettings: all_of(time, "seconds"),
    Above: all_of(length, "ahead", "height", "most"),
    Opposite: all_of(length, "ahead", "height"),
    Low: all_of(length, "height"),
    Leant: all_of(time, "after"),
    Escapes: all_of(length, "point", "distance"),
    Near: all_of(speed, "speed") | all_of(rate, "turning"),
    FlightSettings: all_of(time, "opening", "change", "coasting"),
    LevellingSettings: all_of(time, "interval"),
    LandingSettings: all_of(time, "time") | all_of(length, "most"),
    RollingSettings: all_of(length, "lift"),
    PaceSettings: all_of(length, "travel", "ahead")
    | all_of(rate, "own", "settling")
    | all_of(speed, "easing"),
    CatchSettings: all_of(time, "lead"),
    AlightingSettings: all_of(time, "lead") | all_of(speed, "sinking") | all_of(length, "reach"),
    FinishSettings: all_of(length, "reach") | all_of(rate, "turning"),
    ChainSettings: all_of(length, "again"),
    OnFeet: all_of(length, "out") | all_of(speed, "speed"),
    Rolls: all_of(rate, "turning"),
    Way: all_of(time, "patience"),
    RestSettings: all_of(time, "seconds") | all_of(speed, "speed"),
}
"""Of settings, what has a unit that grows; `TaskSettings.point` has one for points."""


def similar(settings: T, by: Likeness, units: Units = UNITS) -> T:
    """The settings for a body of other ratios.

    Args:
        units: by class of settings, and then by field.
    """
    return settings if by.same else _grown(settings, by, units)


def _grown(value: Any, by: Likeness, units: Units) -> Any:
    if isinstance(value, dict):
        return {name: _grown(inner, by, units) for name, inner in value.items()}
    if isinstance(value, tuple):
        return tuple(_grown(inner, by, units) for inner in value)
    if not is_dataclass(value) or isinstance(value, type):
        return value
    known = units.get(type(value), {})
    if isinstance(value, TaskSettings) and value.kind == "point":
        known = {"point": length}
    if isinstance(value, PartSettings) and value.gains:
        value = replace(value, gains=similar_gains(value.gains, by, value.behaviour.kinds))
    made = {}
    for part in fields(value):
        before, unit = getattr(value, part.name), known.get(part.name)
        made[part.name] = _times(before, unit(by)) if unit else _grown(before, by, units)
    return replace(value, **made)


def _times(value: Any, factor: float) -> Any:
    if isinstance(value, tuple):
        return tuple(_times(inner, factor) for inner in value)
    return value if value is None else value * factor
