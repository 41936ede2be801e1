"""Dotted keys of configs."""

from typing import Any

from rotctl.plain import NOTHING, find, way


def value_at(data: Any, key: str) -> Any:
    """What plain config data have at a dotted key; the name, where that is a group's choice.

    Of the parts of a chain it is what was said of them, for which names alone would be too little.
    """
    found = find(data, way(key))
    if isinstance(found, dict) and "name" in found:
        return found["name"]
    if isinstance(found, list | tuple) and found:
        names = [_part(one) for one in found]
        return found if NOTHING in names else ", ".join(map(str, names))
    return None if found is NOTHING else found


def _part(data: Any) -> Any:
    """What was said of a part of a chain, or its name; nothing of what is none."""
    name = find(data, ("behaviour", "name"))
    said = find(data, ("said",))
    return name if NOTHING in (name, said) else said or name
