"""Configs: composed by Hydra from `conf/`, then checked once into frozen dataclasses.

Hydra gives the groups and the override syntax; nothing is instantiated from a config and
no `_target_` or resolver is honoured, so that a stranger's config cannot execute code.
"""

import json
import re
from dataclasses import asdict
from typing import Annotated, Any

import yaml
from hydra import compose, initialize_config_dir
from hydra.core.global_hydra import GlobalHydra
from hydra.errors import HydraException
from omegaconf import OmegaConf
from omegaconf.errors import OmegaConfBaseException
from pydantic import Field, Strict, TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.rolling import RollingSettings
from rotctl.control import ControllerSettings
from rotctl.errors import InputError
from rotctl.listing import conf_dir, groups
from rotctl.mechanics.character import Character
from rotctl.mechanics.model import Physics
from rotctl.mechanics.terrain import Terrain
from rotctl.metrics.rolling import RollingCriteria
from rotctl.settings import STRICT, Positive
from rotctl.simulation.start import StartSettings


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
    for override in overrides:
        _refuse(override)
    GlobalHydra.instance().clear()
    try:
        with initialize_config_dir(str(conf_dir()), version_base="1.3"):
            composed = OmegaConf.to_container(compose("config", overrides), resolve=True)
    except (HydraException, OmegaConfBaseException) as error:
        raise InputError(_explain(error)) from None
    return check(composed)


def check(data: Any) -> Config:
    """Plain data to a typed config.

    Raises:
        InputError: one line for the first thing that is wrong.
    """
    try:
        return _ADAPTER.validate_python(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"])
        message = first["msg"].removeprefix("Value error, ")
        message = message[:1].lower() + message[1:]
        if first["type"] in ("unexpected_keyword_argument", "missing"):
            raise InputError(f"{where}: {_unknown_or_missing(data, first['loc'])}") from None
        raise InputError(f"{where}={_brief(first['input'])}: {message}") from None


def to_dict(config: Config) -> dict[str, Any]:
    """The config as plain data."""
    return asdict(config)  # type: ignore[call-overload]


def to_yaml(config: Config) -> str:
    """The config as YAML, in the order of the schema."""
    plain = json.loads(json.dumps(to_dict(config)))
    return yaml.safe_dump(plain, sort_keys=False, default_flow_style=None, width=100)


def _refuse(override: str) -> None:
    if "${" in override or "_target_" in override:
        raise InputError(
            f"override {override!r}: interpolations and _target_ are not honoured; give a value"
        )
    if re.match(r"[+~]*hydra[./=]", override):
        raise InputError(f"override {override!r}: Hydra's own settings cannot be changed here")
    if "=" not in override and not override.startswith("~"):
        raise InputError(f"override {override!r} has no '='; write key=value, such as seed=3")


def _explain(error: Exception) -> str:
    """Hydra's messages in one line, with the valid keys where a key is unknown."""
    text = str(error)
    struct = re.search(r"Could not override '([^']+)'", text)
    if struct:
        return _unknown_key(struct.group(1))
    group = re.search(r"Could not find '([^/']+)/([^']+)'", text)
    if group and group.group(1) in groups():
        name, choice = group.groups()
        return f"{name}={choice}: no such choice; valid: {', '.join(groups()[name])}"
    override = re.search(r"Could not override '([^']+)'\.\s*No match in the defaults list", text)
    if override:
        return _unknown_key(override.group(1))
    return " ".join(text.split())


def _unknown_key(key: str) -> str:
    data = yaml.safe_load(to_yaml(load([])))
    parts = key.split(".")
    for depth, part in enumerate(parts):
        if not isinstance(data, dict) or part not in data:
            where = ".".join(parts[:depth])
            keys = ", ".join(data) if isinstance(data, dict) else "none, it is a value"
            return f"unknown key {key!r}; valid keys{' under ' + where if where else ''}: {keys}"
        data = data[part]
    return f"cannot override {key!r}"


def _unknown_or_missing(data: Any, loc: tuple[int | str, ...]) -> str:
    inner = data
    for part in loc[:-1]:
        try:
            inner = inner[part]
        except (KeyError, IndexError, TypeError):
            break
    if isinstance(inner, dict) and loc[-1] in inner:
        return "unknown key"
    return "missing"


def _brief(value: Any) -> str:
    text = json.dumps(value, default=str)
    return text if len(text) <= 60 else text[:57] + "..."
