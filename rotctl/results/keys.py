"""Dotted keys of configs."""

from typing import Any

from rotctl.settings.plain import NOTHING, find, way


def name_of(value: Any) -> str | None:
    """What plain data are called; those of an end of a roll, which have no name, by its stages."""
    if not isinstance(value, dict):
        return None
    stages = value.get("stages")
    if "name" not in value and isinstance(stages, list | tuple) and stages:
        names = [find(stage, ("name",)) for stage in stages]
        return None if NOTHING in names else ", ".join(map(str, names))
    return str(value["name"]) if "name" in value else None


def value_at(data: Any, key: str) -> Any:
    """What plain config data have at a dotted key; the name, where that is a group's choice.

    Of the parts of a chain it is what was said of them, for which names alone would be too little.
    """
    found = find(data, way(key))
    if isinstance(found, dict):
        return name_of(found) or found
    if isinstance(found, list | tuple) and found:
        names = [_part(one) for one in found]
        return found if NOTHING in names else ", ".join(map(str, names))
    return None if found is NOTHING else found


def _part(data: Any) -> Any:
    """What was said of a part of a chain, or its name; nothing of what is none."""
    name = find(data, ("behaviour", "name"))
    said = find(data, ("said",))
    return name if NOTHING in (name, said) else said or name
