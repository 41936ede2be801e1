"""Overrides in Hydra's sweep syntax -> the points of the grid, each with its checked config.

Hydra composes a config in tenths of a second, which is too slow for a thousand points. So it
composes once for each choice of groups, and single values are set on its result.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import islice, product
from math import prod
from typing import Any

from hydra.core.override_parser.types import Glob, Override, OverrideType

from rotctl import plain
from rotctl.config import Config, check, composed, to_dict
from rotctl.errors import InputError
from rotctl.listing import choices
from rotctl.overrides import parsed
from rotctl.results.keys import value_at

MOST_POINTS = 100_000


@dataclass(frozen=True)
class Point:
    """One point of a grid.

    Attributes:
        overrides: one value each; `config.load` would make the same config of them.
    """

    overrides: tuple[str, ...]
    config: Config

    @property
    def values(self) -> dict[str, Any]:
        """Overridden key -> its value in the config, or the name of the choice of a group."""
        data = to_dict(self.config)
        keys = (str(_parsed(override).key_or_group) for override in self.overrides)
        return {key: value_at(data, key) for key in keys}


def points(matrix: Sequence[Sequence[str]]) -> Iterator[Point]:
    """The points of one grid after the other, the last key of each varying fastest.

    Args:
        matrix: grids, each a list of overrides such as `seed=range(0,100)` or `start=glob(*)`.

    Raises:
        InputError: the first thing that is wrong, in one line.
    """
    grids = [[_values(override) for override in grid] for grid in matrix]
    if sum(prod(map(len, grid)) for grid in grids) > MOST_POINTS:
        raise InputError(f"the sweep has more than {MOST_POINTS} points; make several sweeps")
    bases: dict[tuple[str, ...], dict[str, Any]] = {}
    for grid in grids:
        for overrides in product(*grid):
            yield Point(overrides, _config(overrides, bases))


_parsed = cache(parsed)


def _values(override: str) -> list[str]:
    """The single overrides that one with several values stands for."""
    found = parsed(override)
    key = str(found.key_or_group)
    if not found.is_sweep_override():
        return [override]
    if not found.is_discrete_sweep():
        raise InputError(f"{override}: has no steps; write {key}=range(start,stop,step)")
    pattern = found.value()
    if isinstance(pattern, Glob):
        valid = choices(key)
        names = pattern.filter(valid)
        if not names:
            some = f"no choice matches; valid: {', '.join(valid)}" if valid else "no such group"
            raise InputError(f"{override}: {some}")
        return [f"{found.get_key_element()}={name}" for name in names]
    values = list(islice(found.sweep_string_iterator(), MOST_POINTS + 1))
    if not values:
        raise InputError(f"{override}: has no values")
    return [f"{found.get_key_element()}={value}" for value in values]


def _config(overrides: tuple[str, ...], bases: dict[tuple[str, ...], dict[str, Any]]) -> Config:
    """As `config.load`, but quick where only plain values differ from an earlier point."""
    ways = [_way(override) for override in overrides]
    composing = tuple(o for o, parts in zip(overrides, ways, strict=True) if parts is None)
    setting = {parts: _parsed(o).value() for o, parts in zip(overrides, ways, strict=True) if parts}
    if any(_parsed(override).package or not _is_group(override) for override in composing):
        return check(composed(list(overrides)))  # their order may matter
    if composing not in bases:
        bases[composing] = composed(list(composing))
    data = bases[composing]
    for parts, value in setting.items():
        before = plain.find(data, parts)
        if before is plain.NOTHING or isinstance(before, dict):
            return check(composed(list(overrides)))  # a new key, or an error for Hydra to tell
        data = plain.put(data, parts, value)
    return check(data)


def _way(override: str) -> plain.Way | None:
    """The way to the value that an override sets, if setting is all it does."""
    found = _parsed(override)
    if found.type != OverrideType.CHANGE or found.package or _is_group(override):
        return None
    if isinstance(found.value(), dict):
        return None
    return plain.way(str(found.key_or_group))


def _is_group(override: str) -> bool:
    found: Override = _parsed(override)
    return bool(choices(str(found.key_or_group))) and found.type == OverrideType.CHANGE
