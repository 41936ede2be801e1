"""The runs of a folder, a line each."""

import json
import os
from collections.abc import Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from rotctl.results.keys import value_at
from rotctl.results.stored_runs import DONE, StoredRun
from rotctl.results.table import differing

_SHOWN = ("behaviour", "seed", "duration", "run_id")  # in columns of their own
MOST = 6  # config keys on a line
LONGEST = 60  # letters of a value: a chain's parts in full are a page
_NONE = "-"


def lines(runs: Sequence[StoredRun], folder: Path) -> list[str]:
    """What tells runs apart, and how they ended.

    Args:
        runs: of the folder.
        folder: where their logs lie.

    Returns:
        Per run: id, when its log was written, behaviour, seed, how long it lasted, the config
        values in which it differs from other runs of its behaviour, how it ended.
    """
    rows = [_cells(run, keys, folder) for run, keys in zip(runs, _keys(runs), strict=True)]
    wide = [max((len(row[i]) for row in rows), default=0) for i in range(len(rows[0]) - 1)]
    return [
        "  ".join([*(f"{c:{w}}" for c, w in zip(r, wide, strict=False) if w), r[-1]]) for r in rows
    ]


def _keys(runs: Sequence[StoredRun]) -> list[list[str]]:
    """The config keys of each run that set it apart."""
    alike: dict[str, list[StoredRun]] = {}
    for run in runs:
        alike.setdefault(_behaviour(run), []).append(run)
    found = {name: _apart(some) for name, some in alike.items()}
    return [found[_behaviour(run)] for run in runs]


def _apart(runs: Sequence[StoredRun]) -> list[str]:
    keys = [key for run in runs for key in run.values]
    keys += differing(run.config for run in runs if run.config)
    return [key for key in dict.fromkeys(keys) if key not in _SHOWN]


def _behaviour(run: StoredRun) -> str:
    return str(run.outcome.get("behaviour", run.values.get("behaviour", _NONE)))


def _cells(run: StoredRun, keys: Sequence[str], folder: Path) -> list[str]:
    lasted = run.outcome.get("duration")
    ended = "success" if run.outcome.get("success") else str(run.outcome.get("failure_reason", ""))
    without = f"{run.status}: {run.reason}" if run.reason else run.status
    return [
        run.run_id,
        _written(folder / run.log) if run.log else "",
        _behaviour(run),
        f"seed {run.outcome.get('seed', run.values.get('seed', _NONE))}",
        f"{lasted:.1f} s" if isinstance(lasted, int | float) else _NONE,
        _values(run, keys),
        " ".join((ended if run.status == DONE else without).split()),
    ]


def _values(run: StoredRun, keys: Sequence[str]) -> str:
    found: Mapping[str, Any] = {
        key: value_at(run.config, key) if run.config else run.values.get(key) for key in keys
    }
    told = [f"{key}={_text(value)}" for key, value in found.items() if value is not None]
    return " ".join([*told[:MOST], *(["..."] if len(told) > MOST else [])])


def _text(value: Any) -> str:
    if isinstance(value, dict):  # of many values, of which those that differ have a key themselves
        return f"{{{', '.join(value)}}}"
    text = value if isinstance(value, str) else json.dumps(value)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def _written(log: Path) -> str:
    try:
        return f"{datetime.fromtimestamp(os.stat(log).st_mtime):%Y-%m-%d %H:%M}"
    except OSError:
        return ""
