"""Overrides in Hydra's sweep syntax -> the points of the grid, each with its checked config.

Hydra composes a config in tenths of a second, and to check one takes milliseconds: too slow for a
hundred thousand points. So Hydra composes once for each choice of groups, single values are set
on its result, and of that only the parts they are in are checked, once for each value.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from math import prod
from typing import Any

from rotctl.behaviours.chain.settings import ChainSettings
from rotctl.choices import labels
from rotctl.choices.composing import package
from rotctl.choices.listing import choices
from rotctl.config.loading import load
from rotctl.config.schema import Config, changed
from rotctl.errors import InputError
from rotctl.results.keys import value_at
from rotctl.settings import plain
from rotctl.settings.writing import to_dict
from rotctl.sweep.assignments import MOST_POINTS, Assignment, quickly

PARTS = "behaviour.parts"  # of a chain, which are composed themselves
TAKEN = ("controller.", "excursion.")  # of a run, by parts of a chain without their own
Grids = list[list[list[Assignment]]]
Bases = dict[tuple[str, ...], Config]
Parts = dict[tuple[Any, ...], Any]
NOTHING_APART: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Point:
    """One point of a grid.

    Attributes:
        overrides: one value each; `loading.load` would make the same config of them.
        keys: that they are about.
    """

    overrides: tuple[str, ...]
    keys: tuple[str, ...]
    config: Config

    @property
    def values(self) -> dict[str, Any]:
        """Overridden key -> its value in the config, or the name of the choice of a group."""
        data = to_dict(self.config)
        return {key: value_at(data, key) for key in self.keys}


def points(matrix: Sequence[Sequence[str]]) -> Iterator[Point]:
    """The points of one grid after the other, the last key of each varying fastest.

    Args:
        matrix: grids, each a list of overrides such as `seed=range(0,100)` or `start=glob(*)`.

    Raises:
        InputError: the first thing that is wrong, in one line.
    """
    grids = _grids(matrix)
    if _count(grids) > MOST_POINTS:
        raise InputError(f"the sweep has more than {MOST_POINTS} points; make several sweeps")
    bases: Bases = {}
    parts: Parts = {}
    for grid in grids:
        keys = tuple(_told(each[0].key) for each in grid)
        for assignments in product(*grid):
            texts = tuple(one.text for one in assignments)
            yield Point(texts, keys, _config(assignments, bases, parts))


def _told(key: str) -> str:
    """Where a config has what is set: `+finish=stand` is `behaviour.finish` there."""
    return package(key) if choices(key) else key


def count(matrix: Sequence[Sequence[str]]) -> int:
    """How many points there are; arguments and errors as for `points`."""
    return _count(_grids(matrix))


def _count(grids: Grids) -> int:
    return sum(prod(map(len, grid)) for grid in grids)


def _grids(matrix: Sequence[Sequence[str]]) -> Grids:
    return [[_values(override) for override in grid] for grid in matrix]


def _values(override: str) -> list[Assignment]:
    """The single overrides that one with several values stands for."""
    found = quickly(override)
    if found is not None:
        return found
    from rotctl.sweep.values import values

    return values(override)


def _config(
    assignments: Sequence[Assignment],
    bases: Bases,
    parts: Parts,
    apart: frozenset[str] = NOTHING_APART,
) -> Config:
    """As `loading.load`, but quick where only plain values differ from an earlier point.

    Args:
        apart: parts of the config of which all that is said is composed, and not set.
    """
    texts = [one.text for one in assignments]
    ordered = [one.key for one in assignments if one.ordered]
    if any(one.key.startswith(PARTS) for one in assignments) or any(map(choices, ordered)):
        return load(texts)
    touched = apart | {key.partition(".")[0] for key in ordered}  # what comes first may matter
    set_by: dict[str, list[Assignment]] = {}
    composed = []
    for one in assignments:
        if one.way and (top := str(one.way[0])) not in touched:
            set_by.setdefault(top, []).append(one)
        else:
            composed.append(one.text)
    choosing = tuple(composed)
    if choosing not in bases:
        bases[choosing] = load(list(choosing))
    base = bases[choosing]
    labels.require_own(((one.key, one.value) for one in assignments), lambda: to_dict(base))
    if isinstance(base.behaviour, ChainSettings) and any(
        one.key.startswith(TAKEN) for one in assignments
    ):
        return load(texts)
    data = to_dict(base)
    made = {}
    for name, setting in set_by.items():
        key = (choosing, *(one.text for one in setting))
        if key not in parts:
            found = data
            for one in setting:
                found = plain.exchanged(found, one.way or (), one.value)
                if found is plain.NOTHING:  # a new key, null in place of a part, or an error
                    return _config(assignments, bases, parts, apart | {name})
            parts[key] = found[name]
        made[name] = parts[key]
    return changed(base, made)
