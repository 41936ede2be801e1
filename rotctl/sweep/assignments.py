"""Overrides of a grid with one value each; those that are plain need no Hydra to be read.

To import Hydra takes as long as to simulate ten short runs, and most grids are numbers and words.
"""

import re
from dataclasses import dataclass
from typing import Any

from rotctl.choices.composing import simple
from rotctl.choices.listing import choices
from rotctl.settings import plain

MOST_POINTS = 100_000
_RANGE = re.compile(r"range\((-?[0-9]{1,9}),(-?[0-9]{1,9})\)")


@dataclass(frozen=True)
class Assignment:
    """One override with one value.

    Attributes:
        text: in Hydra's syntax; key: that it is about.
        way: to the value that it sets, if setting is all it does.
        value: see `way`.
        ordered: whether it may matter what comes before and after it.
    """

    text: str
    key: str
    way: plain.Way | None
    value: Any
    ordered: bool


def quickly(override: str) -> list[Assignment] | None:
    """What `a=1`, `a=x,y` and `a=range(0,9)` stand for; None for whatever else there is."""
    key, _, text = override.partition("=")
    found = _RANGE.fullmatch(text)
    if found:
        first, end = map(int, found.groups())
        if not 0 < end - first <= MOST_POINTS:
            return None
        texts = [f"{key}={value}" for value in range(first, end)]
    else:
        texts = [f"{key}={part}" for part in text.split(",")]
    made = []
    valid = choices(key)
    for one in texts:
        single = simple(one)
        if single is None or valid and single.value not in valid:
            return None
        way = None if valid else plain.way(key)
        text = f"{key}={single.value}"
        made.append(Assignment(text, key.removeprefix("+"), way, single.value, False))
    return made
