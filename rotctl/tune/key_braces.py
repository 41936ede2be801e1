"""Braces in a space's keys, as in a shell: `a.{b,c}.{0,1}` stands for four keys."""

import re
from collections.abc import Iterable, Iterator
from itertools import islice, product
from typing import Any

MOST = 1000  # parameters of one space; braces multiply
_BRACES = re.compile(r"\{([^{}]*)\}")


def expanded(parameters: Any) -> Any:
    """The parameters of a space, one for each key that its braces stand for.

    Never more than one above `MOST`. What is no list of parameters with keys is left as it is,
    for the schema to complain about.
    """
    return list(islice(_all(parameters), MOST + 1)) if isinstance(parameters, list) else parameters


def _all(parameters: Iterable[Any]) -> Iterator[Any]:
    for parameter in parameters:
        if isinstance(parameter, dict) and isinstance(parameter.get("key"), str):
            yield from (parameter | {"key": key} for key in _keys(parameter["key"]))
        else:
            yield parameter


def _keys(key: str) -> Iterator[str]:
    pieces = _BRACES.split(key)  # text and choices in turn
    choices = [piece.split(",") if i % 2 else [piece] for i, piece in enumerate(pieces)]
    for chosen in product(*choices):
        yield "".join(piece.strip() for piece in chosen)
