"""Numbers in and out of a config's plain data, by dotted key; what a space makes of a config."""

from collections.abc import Mapping, Sequence
from typing import Any

from rotctl.caching import kept
from rotctl.config.loading import load
from rotctl.config.schema import Config, changed, check
from rotctl.errors import InputError
from rotctl.settings import plain
from rotctl.settings.plain import NOTHING, dotted, member, way
from rotctl.settings.writing import to_dict
from rotctl.tune.space import TRAINING_SEEDS, Space, unseeded

Values = dict[str, float]  # key -> value, in the order of the space
BLOCK = 1_000_000  # training seeds of one search
FINAL = 900_000  # of these, from here on, those that choose between the last candidates


def get(data: Any, key: str) -> float:
    """The number at a key.

    Raises:
        InputError: there is none; the line names the valid keys there.
    """
    value, parts = data, way(key)
    for depth, part in enumerate(parts):
        inner = member(value, part)
        if inner is NOTHING:
            where, valid = dotted(parts[:depth]) or "it", _members(value)
            raise InputError(f"parameter {key}: not in the config; valid under {where}: {valid}")
        value = inner
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(f"parameter {key}: is {_members(value)}, no single number")
    return float(value)


def put(data: Any, values: Mapping[str, float]) -> Any:
    """The same plain data with numbers changed; every key must be there."""
    for key, value in values.items():
        data = plain.put(data, way(key), value)
    return data


def start_values(space: Space, data: Any) -> Values:
    """The numbers that the search starts from.

    Raises:
        InputError: a key is not in the config, a range is not allowed there, or the start is
            outside its range.
    """
    start = {}
    for parameter in space.parameters:
        key, low, high = parameter.key, parameter.low, parameter.high
        start[key] = get(data, key)
        if not low <= start[key] <= high:
            raise InputError(
                f"parameter {key}: starts at {start[key]:g} {parameter.unit}, "
                f"outside its range {low:g} to {high:g}"
            )
        for bound in (low, high):
            check(put(data, {key: bound}))
    return start


def variations(space: Space, overrides: list[str]) -> list[Any]:
    """The configs that candidates are put into, as plain data, one for each variation.

    Args:
        overrides: of the command line; they go over those of the space, and under its variations.

    Raises:
        InputError: an override is none, or chooses seeds.
    """
    try:
        unseeded(overrides)
    except ValueError as error:
        raise InputError(str(error)) from None
    below = [f"duration={space.runs.duration:.10g}", *space.base, *overrides]
    return [_begun(space, to_dict(load([*below, *changes]))) for changes in space.runs.variations]


def configs(data: Sequence[Any], values: Mapping[str, float], seeds: Sequence[int]) -> list[Config]:
    """The configs of a candidate's runs: one for each seed, the variations in turn.

    Raises:
        InputError: a seed is for judging, or the values make no config.
    """
    if min(seeds) < TRAINING_SEEDS:
        raise InputError(f"seed={min(seeds)}: training seeds start at {TRAINING_SEEDS:,}")
    groups = list(dict.fromkeys(str(way(key)[0]) for key in values))
    filled = [
        put({group: variation[group] for group in groups}, values)
        for variation in data[: len(seeds)]
    ]
    return [
        changed(_checked(data[i % len(data)]), {**filled[i % len(data)], "seed": seed})
        for i, seed in enumerate(seeds)
    ]


@kept(most=100)
def _checked(variation: Any) -> Config:
    """The config of a variation, of which a candidate changes some parts."""
    return check(variation)


def training_seeds(space: Space, seed: int, generation: int) -> range:
    """Seeds of the runs of every candidate in a generation: fresh ones for each generation."""
    first = space.runs.first_seed + seed * BLOCK + generation * space.runs.seeds
    return range(first, first + space.runs.seeds)


def final_seeds(space: Space, seed: int) -> range:
    """Seeds that no generation has seen."""
    first = space.runs.first_seed + seed * BLOCK + FINAL
    return range(first, first + space.runs.final)


def _begun(space: Space, data: Any) -> Any:
    """Plain data, with the numbers that it does not have and the space has a start for."""
    for parameter in space.parameters:
        parts = way(parameter.key)
        if parameter.start is not None and plain.find(data, parts) is NOTHING:
            data = plain.put(data, parts, parameter.start)
    return data


def _members(data: Any) -> str:
    if isinstance(data, dict):
        return ", ".join(data)
    if isinstance(data, list | tuple):
        return f"a list of {len(data)}"
    return f"the value {data!r}"
