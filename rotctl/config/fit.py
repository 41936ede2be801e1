"""Parts of a config that are each valid, and whether they make a run together."""

from collections.abc import Sequence

from rotctl.behaviours import BehaviourSettings
from rotctl.behaviours.chain.settings import ChainSettings
from rotctl.behaviours.rolling.settings import RollingSettings
from rotctl.behaviours.staged.placing import Watch
from rotctl.behaviours.staged.settings import StagedSettings
from rotctl.choices.contents import content
from rotctl.choices.listing import shipped_files
from rotctl.config.schema import Config
from rotctl.errors import InputError
from rotctl.mechanics.bodies import body_id
from rotctl.mechanics.disturbance import Calm
from rotctl.mechanics.model import Model
from rotctl.mechanics.physics import LockstepPhysics
from rotctl.metrics.criteria.dive import WATCHED, DiveCriteria
from rotctl.metrics.criteria.kinds import ChainCriteria, Criteria
from rotctl.metrics.criteria.orientation import OrientationCriteria
from rotctl.settings.fields import Vector, ends

ROUNDING = 1e-9  # [s]


def require_fit(config: Config, model: Model) -> None:
    """See that the parts of a config fit together.

    Raises:
        InputError: criteria judge other motions or bodies, or what disturbs comes too late.
    """
    behaviour = config.behaviour
    _require_judged(behaviour, config.criteria, model)
    if not isinstance(config.criteria, OrientationCriteria):
        _require_weight(behaviour, config.physics.gravity)
    if config.plant.predicted and isinstance(config.physics, LockstepPhysics):
        raise InputError(
            f"plant={config.plant.name} predicts with MuJoCo's own contacts; with "
            f"physics={config.physics.name} give plant.predicted=false"
        )
    _require_in_time(behaviour, config.duration)
    outside = config.disturbance
    if isinstance(outside, Calm):
        return
    if ends(outside.time)[0] >= config.duration:
        raise InputError(
            f"disturbance.time: the {outside.kind} begins at {ends(outside.time)[0]:g} s at the "
            f"earliest, when the run of {config.duration:g} s is over"
        )
    if outside.changes_model and config.controller.sees_disturbance:
        raise InputError(
            f"controller.sees_disturbance is about forces, and disturbance={outside.name} has "
            "none: control goes on with the model that it knows"
        )


def _require_weight(behaviour: BehaviourSettings, gravity: Vector) -> None:
    """Who stands, steps or comes down goes by the time of a fall; a roll turns without."""
    rolls_on = isinstance(behaviour, RollingSettings) and behaviour.finish is None
    if gravity[2] >= 0.0 and not rolls_on:
        raise InputError(
            f"physics.gravity.2={gravity[2]:g}: must be less than 0, as behaviour={behaviour.name} "
            "stands or falls by its weight; a roll without a finish turns without it"
        )


def _require_judged(
    behaviour: BehaviourSettings, criteria: Criteria, model: Model, key: str = "criteria"
) -> None:
    wanted = ["standing", "landing", "getting_up", "flip", "dive", "acrobatic"]
    wanted += ["one_foot", "orientation"]
    if isinstance(behaviour, ChainSettings):
        wanted = ["getting_up"] if behaviour.again or behaviour.ways else ["chain", "getting_up"]
    if isinstance(behaviour, RollingSettings):
        wanted = ["rolling"] if behaviour.finish is None else ["finish"]
    if criteria.kind not in wanted:
        *first, last = wanted
        kinds = f"{', '.join(first)} or {last}" if first else last
        raise InputError(
            f"{key}={criteria.name} does not judge behaviour={behaviour.name}, "
            f"a behaviour of kind {behaviour.kind}{' that finishes' * (wanted == ['finish'])}; "
            f"choose criteria of kind {kinds}, such as criteria={_named(wanted)}"
        )
    if isinstance(behaviour, ChainSettings) and isinstance(criteria, ChainCriteria):
        links, rules = len(behaviour.parts), len(criteria.parts)
        if links != rules:
            raise InputError(
                f"criteria.parts: {rules} of them, and behaviour={behaviour.name} has {links} parts"
            )
        for number, (part, own) in enumerate(zip(behaviour.parts, criteria.parts, strict=True)):
            place = f"{part.place(number)}: criteria" if part.said else f"{key}.parts.{number}"
            _require_judged(part.behaviour, own, model, place)
    if isinstance(criteria, DiveCriteria):
        _require_watched(behaviour, criteria, key)
        for name in criteria.straight:
            model.motors(name, f"{key}.straight")
    of = next((f".{part}" for part in ("landing", "stand") if hasattr(criteria, part)), "")
    stands = getattr(criteria, of[1:]) if of else criteria
    for name in getattr(stands, "feet", ()):
        body_id(model.mj, name, f"{key}{of}.feet")
    for name in getattr(getattr(criteria, "held", None), "bodies", ()):
        body_id(model.mj, name, f"{key}.held.bodies")
    for group in getattr(criteria, "order", ()):
        for name in group:
            body_id(model.mj, name, f"{key}.order")


def _named(kinds: Sequence[str]) -> str:
    """The first of the criteria that come with rotctl that says it is of one of some kinds."""
    told = {name: content(path) for name, path in shipped_files("criteria").items()}
    return next((name for name, data in told.items() if data.get("kind") in kinds), "NAME")


def _require_watched(behaviour: BehaviourSettings, criteria: DiveCriteria, key: str) -> None:
    """What an entry is judged by are points that the behaviour watches."""
    tasks = behaviour.tasks if isinstance(behaviour, StagedSettings) else {}
    lacking = [
        name for name in WATCHED if name not in tasks or not isinstance(tasks[name].aim, Watch)
    ]
    if lacking:
        raise InputError(
            f"{key}={criteria.name} judges a dive by tasks of the law watch, and "
            f"behaviour={behaviour.name} has none of the name {' nor '.join(lacking)}"
        )


def _require_in_time(behaviour: BehaviourSettings, duration: float, key: str = "behaviour") -> None:
    """What a schedule tells comes before a run of that duration [s] is over."""
    if isinstance(behaviour, ChainSettings):
        for number, part in enumerate(behaviour.parts):
            _require_in_time(part.behaviour, duration, f"{part.place(number)}: behaviour")
    if isinstance(behaviour, RollingSettings):
        halts = [(begin, min(end, duration)) for begin, end in behaviour.halts]
        if halts and sum(end - begin for begin, end in halts) >= duration - ROUNDING:
            raise InputError(
                f"{key}: is told to halt from 0 s to the end, which is no roll; "
                "behaviour=stand stands"
            )
        for schedule, time in behaviour.last_told.items():
            if time >= duration:
                raise InputError(
                    f"{key}.{schedule}: what it tells from {time:g} s on never comes, the run is "
                    f"over at {duration:g} s"
                )
