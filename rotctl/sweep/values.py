"""One override with one or more values -> each value by itself, as Hydra reads it."""

from dataclasses import replace
from itertools import islice
from random import sample
from typing import Any

from hydra.core.override_parser.types import Glob, Override, OverrideType, RangeSweep, Transformer
from hydra.errors import HydraException

from rotctl.choices.listing import choices
from rotctl.choices.overrides import parsed
from rotctl.errors import InputError
from rotctl.settings import plain
from rotctl.sweep.assignments import MOST_POINTS, Assignment


def values(override: str) -> list[Assignment]:
    """The single overrides that one with several values stands for.

    Raises:
        InputError: it cannot be read, or stands for none.
    """
    found = parsed(override)
    key = str(found.key_or_group)
    if not found.is_sweep_override():
        return [_assignment(override, found)]
    if not found.is_discrete_sweep():
        raise InputError(f"{override}: has no steps; write {key}=range(start,stop,step)")
    pattern = found.value()
    if isinstance(pattern, Glob):
        valid = choices(key)
        names = pattern.filter(valid)
        if not names:
            some = f"no choice matches; valid: {', '.join(valid)}" if valid else "no such group"
            raise InputError(f"{override}: {some}")
        return [_read(f"{found.get_key_element()}={name}") for name in names]
    each = _each(override, found)
    if not each:
        raise InputError(f"{override}: has no values")
    element = found.get_key_element()
    way, ordered = _way(found)
    texts = [f"{element}={Transformer.str(value)}" for value in each]
    return [
        Assignment(text, key, way, value, ordered)
        if way is not None and type(value) in (bool, int, float)
        else _read(text)
        for text, value in zip(texts, each, strict=True)
    ]


def _each(override: str, found: Override) -> list[Any]:
    """The values of a sweep, at most one more than a sweep may have points."""
    wide, mixed = found.value(), False
    if isinstance(wide, RangeSweep) and wide.shuffle:  # Hydra would make a list of all it may have
        wide, mixed = replace(wide, shuffle=False), True
    try:
        each = replace(found, _value=wide).sweep_iterator(Transformer.identity)
        found_values = list(islice(each, MOST_POINTS + 1))
    except (HydraException, ValueError, ArithmeticError):
        key = found.key_or_group
        raise InputError(
            f"{override}: cannot be counted through; write {key}=range(start,stop,step) with "
            "finite numbers and a step that is not 0"
        ) from None
    return sample(found_values, len(found_values)) if mixed else found_values


def _read(override: str) -> Assignment:
    return _assignment(override, parsed(override))


def _assignment(text: str, found: Override) -> Assignment:
    way, ordered = _way(found)
    value = found.value()
    if isinstance(value, dict):
        way = None
        ordered = True
    return Assignment(text, str(found.key_or_group), way, value, ordered)


def _way(found: Override) -> tuple[plain.Way | None, bool]:
    """The way to the value that an override sets, if that is all; whether its order may matter."""
    chooses = found.type in (OverrideType.CHANGE, OverrideType.ADD)
    group = bool(choices(str(found.key_or_group))) and chooses
    if found.type != OverrideType.CHANGE or found.package or group:
        return None, bool(found.package) or not group
    return plain.way(str(found.key_or_group)), False
