"""The keys of settings, found on the way to a place in them."""

from collections.abc import Sequence
from dataclasses import is_dataclass
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints


def keys(shape: Any, way: Sequence[int | str] = ()) -> list[str]:
    """The keys that settings have at some place; empty where any key will do, or none.

    Args:
        shape: a validated dataclass.
        way: to the place, as pydantic's errors have it: with the tags of unions.
    """
    for part in way:
        shape = _inner(shape, part)
    if get_origin(shape) in (Union, UnionType):  # with None, else the way would have a tag
        shape = next(each for each in get_args(shape) if each is not NoneType)
    return list(shape.__dataclass_fields__) if is_dataclass(shape) else []


def kinds_with(shape: type, way: Sequence[int | str]) -> str:
    """The other kinds of settings that have the key at the end of a way; empty if none has."""
    union: Any = shape
    for part in way[:-2]:
        union = _inner(union, part)
    members = [each for each in get_args(union) for each in (each, *get_args(each))]
    told_by = {key for each in members for key, tags in _literals(each) if way[-2] in tags}
    having = [each for each in members if is_dataclass(each) and way[-1] in keys(each)]
    tags = {
        tag for each in having for key, some in _literals(each) if key in told_by for tag in some
    }
    return " and ".join(sorted(tags))


def _inner(shape: Any, part: int | str) -> Any:
    """The type one step down, as far as it leads to settings."""
    origin, inside = get_origin(shape), get_args(shape)
    if origin is Annotated:
        return _inner(inside[0], part)
    if origin in (Union, UnionType):
        some = [each for each in inside if each is not NoneType]
        tagged = [each for each in some if part in _tags(each)]
        return tagged[0] if tagged else _inner(some[0], part)
    if origin in (list, tuple):
        return inside[0]
    if origin is dict:
        return inside[1]
    hints = get_type_hints(shape, include_extras=True) if is_dataclass(shape) else {}
    return hints.get(str(part))


def _tags(shape: Any) -> set[Any]:
    """What a member of a union may be told by."""
    return {tag for _, tags in _literals(shape) for tag in tags}


def _literals(shape: Any) -> list[tuple[str, tuple[Any, ...]]]:
    """The keys of settings that have a few words as values, with those."""
    hints = get_type_hints(shape) if is_dataclass(shape) else {}
    return [(key, get_args(hint)) for key, hint in hints.items() if get_origin(hint) is Literal]
