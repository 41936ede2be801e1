"""One line on the first thing that is wrong with settings, in the words of their file."""

import json
import re
from collections.abc import Sequence
from typing import Any

from rotctl.settings.plain import NOTHING, dotted, member
from rotctl.settings.shapes import keys, kinds_with
from rotctl.suggestion import meant

LONGEST = 60  # characters of a value that a message repeats

# What settings are that may be one of several things, each of which complains by itself.
_EITHER = {
    "bool_type": "true or false",
    "int_type": "a whole number",
    "float_type": "a number",
    "string_type": "a text",
    "tuple_type": "a range, [low, high]",
}
_WORDS = {
    "tuple_type": "must be a list, in brackets",
    "list_type": "must be a list, in brackets",
    "dict_type": "must be keys with values",
    "dataclass_type": "must be keys with values",
    "too_long": "too many values, at most {max_length}",
    "too_short": "too few values, at least {min_length}",
    "missing": "missing, it cannot be left out",
    "union_tag_not_found": "missing, it cannot be left out",
}


def brief(value: Any) -> str:
    """A value as an override would have it; cut if it is long."""
    return clip(str(value) if isinstance(value, float) else json.dumps(value, default=str))


def clip(text: str, longest: int = LONGEST) -> str:
    """The text, or its beginning if it is long."""
    return text if len(text) <= longest else text[: longest - 3] + "..."


def complaint(shape: type, data: Any, errors: list[Any]) -> str:
    """One line on the first thing that pydantic found wrong."""
    place_of = errors[0]["loc"][:-1]
    # A key that is not known says more than the one that is missing for it.
    beside = [e for e in errors if e["loc"][:-1] == place_of]
    first = next((e for e in beside if e["type"] == "unexpected_keyword_argument"), errors[0])
    first, either = _of_a_union(data, first, errors)
    kind, way, limits = first["type"], first["loc"], first.get("ctx", {})
    # Of the way, what is there in the data: pydantic adds the types of a union.
    place: list[int | str] = []
    found = data
    for part in way:
        inner = member(found, part)
        if inner is not NOTHING:
            place.append(clip(part) if isinstance(part, str) else part)
            found = inner
    where = dotted(place)
    if kind == "unexpected_keyword_argument":
        elsewhere = kinds_with(shape, way)
        if elsewhere:
            return f"{where}: {clip(str(way[-2]))} settings have none; {elsewhere} ones have"
        return unknown_key(where, dotted(place[:-1]), keys(shape, way[:-1]))
    if kind == "missing" and isinstance(found, list | tuple):
        # A list that is too short: pydantic counts the values that are not there.
        wanted = 1 + max(e["loc"][-1] for e in errors if e["loc"][:-1] == way[:-1])
        return f"{where}={brief(found)}: must have {wanted} values"
    if kind == "union_tag_invalid":
        # Settings that differ in kind, and a key that says which.
        key = limits["discriminator"].strip("'")
        name, valid = dotted([*place, key]), limits["expected_tags"]
        near = meant(limits["tag"], valid.replace("'", "").split(", "))
        return f"{name}={brief(limits['tag'])}: no such {key}; {near}valid: {valid}"
    if kind in ("missing", "union_tag_not_found"):
        absent = way[-1] if kind == "missing" else limits["discriminator"].strip("'")
        return f"{dotted([*place, absent])}: {_WORDS[kind]}"
    message = either or _WORDS.get(kind, "").format(**limits) or first["msg"]
    message = message.removeprefix("Value error, ")
    message = re.sub(r"^Input should be", "must be", message)
    if kind == "value_error" and where and _begins_with_key(message, found):
        return f"{where}.{message}"
    plain = not isinstance(found, dict | list | tuple)
    # A longer one is looked up in the file; a check of our own says what it is about.
    shown = plain or (kind != "value_error" and len(str(found)) < LONGEST)
    place_and_value = f"{where}={brief(found)}" if shown else where
    return f"{place_and_value}: {message[:1].lower()}{message[1:]}" if where else message


def _of_a_union(data: Any, first: Any, errors: list[Any]) -> tuple[Any, str]:
    """Of what the members of a union say the one that is about such a value, or what they all want.

    A list is no number, which nobody takes it for: what is wrong with it says who takes lists.
    """
    if first["type"] not in _EITHER:
        return first, ""
    *shared, last = first["loc"]
    found = data
    for part in shared:
        found = found if (inner := member(found, part)) is NOTHING else inner
    if member(found, last) is not NOTHING:
        return first, ""
    said = [error for error in errors if list(error["loc"][: len(shared)]) == shared]
    inside = [e for e in said if e["type"] not in _EITHER or len(e["loc"]) > len(first["loc"])]
    if isinstance(found, list | tuple) and inside:
        return inside[0], ""
    *some, other = [_EITHER[error["type"]] for error in said if error not in inside]
    return first, f"must be {', '.join(some)} or {other}" if some else ""


def _begins_with_key(message: str, found: Any) -> bool:
    """Whether a check of our own says which of the keys there it is about, `ways.0.parts: `.

    With its value, `height=0.1: `, if it likes.
    """
    match = re.match(r"(\w+)(?:\.\w+)*(?:=[^:]*)?: ", message)
    return match is not None and isinstance(found, dict) and match[1] in found


def unknown_key(key: str, where: str, valid: Sequence[str], known: str = "") -> str:
    """One line on a key that settings do not have, `known` elsewhere by that name."""
    under = f" under {where}" if where else ""
    wrong = key.removeprefix(f"{where}.").partition(".")[0]  # what is below it may be right
    near = f"did you mean {known}? " if known else meant(wrong, valid)
    return f"unknown key {clip(key)!r}; {near}valid keys{under}: {', '.join(valid)}"
