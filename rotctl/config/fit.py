"""Parts of a config that are each valid, and whether they make a run together."""

from collections.abc import Sequence
from functools import cache
from typing import Any

from rotctl.behaviours import BehaviourSettings
from rotctl.behaviours.chain.settings import ChainSettings
from rotctl.behaviours.rolling.settings import RollingSettings
from rotctl.behaviours.staged.placing import Watch
from rotctl.behaviours.staged.settings import StagedSettings
from rotctl.choices import composing
from rotctl.choices.listing import content, shipped_files
from rotctl.config.schema import Config
from rotctl.errors import InputError
from rotctl.mechanics.bodies import body_id
from rotctl.mechanics.changes import Slip
from rotctl.mechanics.character import Character
from rotctl.mechanics.disturbance import Calm
from rotctl.mechanics.excursion import ExcursionSettings
from rotctl.mechanics.flesh import Flesh
from rotctl.mechanics.model import Model
from rotctl.mechanics.physics import LockstepPhysics, MujocoPhysics
from rotctl.mechanics.terrain.ground import MOST_FRICTION
from rotctl.metrics.criteria.dive import WATCHED, DiveCriteria
from rotctl.metrics.criteria.judge import ChainCriteria, Criteria
from rotctl.metrics.criteria.orientation import OrientationCriteria
from rotctl.settings.checking import brief, checked
from rotctl.settings.fields import Vector, ends
from rotctl.settings.writing import to_dict

ROUNDING = 1e-9  # [s]
IMPEDANCES = 1e-4, 0.9999  # [-] least and most that MuJoCo has of a contact


def require_fit(config: Config, model: Model) -> None:
    """See that the parts of a config fit together.

    Raises:
        InputError: criteria judge other motions or bodies, or what disturbs comes too late.
    """
    behaviour = config.behaviour
    _require_judged(behaviour, config.criteria, model)
    _require_pulled(behaviour, config.excursion)
    _require_halts(behaviour)
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


def require_sense(config: Config) -> None:
    """See that a run that is newly asked for comes to what it is told.

    Older runs, made before this was refused, are repeated and judged as they are.

    Raises:
        InputError: a finish comes too late, the ground may be drawn as none can be, or what is
            said of a contact acts on nothing.
    """
    _require_ground(config)
    if not isinstance(config.physics, LockstepPhysics):
        _require_contact(config.physics)
        _require_slow(config.character, config.physics, config.controller.rate)
    else:
        _require_hard(config.character, config.physics)
    _require_end(config.behaviour, config.duration)


def _require_pulled(behaviour: BehaviourSettings, measured: ExcursionSettings) -> None:
    """A pull that is told acts on something; what every measure has of it is not told."""
    lacking: dict[str, str] = {}
    if measured.measure in ("integral", "root"):
        lacking["correction_time"] = f"measure={measured.measure} has no pull"
    elif not behaviour.by_excursion:
        lacking["correction_time"] = f"no task of behaviour={behaviour.name} turns or holds"
    if measured.measure == "clock":
        lacking["phase_time"] = "with measure=clock the phase goes by time"
    for key, why in lacking.items():
        told, usual = getattr(measured, key), _usual(key)
        if told != usual:
            raise InputError(
                f"excursion.{key}={told:g}: acts on nothing, as {why}; leave it at {usual:g}"
            )


@cache
def _usual(key: str) -> float:
    """A pull's time that comes with rotctl [s]."""
    return float(content(shipped_files("excursion")["oriented"])[key])


def _require_halts(behaviour: BehaviourSettings, key: str = "behaviour") -> None:
    """How a halt brakes is told where there is one; what a behaviour brings along is not told.

    One that does not come with rotctl brings what it has: its file may be anywhere, or edited.
    """
    if isinstance(behaviour, ChainSettings):
        for number, part in enumerate(behaviour.parts):
            _require_halts(part.behaviour, f"{part.place(number)}: behaviour")
    if not isinstance(behaviour, RollingSettings) or behaviour.pace is None or behaviour.halts:
        return
    told = behaviour.pace.easing
    brought = _easing(behaviour.name) if _is_shipped(behaviour.name) else told
    if told not in (None, brought):
        raise InputError(
            f"{key}.pace.easing={brief(told)}: acts on nothing, as nothing tells it to halt, "
            f"which is a 0 in pace.schedule; leave it at {brief(brought)}"
        )


@cache  # a folder is read for it, and every run of a sweep asks
def _is_shipped(name: str) -> bool:
    """Whether a behaviour of that name comes with rotctl."""
    return name in shipped_files("behaviour")


@cache
def _easing(name: str) -> float | None:
    """Of the pace of a behaviour that comes with rotctl [m/s]."""
    made = composing.composed([composing.Assignment("behaviour", name)])
    pace = made["behaviour"].get("pace") if made else None
    return pace.get("easing") if pace else None


def _require_weight(behaviour: BehaviourSettings, gravity: Vector) -> None:
    """Who stands, steps or comes down goes by the time of a fall; a roll turns without."""
    rolls_on = isinstance(behaviour, RollingSettings) and behaviour.finish is None
    if gravity[2] >= 0.0 and not rolls_on:
        raise InputError(
            f"physics.gravity.2={gravity[2]:g}: must be less than 0, as behaviour={behaviour.name} "
            "stands or falls by its weight; a roll without a finish turns without it"
        )


def _require_ground(config: Config) -> None:
    """The ground of another plant is one that there may be, whatever is drawn, and stays one."""
    usual, factors = config.terrain.friction, config.plant.friction
    least, most = (usual * factor for factor in factors)
    key, drawn, with_these = "plant.friction", brief(factors), f"terrain.friction={usual:g}"
    if 0.0 < least <= most <= MOST_FRICTION and isinstance(config.disturbance, Slip):
        low, high = ends(config.disturbance.friction)
        least, most = least * low, most * high
        key, drawn = "disturbance.friction", brief(config.disturbance.friction)
        with_these += f" and plant.friction={brief(factors)}" if factors != (1.0, 1.0) else ""
    if not 0.0 < least <= most <= MOST_FRICTION:
        raise InputError(
            f"{key}={drawn}: with {with_these} the ground has {least:g} to {most:g}, "
            f"valid: above 0 and at most {MOST_FRICTION:g}"
        )


def _require_contact(physics: MujocoPhysics) -> None:
    """What MuJoCo would take for another number, without a word, is refused."""
    onset, firm, _, middle, power = physics.contact_solimp
    for i, value in ((0, onset), (1, firm), (3, middle)):
        if not IMPEDANCES[0] <= value <= IMPEDANCES[1]:
            raise InputError(
                f"physics.contact_solimp.{i}={value:g}: MuJoCo takes the nearest of "
                f"{IMPEDANCES[0]:g} to {IMPEDANCES[1]:g}; give one of them"
            )
    if power < 1.0:
        raise InputError(f"physics.contact_solimp.4={power:g}: MuJoCo takes 1; give that or more")


def _require_slow(character: Character, physics: MujocoPhysics, rate: float) -> None:
    """MuJoCo stops nothing in less than two steps; what a choice brings along is not told."""
    least = 2.0 / (rate * physics.substeps)
    for group, name, key, (told, _) in (
        ("character", character.name, "limit_solref", character.limit_solref),
        ("physics", physics.name, "contact_solref", physics.contact_solref),
    ):
        brought = _brought(group, name).get(key, (told,))[0]
        if told < 0.999 * least and told != brought:
            raise InputError(
                f"{group}.{key}.0={told:g}: MuJoCo takes two physics steps, {least:.4g} s; give "
                "that or more"
            )


def _require_hard(character: Character, physics: LockstepPhysics) -> None:
    """Contacts in lockstep are hard: flesh is not told there, but as a character brings it."""
    told = character.flesh and to_dict(character.flesh)
    whole = _brought("character", character.name)
    if not told or not whole:
        return
    flesh = whole.get("flesh")
    brought = to_dict(checked(Flesh, flesh)) if flesh else {}
    for key, value in told.items():
        if value != brought.get(key):
            raise InputError(
                f"character.flesh.{key}={brief(value)}: acts on nothing, as contacts of "
                f"physics={physics.name} are hard; leave flesh as character={character.name} has it"
            )


@cache
def _brought(group: str, name: str) -> dict[str, Any]:
    """What is in a choice that comes with rotctl; nothing of another one."""
    if name not in shipped_files(group):
        return {}
    made = composing.composed([composing.Assignment(group, name)])
    return dict(made[group]) if made else {}


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
    of = next((f".{part}" for part in ("landing", "stand") if hasattr(criteria, part)), "")
    stands = getattr(criteria, of[1:]) if of else criteria
    for name in getattr(stands, "feet", ()):
        body_id(model.mj, name, f"{key}{of}.feet")
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


def _require_end(behaviour: BehaviourSettings, duration: float, key: str = "behaviour") -> None:
    """A roll with a finish is told to end before a run of that duration [s] is over.

    Of a chain's parts only those of which it was said when: a run may be cut before the others.
    """
    if isinstance(behaviour, ChainSettings):
        for number, part in enumerate(behaviour.parts):
            if "finish.after" in part.said:
                _require_end(part.behaviour, duration, f"{part.place(number)}: behaviour")
    if isinstance(behaviour, RollingSettings) and behaviour.finish:
        after = behaviour.finish.after
        if after >= duration:
            raise InputError(
                f"{key}.finish.after={after:g}: it is never told to end, the run is over at "
                f"{duration:g} s; give less than that, or a longer duration"
            )
