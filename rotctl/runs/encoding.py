"""What was simulated, as the bytes of a log and a summary row."""

from collections.abc import Callable
from typing import Any

from rotctl.log import TrajectoryBuffer, collect, encode_run
from rotctl.log.digest import simulated
from rotctl.log.writer import whole
from rotctl.runs.folder import EncodedRun
from rotctl.runs.scenario import Scenario
from rotctl.runs.summary import Summary, summarise
from rotctl.settings.writing import to_yaml


def encoded(
    scenario: Scenario,
    buffer: TrajectoryBuffer,
    ending: str,
    wall: float,
    keeps: Callable[[Summary], bool] = lambda summary: True,
) -> EncodedRun:
    """A run that is over, or its beginning.

    Args:
        ending: what ended it early; empty if nothing did.
        wall: the time the loop took [s].
        keeps: whether the log of a run with that summary row is wanted.
    """
    arrays, source = whole(buffer, scenario.model.mjcf), origin(scenario)
    summary = summarise(scenario, arrays, ending, wall)
    digest, log, text = simulated(arrays), b"", ""
    if keeps(summary):
        text = to_yaml(scenario.config)
        log = encode_run(
            buffer,
            model_xml=scenario.model.mjcf,
            attributes={
                **source,
                "config": text,
                "run_id": scenario.run_id,
                "seed": scenario.config.seed,
                "wall_time": wall,
                "outcome": summary,
            },
            digest=digest,
        )
    return EncodedRun(summary, log, text, source, wall, digest.hexdigest())


def origin(scenario: Scenario) -> dict[str, Any]:
    """Code, versions and machine of a run, as they are in its log."""
    here = collect()
    steps = {
        "control_step": scenario.controller.backend,
        "physics_step": scenario.stepper.backend,
    }
    return {**here, "versions": {**here["versions"], **steps}}
