"""Frozen settings to plain data and to YAML: the way back from `rotctl.settings.checking`.

A run is known by the hash of what its config is written as.
"""

import json
from dataclasses import fields, is_dataclass
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any

import yaml

from rotctl.caching import kept
from rotctl.errors import InputError
from rotctl.settings.complaints import unknown_key
from rotctl.settings.fields import SPARSE
from rotctl.settings.plain import NOTHING, dotted, keys_under, member, way

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


@kept(most=1000)
def to_dict(settings: "DataclassInstance") -> dict[str, Any]:
    """The settings as plain data, which nobody may change."""
    return {name: _plain_part(getattr(settings, name)) for name, _ in _names(type(settings))}


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


def to_yaml(settings: "DataclassInstance") -> str:
    """The settings as YAML, in the order of their fields."""
    parts = [(part.name, getattr(settings, part.name)) for part in fields(settings)]
    return "".join(_yaml_part(name, part) for name, part in parts)


def part_to_yaml(settings: "DataclassInstance", key: str) -> str:
    """What is under a key, as YAML.

    Raises:
        InputError: there is no such key.
    """
    place: Any = to_dict(settings)
    parts = way(key)
    for depth, part in enumerate(parts):
        inner = member(place, part)
        if inner is NOTHING:
            raise InputError(unknown_key(key, dotted(parts[:depth]), keys_under(place)))
        place = inner
    return _yaml(json.dumps({parts[-1]: place})) if parts else to_yaml(settings)


@kept(most=1000)
def _yaml_part(name: str, part: Any) -> str:
    if type(part) is int:  # a seed, of which each run has another
        return f"{name}: {part}\n"
    return _yaml(json.dumps({name: _plain_part(part)}))


@lru_cache(maxsize=256)
def _yaml(part: str) -> str:
    """A part of them from JSON to YAML; most parts are the same in many runs."""
    data = json.loads(part)
    (value,) = data.values()
    flow = None if isinstance(value, dict) else False  # short lists stay on one line
    return yaml.safe_dump(data, sort_keys=False, default_flow_style=flow, width=100)
