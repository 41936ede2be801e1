"""Two runs or two sweeps side by side: where their configs differ, and their figures."""

import json
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from rotctl.errors import InputError
from rotctl.log import LOG_NAME, RunLog
from rotctl.results.configs import config_of
from rotctl.results.groups import grouped
from rotctl.results.keys import value_at
from rotctl.results.stored_runs import DONE, stored_runs
from rotctl.results.table import tabulated
from rotctl.settings import plain
from rotctl.settings.complaints import clip

_NOT_FIGURES = ("run_id", "real_time_factor", "wall_time")
FEW = 4  # values of a key that are told one by one
LONGEST = 80  # letters of a text, or of several
NAME = ".name"  # of a choice, in its group
_SPREAD = ("_q25", "_median", "_q75")


class Some(NamedTuple):
    """A figure that only so many runs of a sweep have."""

    figure: Any
    runs: int


@dataclass(frozen=True)
class Several:
    """The values of a key that runs of a sweep differ in, each once and in order."""

    values: tuple[Any, ...]


@dataclass(frozen=True)
class Side:
    """What is compared.

    Attributes:
        sweep: whether it is many runs.
        config: dotted key to value; of many runs `Several` where they differ.
        figures: name to value, or to (quartile, median, quartile); `Some` where only some runs
            have it.
        mixed: groups of which its runs have several choices.
    """

    sweep: bool
    config: Mapping[str, Any]
    figures: Mapping[str, Any]
    mixed: Collection[str] = ()


def compared(one: Path, other: Path, opened: Callable[[Path], RunLog]) -> str:
    """A table of what differs between two runs, or two sweeps.

    Args:
        opened: the log of a path.

    Raises:
        InputError: one is neither, or only one is a sweep.
    """
    sides = (_side(one, opened), _side(other, opened))
    if sides[0].sweep != sides[1].sweep:
        raise InputError(f"{one} and {other}: a run and a sweep; give two of a kind")
    mixed = {group for side in sides for group in side.mixed}
    ours, theirs = (_without_parts(side.config, mixed) for side in sides)
    return "\n".join(
        [
            *_table("config", ours, theirs, one, other),
            "",
            *_table("figures", sides[0].figures, sides[1].figures, one, other),
        ]
    )


def _side(path: Path, opened: Callable[[Path], RunLog]) -> Side:
    log = path / LOG_NAME if path.is_dir() else path
    if log.is_file():
        found = opened(log)
        return Side(False, _flat([config_of(found.config_yaml)]), _figures(found.outcome))
    runs, notes = stored_runs(path)
    done = [run for run in runs if run.status == DONE]
    if not done:
        raise InputError(f"{path}: no run in it is done")
    (row,) = grouped(tabulated(runs, notes), by=[], mixed=True).rows.to_dict("records")
    keys = [str(key) for key in row]
    rates = [key for key in keys if key.endswith("_rate") and row[key] == row[key]]
    measured = [key.removesuffix("_median") for key in keys if key.endswith("_median")]
    measured = [
        name for name in measured if f"{name}_rate" not in keys and name not in _NOT_FIGURES
    ]
    figures: dict[str, Any] = {"runs": row["n"]} | {key: row[key] for key in rates}
    spreads = {name: tuple(row[f"{name}{part}"] for part in _SPREAD) for name in measured}
    figures |= {name: spread for name, spread in spreads.items() if spread[1] == spread[1]}
    for name in figures:
        runs = row.get(f"{name.removesuffix('_rate')}_n", row["n"])
        figures[name] = figures[name] if runs == row["n"] else Some(figures[name], runs)
    config = _flat([dict(run.config) for run in done])
    mixed = [key for key in config if _names(key) and isinstance(config[key], Several)]
    for key in mixed:
        config[key] = ", ".join(sorted({str(value_at(run.config, key)) for run in done}))
    return Side(True, config, figures, [key.removesuffix(NAME) for key in mixed])


def _names(key: str) -> bool:
    """Whether a key is the name of a group's choice."""
    return key.count(".") == 1 and key.endswith(NAME)


def _without_parts(config: Mapping[str, Any], mixed: Collection[str]) -> dict[str, Any]:
    """Of groups of several choices their names alone, whose other keys have nothing in common."""
    return {
        key: value
        for key, value in config.items()
        if _names(key) or key.partition(".")[0] not in mixed
    }


def _flat(configs: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """Dotted keys of configs to their values, `Several` where they differ."""
    found: dict[str, dict[tuple[bool, float, str], Any]] = {}
    for k, config in enumerate(configs):
        values = {plain.dotted(parts): value for parts, value in plain.leaves(config)}
        for key in found.keys() | values.keys():
            value, earlier = values.get(key), {_order(None): None} if k else {}
            found.setdefault(key, earlier)[_order(value)] = value
    return {key: _one_or_several(list(values.values())) for key, values in found.items()}


def _one_or_several(values: Sequence[Any]) -> Any:
    return values[0] if len(values) == 1 else Several(tuple(sorted(values, key=_order)))


def _order(value: Any) -> tuple[bool, float, str]:
    """Numbers by their size, of which 1 and 1.0 are one, and then all else."""
    return (False, value, "") if _is_number(value) else (True, 0.0, repr(value))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _figures(outcome: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in outcome.items() if key not in _NOT_FIGURES}


def _table(title: str, one: Mapping[str, Any], other: Mapping[str, Any], *names: Path) -> list[str]:
    keys = [key for key in dict.fromkeys([*one, *other]) if _differ(one.get(key), other.get(key))]
    keys = keys if title == "figures" else sorted(keys)
    if not keys:
        return [f"{title}: the same"]
    rows = [[title, *map(str, names)]]
    rows += [[key, *_texts(one.get(key), other.get(key))] for key in keys]
    wide = [max(len(row[i]) for row in rows) for i in range(2)]
    return [f"{row[0]:{wide[0]}}  {row[1]:{wide[1]}}  {row[2]}".rstrip() for row in rows]


def _differ(one: Any, other: Any) -> bool:
    if isinstance(one, Several) and isinstance(other, Several):
        return [*map(_order, one.values)] != [*map(_order, other.values)]
    return isinstance(one, bool) != isinstance(other, bool) or bool(one != other)


def _texts(one: Any, other: Any) -> tuple[str, str]:
    """Of both sides, exactly or with what only one has where else they would look the same."""
    for exact in (False, True):
        ours, theirs = _text(one, exact), _text(other, exact)
        if ours != theirs:
            return ours, theirs
    if isinstance(one, Several) and isinstance(other, Several):
        return ours + _alone(one, other), theirs + _alone(other, one)
    return ours, theirs


def _alone(one: Several, other: Several) -> str:
    there = {_order(value) for value in other.values}
    alone = [_text(value, exact=True) for value in one.values if _order(value) not in there]
    more = f" and {len(alone) - FEW} more" if len(alone) > FEW else ""
    return f"; only here: {', '.join(alone[:FEW])}{more}" if alone else ""


def _text(value: Any, exact: bool = False) -> str:
    """For people.

    Args:
        exact: with all digits, and all of a text.
    """
    if isinstance(value, Some):
        return f"{_text(value.figure, exact)} of {value.runs}"
    if isinstance(value, Several):
        return clip(_several(value.values, exact), LONGEST)
    if isinstance(value, tuple):
        low, middle, high = (_text(each, exact) for each in value)
        return middle if low == middle == high else f"{middle} [{low}, {high}]"
    if isinstance(value, float):
        return str(value) if exact else f"{value:.4g}"
    if isinstance(value, str):
        return json.dumps(value) if exact else clip(json.dumps(value), LONGEST)
    return "-" if value is None else str(value)


def _several(values: Sequence[Any], exact: bool) -> str:
    """One by one; of many how many, and of numbers from where to where."""
    many = len(values) > FEW
    if many and not all(map(_is_number, values)):
        return f"{len(values)} values"
    shown = (values[0], values[-1]) if many else values
    told = [_text(value, exact) for value in shown]
    if len({*told}) < len(told):
        told = [_text(value, exact=True) for value in shown]
    return f"{len(values)} values, {told[0]} to {told[1]}" if many else ", ".join(told)
