"""Plain data - dicts and lists within each other - and dotted keys into them: `a.b.0`."""

import re
from collections.abc import Iterable, Iterator
from typing import Any

Way = tuple[str | int, ...]
NOTHING = object()  # what is where there is nothing; None may be a value


def way(key: str) -> Way:
    """`a.b.0` to ("a", "b", 0)."""
    return tuple(int(p) if p.isdecimal() else p for p in re.findall(r"[^.]+", key))


def dotted(parts: Iterable[str | int]) -> str:
    """("a", "b", 0) to `a.b.0`."""
    return ".".join(map(str, parts))


def member(data: Any, part: str | int) -> Any:
    """One step down; `NOTHING` where there is no such member."""
    if isinstance(data, dict):
        return data.get(part, NOTHING)
    if isinstance(data, list | tuple) and str(part).isdecimal() and int(part) < len(data):
        return data[int(part)]
    return NOTHING


def find(data: Any, parts: Iterable[str | int]) -> Any:
    """What is at the end of a way; `NOTHING` where it does not lead anywhere."""
    for part in parts:
        data = member(data, part)
    return data


def exchanged(data: Any, parts: Way, value: Any) -> Any:
    """The same data with another value in place of one; `NOTHING` where none of the two is one.

    What has keys below it is no value.
    """
    before = find(data, parts)
    if before is NOTHING or isinstance(before, dict) or isinstance(value, dict):
        return NOTHING
    return put(data, parts, value)


def leaves(data: Any, parts: Way = ()) -> Iterator[tuple[Way, Any]]:
    """The way to every value that has nothing below it, and that value."""
    if isinstance(data, dict) and data:
        for key, inner in data.items():
            yield from leaves(inner, (*parts, key))
    elif isinstance(data, list | tuple) and data:
        for index, inner in enumerate(data):
            yield from leaves(inner, (*parts, index))
    else:
        yield parts, data


def put(data: Any, parts: Way, value: Any) -> Any:
    """The same data with another value at the end of a way, which is made as far as need be.

    What does not change is shared; a list is filled up with 0.
    """
    if not parts:
        return value
    head, rest = parts[0], parts[1:]
    if isinstance(head, int):
        items = list(data) if isinstance(data, list | tuple) else []
        items += [0.0] * (head + 1 - len(items))
        items[head] = put(items[head], rest, value)
        return items
    members = data if isinstance(data, dict) else {}
    return {**members, head: put(members.get(head), rest, value)}


def keys_under(place: Any) -> list[str]:
    """The keys under a place in plain data, of a list its numbers; where there are none, why."""
    if isinstance(place, dict | list | tuple):
        names = list(place) if isinstance(place, dict) else [f"0 to {len(place) - 1}"]
        return names if place else ["none, it is empty"]
    return [f"none, it is {'null' if place is None else 'a value'}"]
