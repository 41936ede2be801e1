"""Configs: composed by Hydra from `conf/`, then checked once into frozen dataclasses.

Hydra gives the groups and the override syntax; nothing is instantiated from a config and
no `_target_` or resolver is honoured, so that a stranger's config cannot execute code.
"""

import json
import re
from functools import cache, lru_cache
from typing import Annotated, Any

import yaml
from hydra import compose, initialize_config_dir
from hydra.core.global_hydra import GlobalHydra
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override
from hydra.errors import HydraException
from omegaconf import OmegaConf
from omegaconf.errors import MissingMandatoryValue, OmegaConfBaseException
from pydantic import Field, Strict, TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.rolling import RollingSettings
from rotctl.control import ControllerSettings
from rotctl.errors import InputError
from rotctl.listing import choices, conf_dir
from rotctl.mechanics.character import Character
from rotctl.mechanics.physics import Physics
from rotctl.mechanics.terrain import Terrain
from rotctl.metrics.rolling import RollingCriteria
from rotctl.settings import STRICT, Positive
from rotctl.simulation.start import StartSettings

LONGEST_OVERRIDE = 10_000  # characters; Hydra's parser takes seconds for a megabyte


@validated(frozen=True, config=STRICT)
class Config:
    """Everything that determines a run.

    Attributes:
        seed: of the run's random generator.
        duration: simulated time [s].
    """

    behaviour: RollingSettings
    character: Character
    controller: ControllerSettings
    criteria: RollingCriteria
    physics: Physics
    start: StartSettings
    terrain: Terrain
    seed: Annotated[int, Strict(), Field(ge=0, lt=2**63)]
    duration: Annotated[Positive, Field(le=3600)]


_ADAPTER = TypeAdapter(Config)


def load(overrides: list[str]) -> Config:
    """Compose and check a config.

    Args:
        overrides: in Hydra's syntax, such as `seed=3` or `terrain=flat`.

    Raises:
        InputError: one line that names the bad value and the valid choices or range.
    """
    return check(composed(overrides))


def composed(overrides: list[str]) -> dict[str, Any]:
    """The plain data of a config that is not checked yet; takes tenths of a second.

    Raises:
        InputError: as for `load`.
    """
    keys = [_checked_key(override) for override in overrides]
    GlobalHydra.instance().clear()
    try:
        with initialize_config_dir(str(conf_dir()), version_base="1.3"):
            config = compose("config", overrides)
            data: Any = OmegaConf.to_container(config, resolve=True, throw_on_missing=True)
    except MissingMandatoryValue as error:
        raise InputError(f"{error.full_key}: missing, give it as {error.full_key}=VALUE") from None
    except (HydraException, OmegaConfBaseException, ValueError) as error:
        raise InputError(_explain(error, keys, overrides)) from None
    return data


def check(data: Any) -> Config:
    """Plain data to a typed config.

    Raises:
        InputError: one line for the first thing that is wrong.
    """
    try:
        return _ADAPTER.validate_python(data)
    except ValidationError as error:
        raise InputError(_complaint(data, error.errors(include_url=False))) from None


def to_dict(config: Config) -> dict[str, Any]:
    """The config as plain data."""
    plain: dict[str, Any] = _ADAPTER.dump_python(config)  # much faster than asdict
    return plain


def to_yaml(config: Config) -> str:
    """The config as YAML, in the order of the schema."""
    return "".join(_yaml(json.dumps({part: value})) for part, value in to_dict(config).items())


@lru_cache(maxsize=256)
def _yaml(part: str) -> str:
    """A part of a config from JSON to YAML; most parts are the same in many runs."""
    data = json.loads(part)
    (value,) = data.values()
    flow = None if isinstance(value, dict) else False  # short lists stay on one line
    return yaml.safe_dump(data, sort_keys=False, default_flow_style=flow, width=100)


def parsed(override: str) -> Override:
    """An override, read but not carried out; it may be a sweep over several values.

    Raises:
        InputError: this tool does not take it; one line that says why.
    """
    shown = f"override {_clip(override)!r}"
    if len(override) > LONGEST_OVERRIDE:
        raise InputError(f"{shown}: longer than {LONGEST_OVERRIDE} characters")
    if "${" in override or "_target_" in override:
        raise InputError(f"{shown}: interpolations and _target_ are not honoured; give a value")
    if re.match(r"[+~]*hydra[./=]", override):
        raise InputError(f"{shown}: Hydra's own settings cannot be changed here")
    if "=" not in override and not override.startswith("~"):
        raise InputError(f"{shown} has no '='; write key=value, such as seed=3")
    try:
        found = OverridesParser.create().parse_override(override)
        if not found.is_sweep_override() and not found.is_delete():
            found.value()
    except (HydraException, RecursionError, ValueError):
        raise InputError(
            f"{shown}: cannot be read; write key=value, and quote a text with special "
            "characters: \"key='a text'\""
        ) from None
    if not found.key_or_group:
        raise InputError(f"{shown} has no key; write key=value, such as seed=3")
    return found


def _checked_key(override: str) -> str:
    """The key that an override changes, if it is one that a single run takes.

    Raises:
        InputError: it is not; one line that says why.
    """
    found, shown = parsed(override), f"override {_clip(override)!r}"
    key = str(found.key_or_group)
    if found.is_sweep_override():
        raise InputError(f"{shown}: run takes one value for {key}; rotctl sweep takes many")
    if found.is_delete():
        return key
    value = found.value()
    if value == {}:
        raise InputError(f"{shown} changes nothing; give a value, or remove a key with ~key")
    valid = choices(key)
    if valid and not isinstance(value, dict) and value not in valid:
        raise InputError(f"{key}={_brief(value)}: no such choice; valid: {', '.join(valid)}")
    return key


def _explain(error: Exception, keys: list[str], overrides: list[str]) -> str:
    """Hydra's messages in one line, with the valid keys where a key is unknown."""
    text = str(error)
    named = re.search(r"Could not override '([^']+)'", text)
    chosen = tuple(o for key, o in zip(keys, overrides, strict=True) if choices(key))
    valid = _plain(chosen if len(chosen) < len(overrides) else ())  # () is the default
    for key in [named.group(1)] if named else keys:
        complaint = _unknown_key(key, valid)
        if complaint:
            return complaint
    return " ".join(text.split())


def _unknown_key(key: str, data: Any) -> str:
    """What is wrong with a key, and the valid ones; empty if it is in `data`."""
    parts = key.split(".")
    if choices(key) and key not in data:
        return f"{key} is no part of a config, its choices are added to one: write +{key}=CHOICE"
    for depth, part in enumerate(parts):
        inner = _member(data, part)
        if inner is _NOTHING:
            where = ".".join(parts[:depth])
            keys = ", ".join(data) if isinstance(data, dict) else "none, it is a value"
            return f"unknown key {key!r}; valid keys{' under ' + where if where else ''}: {keys}"
        data = inner
    return ""


@cache
def _plain(overrides: tuple[str, ...]) -> dict[str, Any]:
    return to_dict(load(list(overrides)))


_NOTHING = object()


def _member(data: Any, part: int | str) -> Any:
    """One step down into plain data; `_NOTHING` where there is no such member."""
    try:
        return data[int(part) if isinstance(data, list | tuple) else part]
    except (KeyError, IndexError, TypeError, ValueError):
        return _NOTHING


_WORDS = {
    "tuple_type": "must be a list, in brackets",
    "list_type": "must be a list, in brackets",
    "dict_type": "must be keys with values",
    "dataclass_type": "must be keys with values",
}


def _complaint(data: Any, errors: list[Any]) -> str:
    """One line on the first thing that pydantic found wrong."""
    first = errors[0]
    kind, loc = first["type"], first["loc"]
    # Of loc, what is there in the data: pydantic adds the types of a union.
    path, found = [], data
    for part in loc:
        inner = _member(found, part)
        if inner is not _NOTHING:
            path.append(str(part))
            found = inner
    where = ".".join(path)
    if kind == "unexpected_keyword_argument":
        return _unknown_key(where, _plain(())) or f"unknown key {where!r}"
    if kind == "missing" and isinstance(found, list):
        # A list that is too short: pydantic counts the values that are not there.
        wanted = 1 + max(e["loc"][-1] for e in errors if e["loc"][:-1] == loc[:-1])
        return f"{where}={_brief(found)}: must have {wanted} values"
    if kind == "missing":
        return f"{'.'.join(map(str, loc))}: missing, it cannot be left out"
    limits = first.get("ctx", {})
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        # A group whose settings differ in kind, and a key that says which.
        key = limits["discriminator"].strip("'")
        if kind == "union_tag_not_found":
            return f"{where}.{key}: missing, it cannot be left out"
        return f"{where}.{key}={limits['tag']}: no such {key}; valid: {limits['expected_tags']}"
    if kind == "too_long":
        message = f"too many values, at most {limits['max_length']}"
    elif kind == "too_short":
        message = f"too few values, at least {limits['min_length']}"
    else:
        message = _WORDS.get(kind) or first["msg"].removeprefix("Value error, ")
        message = re.sub(r"^Input should be", "must be", message)
        message = message[:1].lower() + message[1:]
    return f"{where}={_brief(found)}: {message}"


def _brief(value: Any) -> str:
    return _clip(str(value) if isinstance(value, float) else json.dumps(value, default=str))


def _clip(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "..."
