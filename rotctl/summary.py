"""A run's summary row: what it was, whether it succeeded, and its measures."""

import math
from collections.abc import Mapping
from typing import Any

from rotctl.log import TrajectoryBuffer
from rotctl.metrics.columns import Arrays
from rotctl.metrics.judge import judge
from rotctl.scenario import Scenario

Summary = dict[str, Any]


def summarise(
    scenario: Scenario, run: TrajectoryBuffer | Arrays, ending: str, wall: float
) -> Summary:
    """The summary row of a simulated run.

    Args:
        run: the buffer, or schema path -> array.
        ending: what ended it early; empty if nothing did.
        wall: the time the loop took [s].
    """
    config = scenario.config
    period = 1.0 / config.controller.rate
    log = run.arrays() if isinstance(run, TrajectoryBuffer) else run
    judgement = judge(
        log,
        config.criteria,
        config.behaviour.commanded,
        period,
        config.duration,
        scenario.model.mj,
    )
    columns = judgement.columns
    reason = ending or judgement.reason
    row = {
        "run_id": scenario.run_id,
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


def broke_down(summary: Mapping[str, Any]) -> bool:
    """Whether a run itself failed, as opposed to the roll."""
    physics = str(summary["failure_reason"]).startswith("physics")
    return bool(summary["solver_failures"]) or physics
