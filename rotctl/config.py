"""Configs: composed by Hydra from `conf/`, then checked once into frozen dataclasses.

Hydra gives the groups and the override syntax; nothing is instantiated from a config and
no `_target_` or resolver is honoured, in overrides and in files, so that a stranger's config
cannot execute code or look anything up.
"""

import copy
import json
import re
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass, replace
from functools import cache, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

import yaml
from pydantic import Field, Strict, TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass as validated

from rotctl import choosing, documents, own_body
from rotctl.behaviours import BehaviourSettings
from rotctl.checked import brief, checked, clip, unknown_key
from rotctl.choosing import Assignment, simple
from rotctl.control import ControllerSettings
from rotctl.documents import UNPRINTABLE
from rotctl.errors import InputError, LogError
from rotctl.listing import choices, conf_dir, folders, is_own, named_file, own_dir, require_plain
from rotctl.log import RunLog
from rotctl.mechanics.character import Character
from rotctl.mechanics.disturbance import DisturbanceSettings
from rotctl.mechanics.excursion import ExcursionSettings
from rotctl.mechanics.physics import Physics
from rotctl.mechanics.plant import PlantSettings
from rotctl.mechanics.terrain import Terrain
from rotctl.metrics.judge import Criteria
from rotctl.plain import NOTHING, Way, dotted, exchanged, leaves, member, put, way
from rotctl.same import kept
from rotctl.settings import SPARSE, STRICT, Positive
from rotctl.simulation.start import StartSettings

if TYPE_CHECKING:
    from hydra.core.override_parser.types import Override

PROSE = ("description", "source")  # may have several lines
LONGEST_TEXT = 200
LARGEST = 1e13  # in any unit: squares and cubes of it are numbers still


@validated(frozen=True, config=STRICT)
class Config:
    """Everything that determines a run.

    Attributes:
        seed: of the run's random generator.
        duration: simulated time [s].
    """

    behaviour: BehaviourSettings
    character: Character
    controller: ControllerSettings
    criteria: Criteria
    disturbance: DisturbanceSettings
    excursion: ExcursionSettings
    physics: Physics
    plant: PlantSettings
    start: StartSettings
    terrain: Terrain
    seed: Annotated[int, Strict(), Field(ge=0, lt=2**63)]
    duration: Annotated[Positive, Field(le=3600)]


def load(overrides: list[str]) -> Config:
    """Compose and check a config.

    Args:
        overrides: in Hydra's syntax, such as `seed=3` or `terrain=flat`.

    Raises:
        InputError: one line that names the bad value and the valid choices or range.
    """
    data = composed(overrides)
    try:
        return check(data)
    except InputError as error:
        raise InputError(f"{_own_file(overrides, str(error))}{error}") from None


def _own_file(overrides: list[str], complaint: str) -> str:
    """The file of the user's that is at fault, for a message to begin with; else nothing.

    It is at fault if the choices among the overrides are wrong already, by themselves.
    """
    chosen = [one for one in map(simple, overrides) if one and choices(one.key)]
    mine = {one.key: named_file(one.key, one.value) for one in chosen}
    mine = {group: path for group, path in mine.items() if is_own(path)}
    if not mine:
        return ""
    try:
        check(composed([f"{one.key}={one.value}" for one in chosen]))
    except InputError as error:
        if str(error) == complaint:
            named = [path for group, path in mine.items() if f"{group}." in complaint]
            return f"{next(iter(named or mine.values()))}: "
    return ""


def recorded(log: RunLog) -> Config:
    """The config that a log holds, checked as any other.

    Raises:
        LogError: this rotctl cannot run it; one line that says why.
    """
    return rebuilt(log.path, lambda: documents.from_yaml("config", log.config_yaml))


def rebuilt(where: Path, data: Callable[[], Any]) -> Config:
    """A config out of a run that was made earlier, checked as any other.

    Raises:
        LogError: as for `recorded`.
    """
    try:
        return check(data())
    except InputError as error:
        raise LogError(f"{where}: its config makes no run here: {error}") from None


def composed(overrides: list[str]) -> dict[str, Any]:
    """The plain data of a config that is not checked yet; takes tenths of a second.

    Raises:
        InputError: as for `load`.
    """
    body = own_body.named(overrides)
    if body is None:
        return _composed(overrides)
    return {**_composed(body.others), own_body.GROUP: own_body.converted(body)}


def _composed(overrides: list[str]) -> dict[str, Any]:
    quick = [one for one in map(simple, overrides) if one]
    if len(quick) == len(overrides):
        data = _set_on_choices(quick)
        if data is not None:
            return data
    from rotctl.overrides import assigned, single

    found = [single(override) for override in overrides]
    require_plain([(str(o.key_or_group), str(o.value())) for o in found if _is_choice(o)])
    quick = [one for one in map(assigned, found) if one]
    if len(quick) == len(overrides):
        data = _set_on_choices(quick)
        if data is not None:
            return data
    return _by_hydra(overrides, found)


def _set_on_choices(found: list[Assignment]) -> dict[str, Any] | None:
    """What the choices among them make, with the other values set on it.

    None where more than that is asked, or something is wrong, for Hydra to tell.
    """
    chosen = [one for one in found if choices(one.key)]
    if any(one.value not in choices(one.key) for one in chosen):
        return None
    try:
        data: Any = copy.deepcopy(_chosen(tuple(chosen), folders(), _stamp(folders())))
    except InputError:
        return None
    for key, value in found:
        if choices(key):
            continue
        data = exchanged(data, way(key), value)
        if data is NOTHING:
            return None
    return data


@lru_cache(maxsize=64)
def _chosen(
    chosen: tuple[Assignment, ...], among: tuple[Path, ...], stamp: tuple[int, ...]
) -> dict[str, Any]:
    """Composed of choices alone, from files as they were at some time."""
    data = choosing.composed(chosen)
    if data is not None:
        return data
    from rotctl.overrides import single

    texts = [f"{group}={name}" for group, name in chosen]
    return _by_hydra(texts, [single(text) for text in texts])


def _stamp(among: tuple[Path, ...]) -> tuple[int, ...]:
    """When each file of some folders was changed."""
    forms = ("*.yaml", "*/*.yaml")
    paths = [path for folder in among for form in forms for path in sorted(folder.glob(form))]
    return tuple(path.stat().st_mtime_ns if path.exists() else 0 for path in paths)


def _by_hydra(overrides: list[str], found: "list[Override]") -> dict[str, Any]:
    from hydra import compose, initialize_config_dir
    from hydra.core.global_hydra import GlobalHydra
    from hydra.errors import HydraException
    from omegaconf import OmegaConf
    from omegaconf.errors import MissingMandatoryValue, OmegaConfBaseException

    GlobalHydra.instance().clear()
    try:
        with initialize_config_dir(str(conf_dir()), version_base="1.3"):
            config = compose("config", [*overrides, *_searched()])
            data: Any = OmegaConf.to_container(config, resolve=True, throw_on_missing=True)
    except MissingMandatoryValue as error:
        raise InputError(f"{error.full_key}: missing, give it as {error.full_key}=VALUE") from None
    except RecursionError:
        raise InputError(choosing.IN_A_CIRCLE) from None
    except (HydraException, OmegaConfBaseException, ValueError) as error:
        raise InputError(_explain(error, found)) from None
    return data


def _searched() -> list[str]:
    """Tells Hydra of the user's folder."""
    mine = own_dir()
    quoted = str(mine).replace("\\", "\\\\").replace("'", "\\'")
    return [f"hydra.searchpath=['file://{quoted}']"] if mine else []


def check(data: Any) -> Config:
    """Plain data to a typed config.

    Raises:
        InputError: one line for the first thing that is wrong.
    """
    _refuse(data, _absurd_text)  # before messages of other checks repeat it
    found = checked(Config, data)
    _refuse(data, _absurd_number)
    return found


def changed(config: Config, parts: Mapping[str, Any]) -> Config:
    """The same with other plain data for some of its parts; what stays is not checked again.

    Args:
        parts: by their names, such as `controller` or `seed`.

    Raises:
        InputError: one line for the first thing that is wrong with them.
    """
    made: dict[str, Any] = {name: _part(config, name, data) for name, data in parts.items()}
    return replace(config, **made)


@kept(most=1000)
def _part(config: Config, name: str, data: Any) -> Any:
    try:
        found = _adapter(name).validate_python(data)
    except ValidationError:
        return getattr(check({**to_dict(config), name: data}), name)  # which tells what is wrong
    for absurd in (_absurd_text, _absurd_number):
        _refuse({name: data}, absurd)
    return found


@cache
def _adapter(name: str) -> TypeAdapter[Any]:
    """Of the type of a config's part."""
    return TypeAdapter(get_type_hints(Config, include_extras=True)[name])


def _refuse(data: Any, absurd: Callable[[Way, Any], str]) -> None:
    """Raises InputError for the first value that no run, picture or terminal could use."""
    for parts, value in leaves(data):
        if complaint := absurd(parts, value):
            shown = [clip(part) if isinstance(part, str) else part for part in parts]
            raise InputError(f"{dotted(shown)}={brief(value)}: {complaint}")


def _absurd_text(parts: Way, value: Any) -> str:
    """What is wrong with a text or the keys that lead to a value; mostly nothing."""
    if any(not _short(part) for part in parts):
        return f"a key must be printable and have at most {LONGEST_TEXT} characters"
    if not isinstance(value, str):
        return ""
    if parts and parts[-1] in PROSE:
        return "must have no control characters" if UNPRINTABLE.search(value) else ""
    if not _short(value):
        return f"must be printable, on one line of at most {LONGEST_TEXT} characters"
    return "must not be empty" if parts and parts[-1] == "name" and not value.strip() else ""


def _short(text: object) -> bool:
    return len(str(text)) <= LONGEST_TEXT and _printable(str(text))


@lru_cache(maxsize=10_000)  # of the same keys, again and again
def _printable(text: str) -> bool:
    return text.isprintable()


def _absurd_number(parts: Way, value: Any) -> str:
    large = isinstance(value, int | float) and abs(value) > LARGEST and parts != ("seed",)
    return f"must be at most {LARGEST:g} in size" if large else ""


def to_dict(config: Config) -> dict[str, Any]:
    """The config as plain data, which nobody may change."""
    parts = {part.name: getattr(config, part.name) for part in fields(config)}
    return {name: _plain_part(part) for name, part in parts.items()}


@kept(most=1000)
def _plain_part(part: Any) -> Any:
    return _plain_data(part)


@cache
def _names(shape: Any) -> tuple[tuple[str, bool], ...]:
    return tuple((part.name, part.metadata == SPARSE) for part in fields(shape))


def _plain_data(value: Any) -> Any:
    """As pydantic dumps it, whose serialisers take longer to build than a run needs them."""
    if is_dataclass(value):
        shape: Any = type(value)
        parts = [(name, getattr(value, name), sparse) for name, sparse in _names(shape)]
        return {name: _plain_data(it) for name, it, sparse in parts if it is not None or not sparse}
    if isinstance(value, dict):
        return {key: _plain_data(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return type(value)(map(_plain_data, value))
    return value


def to_yaml(config: Config) -> str:
    """The config as YAML, in the order of the schema."""
    return "".join(_yaml(json.dumps({part: value})) for part, value in to_dict(config).items())


def part_to_yaml(config: Config, key: str) -> str:
    """What is under a key, as YAML.

    Raises:
        InputError: there is no such key.
    """
    place: Any = to_dict(config)
    parts = way(key)
    for depth, part in enumerate(parts):
        inner = member(place, part)
        if inner is NOTHING:
            valid = list(place) if isinstance(place, dict) else ["none, it is a value"]
            raise InputError(unknown_key(key, dotted(parts[:depth]), valid))
        place = inner
    return _yaml(json.dumps({parts[-1]: place})) if parts else to_yaml(config)


@lru_cache(maxsize=256)
def _yaml(part: str) -> str:
    """A part of a config from JSON to YAML; most parts are the same in many runs."""
    data = json.loads(part)
    (value,) = data.values()
    flow = None if isinstance(value, dict) else False  # short lists stay on one line
    return yaml.safe_dump(data, sort_keys=False, default_flow_style=flow, width=100)


def _is_choice(override: "Override") -> bool:
    return bool(choices(str(override.key_or_group))) and isinstance(override.value(), str)


def _explain(error: Exception, overrides: "list[Override]") -> str:
    """What Hydra could not do, in one line of our own."""
    chosen = tuple(str(o.input_line) for o in overrides if _is_choice(o))
    valid = _plain(chosen if len(chosen) < len(overrides) else ())  # () is the default
    named = re.search(r"(?:override|at) '?([^\s'=]+)", str(error))
    suspects = [o for o in overrides if not named or o.key_or_group == named[1]] or overrides
    for override in suspects:
        complaint = _complaint(override, valid)
        if complaint:
            return complaint
    return clip(" ".join(str(error).split()))


def _complaint(override: "Override", valid: dict[str, Any]) -> str:
    """Why an override does not fit a config; empty if it does."""
    key = str(override.key_or_group)
    if choices(key) and key not in valid:
        return f"{key} is no part of a config, its choices are added to one: write +{key}=CHOICE"
    if override.package:
        return unknown_key(f"{key}@{override.package}", "", list(valid))
    place, parts = valid, way(key)
    for depth, part in enumerate(parts):
        inner = member(place, part)
        if inner is NOTHING:
            none = f"none, it is {'null' if place is None else 'a value'}"
            some = list(place) if isinstance(place, dict) else [none]
            return unknown_key(key, dotted(parts[:depth]), some)
        place = inner
    if override.is_delete():
        return ""
    value = override.value()
    if override.is_add():
        return f"{key} is there already; write {key}=VALUE"
    if _is_choice(override):  # which is one of those that there are
        return ""
    try:
        check(put(valid, parts, value))
    except InputError as error:
        return str(error)
    return f"{key}={brief(value)}: has keys that are not there yet; write +{key}=VALUE"


@cache
def _plain(overrides: tuple[str, ...]) -> dict[str, Any]:
    return to_dict(load(list(overrides)))
