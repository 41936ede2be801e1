"""What a sweep has to do: its runs by id, less those whose logs are there and whole."""

import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rotctl.config import Config
from rotctl.errors import InputError, LogError
from rotctl.log import LOG_NAME, collect
from rotctl.results.code import code_version
from rotctl.run_folder import open_published
from rotctl.scenario import model_of, run_id
from rotctl.summary import Summary
from rotctl.sweep.points import Point


@dataclass(frozen=True)
class Planned:
    """A run of the sweep.

    Attributes:
        values: `behaviour`, `seed` and every overridden config key -> value.
    """

    run_id: str
    config: Config
    values: dict[str, Any]


@dataclass(frozen=True)
class Plan:
    """What is there and what is left.

    Attributes:
        done: run id -> summary of the runs that are there.
        left: the runs to do.
        replaced: why a log that was there has to be made again, one line each.
        other_code: code version -> how many runs of `done` it made, if it is not this code.
    """

    done: dict[str, Summary] = field(default_factory=dict)
    left: list[Planned] = field(default_factory=list)
    replaced: list[str] = field(default_factory=list)
    other_code: dict[str, int] = field(default_factory=dict)


def planned(points: Iterable[Point]) -> list[Planned]:
    """The runs of the points; points with the same config are one run.

    Raises:
        InputError: a point makes no model.
    """
    runs: dict[str, Planned] = {}
    for point in points:
        config = point.config
        name = run_id(config, model_of(config))
        always = {"behaviour": config.behaviour.name, "seed": config.seed}
        runs.setdefault(name, Planned(name, config, always | point.values))
    return list(runs.values())


def plan(
    runs: Iterable[Planned],
    folder: Path,
    strict: bool = False,
    progress: Callable[[], object] = lambda: None,
) -> Plan:
    """Compare the runs with the logs in `folder`; a damaged log is set aside as `.corrupt`.

    Args:
        strict: do again what other code has made.
        progress: called after every run.

    Raises:
        InputError: a damaged log cannot be set aside.
    """
    sorted_out, this_code = Plan(), code_version(collect())
    for run in runs:
        path = folder / run.run_id / LOG_NAME
        if not os.path.lexists(path):
            sorted_out.left.append(run)
            progress()
            continue
        try:
            log = open_published(path.parent, run.run_id)
            code, outcome = code_version(log.attributes), log.outcome
        except LogError as error:
            _set_aside(path)
            sorted_out.replaced.append(f"{error}; kept as {path.name}.corrupt")
            sorted_out.left.append(run)
        else:
            if code != this_code and strict:
                sorted_out.replaced.append(f"{path}: made by {code}")
                sorted_out.left.append(run)
            else:
                sorted_out.done[run.run_id] = outcome
                if code != this_code:
                    sorted_out.other_code[code] = sorted_out.other_code.get(code, 0) + 1
        progress()
    return sorted_out


def _set_aside(path: Path) -> None:
    try:
        os.replace(path, f"{path}.corrupt")
    except OSError as error:
        raise InputError(f"cannot set {path} aside: {error.strerror}") from None
