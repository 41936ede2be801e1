"""Dotted keys of configs."""

from typing import Any


def value_at(data: Any, key: str) -> Any:
    """What plain config data have at a dotted key; the name, where that is a group's choice."""
    for part in key.split("."):
        if not isinstance(data, dict) or part not in data:
            return None
        data = data[part]
    return data["name"] if isinstance(data, dict) and "name" in data else data
