"""A run's summary row: what it was, whether it succeeded, and its measures."""

import math
from collections.abc import Mapping
from typing import Any

from rotctl.behaviours.chain.settings import ChainSettings
from rotctl.config.fit import require_fit
from rotctl.config.schema import Config
from rotctl.log import RunLog, TrajectoryBuffer
from rotctl.mechanics.changes import Load
from rotctl.mechanics.disturbance import Calm
from rotctl.mechanics.model import Model
from rotctl.metrics import disturbed
from rotctl.metrics.columns import Arrays
from rotctl.metrics.criteria.chain import Link
from rotctl.metrics.criteria.judge import judge
from rotctl.metrics.halts import COLUMNS as OF_HALTS
from rotctl.runs.scenario import Scenario, model_of, simulated_model_of

Summary = dict[str, Any]
BROKE_DOWN, LEFT = "physics", "left the ground"  # how reasons begin that no criteria give


def summarise(
    scenario: Scenario, run: TrajectoryBuffer | Arrays, ending: str, wall: float
) -> Summary:
    """The summary row of a simulated run.

    Args:
        run: the buffer, or schema path -> array.
        ending: what ended it early; empty if nothing did.
        wall: the time the loop took [s].
    """
    log = run.arrays() if isinstance(run, TrajectoryBuffer) else run
    config, model = scenario.config, scenario.model
    if isinstance(config.disturbance, Load):  # it is no part of the body whose weights are told
        model = simulated_model_of(config)
    return _judged(config, scenario.run_id, model, log, ending, wall)


def judged_again(log: RunLog, config: Config) -> Summary:
    """The summary row of a logged run by the criteria of a config that is its own otherwise.

    Raises:
        LogError: the log is damaged.
        InputError: such criteria do not judge such a run.
    """
    require_fit(config, model_of(config))
    reason = str(log.outcome["failure_reason"])
    ending = reason if reason.startswith((BROKE_DOWN, LEFT)) else ""
    wall = float(log.attributes["wall_time"])
    arrays, model = log.arrays(), simulated_model_of(config)  # of whom body weights are told
    return _judged(config, str(log.attributes["run_id"]), model, arrays, ending, wall)


def numbers(config: Config) -> frozenset[str]:
    """Columns of the summary row of which such a run may have a number, whatever comes of it.

    What is measured is what a log without rows is judged by; what is commanded is known.
    """
    behaviour, period = config.behaviour, 1.0 / config.controller.rate
    no_rows = TrajectoryBuffer.allocate(
        steps=0, nq=7, nv=6, nu=1, capacity=1, tasks=1, bodies=1
    ).arrays()
    judgement = judge(
        no_rows,
        config.criteria,
        behaviour.commanded,
        period,
        config.duration,
        links=links_of(config),
    )
    found = {name for name, value in judgement.columns.items() if not isinstance(value, str)}
    found -= {name for name, value in behaviour.commanded.items() if math.isnan(value)}
    found |= {column.name for column in OF_HALTS if behaviour.halts}
    outside = config.disturbance
    if isinstance(outside, Calm) or outside.changes_model:
        found -= {"recovery", "recovered"}
    else:
        found |= {column.name for column in disturbed.COLUMNS}
    return frozenset(found | {"real_time_factor"})


def _judged(
    config: Config, run_id: str, model: Model, log: Arrays, ending: str, wall: float
) -> Summary:
    period = 1.0 / config.controller.rate
    commanded, wanted = config.behaviour.commanded, config.duration
    halts, links = config.behaviour.halts, links_of(config)
    judgement = judge(log, config.criteria, commanded, period, wanted, model.mj, halts, links)
    columns = judgement.columns
    if not isinstance(config.disturbance, Calm) and not config.disturbance.changes_model:
        columns = columns | disturbed.measure(log, period)
    reason = ending or judgement.reason
    row = {
        "run_id": run_id,
        "behaviour": config.behaviour.name,
        "criteria": config.criteria.kind,
        "seed": config.seed,
        "success": not reason,
        "failure_reason": reason,
        **columns,
        "real_time_factor": columns["duration"] / wall,
    }
    # JSON has no NaN: a number that a broken-down run does not have is null.
    return {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in row.items()}


def links_of(config: Config) -> tuple[Link, ...]:
    """What is asked of the parts of a chain; nothing of what is none."""
    if not isinstance(config.behaviour, ChainSettings):
        return ()
    return tuple(
        Link(one.behaviour.name, one.stages, one.behaviour.commanded, one.behaviour.halts)
        for one in config.behaviour.parts
    )


def broke_down(summary: Mapping[str, Any]) -> bool:
    """Whether a run itself failed, as opposed to the roll."""
    physics = str(summary["failure_reason"]).startswith(BROKE_DOWN)
    return bool(summary["solver_failures"]) or physics
