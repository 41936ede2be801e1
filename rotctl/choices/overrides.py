"""Overrides in Hydra's syntax, as strings from a command line, an experiment or a tune space.

Hydra's parser reads them; nothing is instantiated and no resolver is honoured, so that a
stranger's override cannot execute code.
"""

import re
from itertools import accumulate
from typing import Any

from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import ChoiceSweep, Glob, Override, OverrideType, Sweep
from hydra.errors import HydraException

from rotctl.choices.composing import MISSING, Assignment
from rotctl.choices.config_folders import conf_dir
from rotctl.choices.listing import choices, instead_of
from rotctl.errors import InputError
from rotctl.settings.complaints import brief, clip
from rotctl.suggestion import instead_of_many

LONGEST = 10_000  # characters; Hydra's parser takes seconds for a megabyte
LONGEST_KEY = 200
DEEPEST = 12  # brackets within each other
_STEPS = {"[": 1, "{": 1, "(": 1, "]": -1, "}": -1, ")": -1}


def parsed(override: str) -> Override:
    """An override, read but not carried out; it may be a sweep over several values.

    Raises:
        InputError: this tool does not take it; one line that says why.
    """
    shown = f"override {clip(override)!r}"
    if len(override) > LONGEST:
        raise InputError(f"{shown}: longer than {LONGEST} characters")
    if len(override.partition("=")[0]) > LONGEST_KEY:
        raise InputError(f"{shown}: its key is longer than {LONGEST_KEY} characters")
    if max(accumulate((_STEPS.get(c, 0) for c in override), initial=0)) > DEEPEST:
        raise InputError(f"{shown}: nested more than {DEEPEST} deep")
    if "${" in override or "_target_" in override:
        raise InputError(f"{shown}: interpolations and _target_ are not honoured; give a value")
    if re.match(r"[+~]*hydra[./=]", override):
        raise InputError(f"{shown}: Hydra's own settings cannot be changed here")
    if "=" not in override and not override.startswith("~"):
        raise InputError(f"{shown} has no '='; write {_with_value(override)}")
    try:
        found = OverridesParser.create().parse_override(override)
        if not found.is_sweep_override() and not found.is_delete():
            found.value()
    except (HydraException, RecursionError, ValueError):
        raise InputError(
            f"{shown}: cannot be read; write key=value, and quote a text with special "
            "characters: \"key='a text'\""
        ) from None
    if _has_sweep(found.value() if not found.is_delete() else None):
        raise InputError(
            f"{shown}: choice(...), range(...), interval(...) and glob(...) stand alone behind "
            "the '='; write its values one by one, as in seed=0,1,7"
        )
    if not found.key_or_group:
        raise InputError(f"{shown} has no key; write key=value, such as seed=3")
    if found.is_delete() and "=" in override:
        raise InputError(f"{shown}: to remove a key, write ~{found.key_or_group}")
    return found


def _has_sweep(value: Any) -> bool:
    """Whether a sweep is among other values, where Hydra reads it and cannot go through it."""
    inside = value.list if isinstance(value, ChoiceSweep) else value
    inside = list(inside.values()) if isinstance(inside, dict) else inside
    return isinstance(inside, list) and any(
        isinstance(each, Sweep | Glob) or _has_sweep(each) for each in inside
    )


def _with_value(word: str) -> str:
    """What a word without a value was probably meant to be."""
    if valid := choices(word):
        return f"{word}=CHOICE; valid: {', '.join(valid)}"
    groups = sorted(path.name for path in conf_dir().iterdir() if choices(path.name))
    chosen = [f"{group}={word}" for group in groups if word in choices(group)]
    return " or ".join(chosen[:3]) or "key=value, such as seed=3"


def single(override: str) -> Override:
    """An override that a single run takes.

    Raises:
        InputError: it is none; one line that says why.
    """
    found, shown = parsed(override), f"override {clip(override)!r}"
    key = str(found.key_or_group)
    if key == "experiment":
        raise InputError(f"{clip(override)}: is for sweeps: rotctl sweep +experiment=NAME")
    if found.is_sweep_override():
        raise InputError(f"{shown}: run takes one value for {key}; rotctl sweep takes many")
    if found.is_delete():
        return found
    value = found.value()
    if value == {}:
        raise InputError(f"{shown} changes nothing; give a value, or remove a key with ~key")
    valid = choices(key)
    if valid and not isinstance(value, dict) and value not in valid:
        near = instead_of(key, value, instead_of_many(value, valid, f"rotctl list {key}"))
        raise InputError(f"{key}={brief(value)}: no such choice; {near}")
    return found


def without_overruled(overrides: list[str]) -> list[str]:
    """Without those that a later one of the same key replaces and Hydra would not have replaced.

    Such are those of several values, as in a file of overrides that is for a sweep, and choices
    that are added: `+finish=stand` before `+finish=seat`.

    Raises:
        InputError: one of them cannot be read.
    """
    told = [override.partition("=")[0] for override in overrides]
    keys = [key.lstrip("+") for key in told]

    def stays(number: int, override: str) -> bool:
        if keys[number] not in keys[number + 1 :]:
            return True
        added = told[number].startswith("+") and choices(keys[number])
        if added and told[number] in told[number + 1 :]:
            return False
        return not parsed(override).is_sweep_override()

    return [override for number, override in enumerate(overrides) if stays(number, override)]


def assigned(found: Override) -> Assignment | None:
    """The value that an override sets, or the choice it makes; None where it does more."""
    if found.type != OverrideType.CHANGE or found.package or MISSING in str(found.input_line):
        return None
    return Assignment(str(found.key_or_group), found.value())


def is_choice(override: Override) -> bool:
    """Whether it chooses among the files of a group."""
    return bool(choices(str(override.key_or_group))) and isinstance(override.value(), str)
