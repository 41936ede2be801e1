"""Why overrides make no config: which of them it is, and what would be valid.

Hydra's own messages speak of its structures and of Python's types; here an override is held
against the config that it was to change.
"""

import re
from typing import Any

from hydra.core.override_parser.types import Override

from rotctl.choices.composing import package
from rotctl.choices.listing import choices
from rotctl.choices.overrides import is_choice
from rotctl.config.schema import check
from rotctl.errors import InputError
from rotctl.settings.complaints import brief, clip, unknown_key
from rotctl.settings.plain import NOTHING, Way, dotted, find, keys_under, member, put, way

PARTS = (("behaviour", "parts"), ("criteria", "parts"))  # of a chain
MOST = 3  # keys of one name that are told: among more nobody finds the one that is meant


def explain(error: Exception, overrides: list[Override], valid: dict[str, Any]) -> str:
    """What Hydra could not do, in one line of our own.

    Args:
        valid: the config that the overrides were to change, as plain data.
    """
    named = re.search(r"(?:override|at) '?([^\s'=]+)", str(error))
    suspects = [o for o in overrides if not named or o.key_or_group == named[1]] or overrides
    for override in suspects:
        complaint = _complaint(override, valid)
        if complaint:
            return complaint
    return clip(" ".join(str(error).split()))


def require_placed(overrides: list[Override]) -> None:
    """See that no key is below a group whose choices are about keys elsewhere.

    Raises:
        InputError: one is; one line that says where it is.
    """
    for override in overrides:
        key = str(override.key_or_group)
        group, _, rest = key.partition(".")
        if rest and choices(group) and package(group) != group:
            raise InputError(
                f"unknown key {clip(key)!r}; what +{group}=CHOICE adds is "
                f"{package(group)}.{clip(rest)}"
            )


def _complaint(override: Override, valid: dict[str, Any]) -> str:
    """Why an override does not fit a config; empty if it does."""
    key = str(override.key_or_group)
    if choices(key) and key not in valid:
        if override.is_delete():
            if find(valid, way(package(key))) in (NOTHING, None):
                return f"{key} is no part of a config, and here it has added nothing to remove"
            return f"{key} is no part of a config, what it has added is: write ~{package(key)}"
        return f"{key} is no part of a config, its choices are added to one: write +{key}=CHOICE"
    if override.package:
        return unknown_key(f"{key}@{override.package}", "", list(valid))
    place, parts = valid, way(key)
    if parts[:2] in PARTS and len(parts) > 3 and find(valid, parts[:3]) is not NOTHING:
        return (
            f"{clip(key)}: is inside a part of a chain; say it in the part's own text, as in "
            """'behaviour.parts=[stand,"cartwheel behaviour.target_excursion=360"]'"""
        )
    for depth, part in enumerate(parts):
        inner = member(place, part)
        if inner is NOTHING:
            sets = not override.is_add() and not override.is_delete()
            last = depth + 1 == len(parts) and isinstance(part, str) and isinstance(place, dict)
            if sets and last and _may_add(valid, parts, override.value()):
                return f"{key} is not there yet; write +{key}=VALUE"
            known = "" if depth else _elsewhere(valid, parts)
            return unknown_key(key, dotted(parts[:depth]), keys_under(place), known)
        place = inner
    if override.is_delete():
        if isinstance(parts[-1], int):
            return f"~{key}: of a list none can be left out; give the list without it"
        return f"~{key}: nothing is there to leave out" if place is None else ""
    value = override.value()
    if override.is_add():
        return f"{key} is there already; write {key}=VALUE"
    if is_choice(override):  # which is one of those that there are
        return ""
    try:
        check(put(valid, parts, value))
    except InputError as error:
        return str(error)
    if not isinstance(value, dict):
        return ""
    return f"{key}={brief(value)}: has keys that are not there yet; write +{key}=VALUE"


def _elsewhere(valid: dict[str, Any], parts: Way) -> str:
    """The keys that end in this one, those that are least deep; empty if none or many do."""
    level: list[tuple[Way, dict[str, Any]]] = [((), valid)]
    while level:
        level = [
            ((*place, name), inner)
            for place, found in level
            for name, inner in found.items()
            if isinstance(inner, dict)
        ]
        there = [dotted((*place, *parts)) for place, f in level if find(f, parts) is not NOTHING]
        if there:
            return " or ".join(there) if len(there) <= MOST else ""
    return ""


def _may_add(valid: dict[str, Any], parts: Way, value: Any) -> bool:
    """Whether settings have a key that this config leaves out, and the value is one for it.

    Where any key will do nobody knows whether this one is meant.
    """
    return _passes(put(valid, parts, value)) and not _passes(put(valid, (*parts[:-1], "?"), value))


def _passes(data: dict[str, Any]) -> bool:
    try:
        check(data)
    except InputError:
        return False
    return True
