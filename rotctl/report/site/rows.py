"""The rows of the reproduction page: the runs that claims are about, and how they did."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from rotctl.metrics import appearance
from rotctl.metrics.claims import Judged, judge, overall
from rotctl.metrics.measured import SUCCESS_RATE, Measured, in_which, measured, picked
from rotctl.report.site.grid import labels
from rotctl.report.site.words import kind, values
from rotctl.report.title import plain
from rotctl.results.experiments import Experiment
from rotctl.results.keys import value_at
from rotctl.results.stored_runs import StoredRun
from rotctl.results.sweeps import Sweep

SHOWN = (
    "angular_velocity_mean",
    "angular_velocity_commanded",
    "speed_mean",
    "speed_commanded",
    "longest_stall",
)
# What is better, more of it or less, the most telling first; a motion has some of them.
BETTER = {
    "revolutions": 1,
    "parts_succeeded": 1,
    "parts_begun": 1,
    "other_contact": -1,  # [s] on the ground: who fell first lies longest
    "up_from": -1,
    "held": 1,
    "entry_angle": -1,
    "error_end": -1,
    "stature_end": 1,
    "lowest_in_the_end": 1,
    "lean_end": -1,
    "speed_end": -1,
    "duration": 1,  # of a run that broke down
}
MOST_VALUES = 6  # of a key in which runs of a row differ
LOOKS = tuple(column.name for column in appearance.COLUMNS)


@dataclass(frozen=True)
class Row:
    """Runs that belong together.

    Attributes:
        name: what tells them from others.
        about: the behaviour's description.
        source: of the behaviour.
        verdict: of all its claims together; empty if it has none.
        metrics: `success_rate` and those of `SHOWN` -> what was measured.
        looks: those of `LOOKS` that were measured.
        worst: of the run with the longest stall [s].
        seeds: how many different ones its runs with a result have.
        missing: runs without a result.
        failures: kind of failure -> how many, most first.
        median: the run in the middle from worst to best, see `BETTER`; None without results.
        poorest: the first in that order, if it is another one.
        pooled: in which keys its runs differ, and their values; empty if they are alike.
        which: run id of the median and the poorest -> their values of these keys.
        deviations: from what is reproduced.
    """

    name: str
    about: str
    source: str
    claims: tuple[Judged, ...]
    verdict: str
    metrics: Mapping[str, Measured]
    looks: Mapping[str, Measured]
    worst: float | None
    seeds: int
    missing: int
    failures: tuple[tuple[str, int], ...]
    median: StoredRun | None
    poorest: StoredRun | None
    pooled: str
    which: Mapping[str, str]
    deviations: tuple[str, ...]


def rows(sweep: Sweep, experiment: Experiment | None) -> list[Row]:
    """One row for each set of runs that claims are about; without claims, one a behaviour."""
    table = sweep.table
    if experiment is None or not experiment.claims:
        names = table.rows["behaviour"].dropna().unique().tolist()
        return [_row(sweep, {"behaviour": name}, [], experiment) for name in names]
    groups: dict[tuple[Any, ...], list[Judged]] = {}
    for claim in experiment.claims:
        judged = judge(claim, table.rows, table.keys)
        groups.setdefault(tuple(claim.where.items()), []).append(judged)
    return [_row(sweep, dict(where), claims, experiment) for where, claims in groups.items()]


def _row(
    sweep: Sweep,
    where: Mapping[str, Any],
    claims: Sequence[Judged],
    experiment: Experiment | None,
) -> Row:
    about = picked(sweep.table.rows, where)
    done = about[about["success"].notna()]
    failed = done[~done["success"].astype(bool)]
    reasons = Counter(kind(str(reason)) for reason in failed["failure_reason"])
    reasons.update(about[about["success"].isna()]["status"].tolist())
    order = from_worst(done)
    median = sweep.runs[order[(len(order) - 1) // 2]] if order else None
    poorest = sweep.runs[order[0]] if order else None
    stalls = [v for v in done.get("longest_stall", []) if isinstance(v, float) and math.isfinite(v)]
    config = median.config if median else {}
    looks = {name: measured(done, name) for name in LOOKS}
    keys = in_which(done, sweep.table.keys, where)
    drawn = done[done["run_id"].isin([run.run_id for run in (median, poorest) if run])]
    return Row(
        name=values(where),
        about=_text(config, "behaviour.description"),
        source=_text(config, "behaviour.source"),
        claims=tuple(claims),
        verdict=overall([claim.verdict for claim in claims]) if claims else "",
        metrics={name: measured(done, name) for name in (SUCCESS_RATE, *SHOWN)},
        looks={name: found for name, found in looks.items() if found.runs},
        worst=max(stalls, default=None),
        seeds=done["seed"].nunique(),
        missing=len(about) - len(done),
        failures=tuple(sorted(reasons.items(), key=lambda item: (-item[1], item[0]))),
        median=median,
        poorest=poorest if poorest is not median else None,
        pooled="; ".join(f"{plain(key)} {_each(done[key])}" for key in keys),
        which=dict(zip(drawn["run_id"], labels(drawn, keys), strict=True)) if keys else {},
        deviations=_deviations(where, experiment),
    )


def from_worst(done: pd.DataFrame) -> list[str]:
    """Run ids: those that failed before those that succeeded, then by `BETTER`."""
    columns = {"success": done["success"].astype(bool)}
    for name, better in BETTER.items():
        if name in done:
            columns[name] = better * pd.to_numeric(done[name], errors="coerce")
    order = pd.DataFrame(columns)
    index = order.sort_values([*columns], na_position="first", kind="stable").index
    return [str(name) for name in done.loc[index, "run_id"]]


def _each(column: pd.Series) -> str:
    """The different values of a column, the first of them."""
    every = list(dict.fromkeys(column.tolist()))
    more = [] if len(every) <= MOST_VALUES else ["\u2026"]
    return ", ".join([*(plain(f"{value}") for value in every[:MOST_VALUES]), *more])


def _deviations(where: Mapping[str, Any], experiment: Experiment | None) -> tuple[str, ...]:
    found = experiment.deviations if experiment else []
    return tuple(d.text for d in found if d.where and d.where.items() <= where.items())


def _text(config: Mapping[str, Any], key: str) -> str:
    value = value_at(config, key)
    return plain(value) if isinstance(value, str) else ""
