"""Two runs or two sweeps side by side: where their configs differ, and their figures."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rotctl import plain
from rotctl.errors import InputError
from rotctl.log import LOG_NAME, RunLog
from rotctl.results.configs import config_of
from rotctl.results.groups import grouped
from rotctl.results.stored_runs import DONE, stored_runs
from rotctl.results.table import tabulated

_NOT_FIGURES = ("run_id", "real_time_factor", "wall_time")
_VARIES = "(varies)"
_SPREAD = ("_q25", "_median", "_q75")


@dataclass(frozen=True)
class Side:
    """What is compared.

    Attributes:
        sweep: whether it is many runs.
        config: dotted key to value; of many runs what they share, else `(varies)`.
        figures: name to value, or to (quartile, median, quartile).
    """

    sweep: bool
    config: Mapping[str, Any]
    figures: Mapping[str, Any]


def compared(one: Path, other: Path) -> str:
    """A table of what differs between two runs, or two sweeps.

    Raises:
        InputError: one is neither, or only one is a sweep.
    """
    sides = (_side(one), _side(other))
    if sides[0].sweep != sides[1].sweep:
        raise InputError(f"{one} and {other}: a run and a sweep; give two of a kind")
    return "\n".join(
        [
            *_table("config", sides[0].config, sides[1].config, one, other),
            "",
            *_table("figures", sides[0].figures, sides[1].figures, one, other),
        ]
    )


def _side(path: Path) -> Side:
    log = path / LOG_NAME if path.is_dir() else path
    if log.is_file():
        found = RunLog.open(log)
        return Side(False, _flat([config_of(found.config_yaml)]), _figures(found.outcome))
    runs, notes = stored_runs(path)
    done = [run for run in runs if run.status == DONE]
    if not done:
        raise InputError(f"{path}: no run in it is done")
    (row,) = grouped(tabulated(runs, notes), by=[], mixed=True).rows.to_dict("records")
    keys = [str(key) for key in row]
    measured = [key.removesuffix("_median") for key in keys if key.endswith("_median")]
    figures: dict[str, Any] = {"runs": row["n"], "success_rate": row["success_rate"]}
    spreads = {name: tuple(row[f"{name}{part}"] for part in _SPREAD) for name in measured}
    figures |= {name: spread for name, spread in spreads.items() if spread[1] == spread[1]}
    return Side(True, _flat([dict(run.config) for run in done]), figures)


def _flat(configs: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """Dotted keys of configs to their values, `(varies)` where they differ."""
    found: dict[str, Any] = {}
    for k, config in enumerate(configs):
        values = {plain.dotted(parts): value for parts, value in plain.leaves(config)}
        for key in found.keys() | values.keys():
            value = values.get(key)
            found[key] = value if not k or found.get(key) == value else _VARIES
    return found


def _figures(outcome: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in outcome.items() if key not in _NOT_FIGURES}


def _table(title: str, one: Mapping[str, Any], other: Mapping[str, Any], *names: Path) -> list[str]:
    keys = [key for key in dict.fromkeys([*one, *other]) if one.get(key) != other.get(key)]
    keys = keys if title == "figures" else sorted(keys)
    if not keys:
        return [f"{title}: the same"]
    rows = [[title, *map(str, names)]]
    rows += [[key, _text(one.get(key)), _text(other.get(key))] for key in keys]
    wide = [max(len(row[i]) for row in rows) for i in range(2)]
    return [f"{row[0]:{wide[0]}}  {row[1]:{wide[1]}}  {row[2]}".rstrip() for row in rows]


def _text(value: Any) -> str:
    if isinstance(value, tuple):
        low, middle, high = value
        return f"{_text(middle)} [{_text(low)}, {_text(high)}]"
    if isinstance(value, float):
        return f"{value:.4g}"
    return "-" if value is None else json.dumps(value) if isinstance(value, str) else str(value)
