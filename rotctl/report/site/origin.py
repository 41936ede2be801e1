"""Where results come from: machines, versions, code, configs, seeds, and what they cost."""

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from rotctl.amounts import count
from rotctl.report.site.words import NOTHING, number, ranges
from rotctl.report.title import plain
from rotctl.results.configs import config_hash
from rotctl.results.stored_runs import DONE
from rotctl.results.sweeps import Sweep
from rotctl.settings.json_documents import from_json

LONGEST = 1000  # characters: the end of a machine, its libm and BLAS, is what bits may hang on
MOST = 8  # different values of a thing that are listed


def origin(sweep: Sweep) -> list[tuple[str, list[str]]]:
    """What -> its values with how many runs each, of the runs that have a result."""
    done = [run for run in sweep.runs.values() if run.status == DONE]
    configs = (config_hash(run.config) for run in done)
    outcomes = [run.outcome for run in done]
    simulated = _sum(outcome.get("duration") for outcome in outcomes)
    took = _sum(run.origin.get("wall_time") for run in done)
    factors = _numbers(outcome.get("real_time_factor") for outcome in outcomes)
    failures = _numbers(outcome.get("solver_failures") for outcome in outcomes)
    seeds = [seed for seed in (o.get("seed") for o in outcomes) if isinstance(seed, int)]
    return [
        ("Runs", [f"{len(done)} with a result, {len(sweep.runs) - len(done)} without"]),
        ("Seeds", [ranges(seeds) or NOTHING]),
        ("Code", _counted(run.code for run in done)),
        ("Versions", _counted(_pairs(run.origin.get("versions")) for run in done)),
        ("Machine", _counted(_pairs(run.origin.get("machine")) for run in done)),
        (
            "Configs without their seeds, by SHA-256",
            _counted(configs),
        ),
        ("Simulated time", [f"{simulated / 60:.1f} min"]),
        ("Time in simulation, all processes together", [f"{took / 60:.1f} min"]),
        ("Real-time factor of a run", [_quartiles(factors)]),
        ("Control steps on which every solver failed", [_failed(failures)]),
    ]


def _failed(steps: Sequence[float]) -> str:
    if not any(steps):
        return "none"
    return f"{sum(steps):.0f}, in {count(sum(n > 0 for n in steps), 'run')}"


def _quartiles(found: Sequence[float]) -> str:
    if not found:
        return NOTHING
    low, middle, high = (number(float(q)) for q in np.quantile(found, [0.25, 0.5, 0.75]))
    return f"median {middle}, quartiles {low} and {high}"


def _counted(found: Iterable[str]) -> list[str]:
    ordered = sorted(Counter(found).items(), key=lambda item: (-item[1], item[0]))
    lines = [f"{plain(text, LONGEST)} ({count(n, 'run')})" for text, n in ordered[:MOST]]
    return lines + ([f"and {len(ordered) - MOST} more"] if len(ordered) > MOST else [])


def _pairs(text: Any) -> str:
    """JSON of a log in words."""
    try:
        data = from_json(str(text))
    except ValueError:
        data = None
    if not isinstance(data, Mapping):
        return "unknown"
    return ", ".join(f"{key} {value}" for key, value in data.items())


def _numbers(found: Iterable[Any]) -> list[float]:
    return [float(v) for v in found if isinstance(v, int | float) and math.isfinite(v)]


def _sum(found: Iterable[Any]) -> float:
    return sum(_numbers(found))
