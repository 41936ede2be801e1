"""Dotted keys of configs."""

from typing import Any

from rotctl.plain import NOTHING, find, way


def value_at(data: Any, key: str) -> Any:
    """What plain config data have at a dotted key; the name, where that is a group's choice.

    Of the parts of a chain it is their names.
    """
    found = find(data, way(key))
    if isinstance(found, dict) and "name" in found:
        return found["name"]
    if isinstance(found, list | tuple) and found:
        names = [find(one, ("behaviour", "name")) for one in found]
        return found if NOTHING in names else ", ".join(map(str, names))
    return None if found is NOTHING else found
