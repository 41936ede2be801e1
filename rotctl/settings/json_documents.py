"""JSON from strangers to plain data, within the bounds of `documents`."""

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

from rotctl import files
from rotctl.errors import InputError
from rotctl.settings.documents import DEEPEST, MOST_DIGITS, UNPRINTABLE

LARGEST_LINES = 100_000_000  # bytes of a file of JSON lines
MOST_LINES = 500_000
_FEW = 900  # brackets, so that no depth of them overflows a stack


def from_json(text: str) -> Any:
    """The data of a JSON text.

    Raises:
        ValueError: it is none, or not plain.
    """
    try:
        data = json.loads(text, **_PLAIN_NUMBERS, object_pairs_hook=_unique)
    except RecursionError:
        raise ValueError("nested too deeply") from None
    for value, depth in _walk(data):
        if isinstance(value, str) and UNPRINTABLE.search(value):
            raise ValueError("a text has a control character")
        if depth == DEEPEST and isinstance(value, dict | list):
            raise ValueError(f"nested more than {DEEPEST} deep")
    return data


def from_json_line(text: str) -> dict[str, Any]:
    """The object of one line of ASCII, quickly where nothing in it asks for a closer look.

    Raises:
        ValueError: it is none, or not plain.
    """
    brackets = text.count("{") + text.count("[")
    quick = brackets < _FEW and "\\" not in text and text.rstrip("\n").isprintable()
    data = json.loads(text, **_PLAIN_NUMBERS) if quick else from_json(text)
    if not isinstance(data, dict):
        raise ValueError("no object")
    return data


def read_json_lines(path: Path, *, linked: bool) -> Iterator[tuple[int, Any]]:
    """The data of every line, with its number from 1 on; None where it is no plain JSON.

    Raises:
        InputError: it is no text file, or too large.
    """
    lines = files.text(path, LARGEST_LINES, linked=linked).split("\n")
    if not lines[-1]:
        lines.pop()
    if len(lines) > MOST_LINES:
        raise InputError(f"{path}: more than {MOST_LINES} lines")
    for number, line in enumerate(lines, 1):
        try:
            yield number, from_json(line)
        except ValueError:
            yield number, None


def _walk(data: Any) -> Iterator[tuple[Any, int]]:
    """All values and keys, with how deep they are; the depth is a stranger's: no recursion."""
    waiting = [(data, 0)]
    while waiting:
        value, depth = waiting.pop()
        yield value, depth
        if isinstance(value, dict):
            waiting += [(inner, depth + 1) for pair in value.items() for inner in pair]
        elif isinstance(value, list):
            waiting += [(inner, depth + 1) for inner in value]


def _no_number(name: str) -> NoReturn:
    raise ValueError(f"{name} is no number")


def _finite(digits: str) -> float:
    number = float(digits)
    if not math.isfinite(number):
        raise ValueError("a number is too large")
    return number


def _short(digits: str) -> int:
    if len(digits) > MOST_DIGITS:
        raise ValueError(f"a number has more than {MOST_DIGITS} digits")
    return int(digits)


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        raise ValueError("a key comes twice")
    return found


_PLAIN_NUMBERS: Any = {"parse_constant": _no_number, "parse_float": _finite, "parse_int": _short}
