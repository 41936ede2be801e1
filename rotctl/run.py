"""One config to one log to one summary row."""

import json
import math
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rotctl import files
from rotctl.config import Config, to_yaml
from rotctl.errors import LogError
from rotctl.log import LOG_NAME, RunLog, TrajectoryBuffer, collect, encode_run, write_log
from rotctl.log.outcome import require_verdict
from rotctl.metrics.judge import judge
from rotctl.quiet import quiet
from rotctl.scenario import Scenario, build
from rotctl.simulation.episode import Moment
from rotctl.simulation.loop import simulate

SUMMARY_NAME, CONFIG_NAME = "summary.json", "config.yaml"
Summary = dict[str, Any]


@dataclass(frozen=True)
class Result:
    """A run on disk.

    Attributes:
        folder: holds `run.h5`, `summary.json` and `config.yaml`.
        summary: the summary row.
        already_there: True if nothing was simulated because the run was there.
        replaced: why the log that was there was not used; empty if it was, or there was none.
        notice: what the user should know of how it was simulated; mostly empty.
    """

    folder: Path
    summary: Summary
    already_there: bool
    replaced: str = ""
    notice: str = ""

    @property
    def broke_down(self) -> bool:
        """Whether the run itself failed, as opposed to the roll."""
        return broke_down(self.summary)


def broke_down(summary: Summary) -> bool:
    """Whether a run itself failed, as opposed to the roll."""
    physics = str(summary["failure_reason"]).startswith("physics")
    return bool(summary["solver_failures"]) or physics


def run(
    config: Config,
    out: Path,
    force: bool = False,
    progress: Callable[[], object] = lambda: None,
) -> Result:
    """Simulate a config into `out/<run id>/`, unless that run is there already.

    Args:
        force: simulate again even so.
        progress: called after every control step.

    Raises:
        InputError: the config does not make a run, or the folder cannot be written.
    """
    scenario = built(config)
    folder = out / scenario.run_id
    replaced = ""
    if not force and os.path.lexists(folder / LOG_NAME):
        try:
            log = stored(folder, scenario.run_id)
            return Result(folder, log.outcome, already_there=True)
        except LogError as error:
            replaced = str(error)
    with files.folder(folder, linked=False):
        made = _simulated(scenario, progress)
        publish(made, folder)
    notices = (scenario.controller.notice, scenario.stepper.notice)
    notice = "; ".join(filter(None, notices))
    return Result(folder, made.summary, already_there=False, replaced=replaced, notice=notice)


@dataclass(frozen=True)
class Made:
    """A simulated run that is on no disk yet.

    Attributes:
        summary: the summary row.
        log: the bytes of its `run.h5`.
        config: as YAML.
    """

    summary: Summary
    log: bytes
    config: str


def make(config: Config) -> Made:
    """Simulate a config and write nothing: for workers that need not see the driver's disk.

    Raises:
        InputError: the config does not make a run.
    """
    return _simulated(built(config), lambda: None)


def publish(made: Made, folder: Path) -> None:
    """Put a run into its folder: first the log, which alone says that the run is there.

    Raises:
        InputError: it cannot be written.
    """
    with files.folder(folder, linked=False):
        write_log(folder / LOG_NAME, made.log)
        _write_beside(folder, made.summary, made.config)


def built(config: Config) -> Scenario:
    """The parts of a run, without a word from MuJoCo.

    Raises:
        InputError: the config does not make a run.
    """
    with quiet():
        return build(config)


def _simulated(scenario: Scenario, progress: Callable[[], object]) -> Made:
    config, text = scenario.config, to_yaml(scenario.config)
    begin = time.perf_counter()
    buffer, ending = in_memory(scenario, progress)
    wall = time.perf_counter() - begin
    summary = summarise(scenario, buffer, ending, wall)
    log = encode_run(
        buffer,
        model_xml=scenario.model.mjcf,
        attributes={
            **origin(scenario),
            "config": text,
            "run_id": scenario.run_id,
            "seed": config.seed,
            "wall_time": wall,
            "outcome": summary,
        },
    )
    return Made(summary, log, text)


def origin(scenario: Scenario) -> dict[str, Any]:
    """Code, versions and machine of a run, as they are in its log."""
    found = collect()
    steps = {
        "control_step": scenario.controller.backend,
        "physics_step": scenario.stepper.backend,
    }
    return {**found, "versions": {**found["versions"], **steps}}


def in_memory(
    scenario: Scenario,
    progress: Callable[[], object] = lambda: None,
    stop: Callable[[Moment], bool] = lambda moment: False,
) -> tuple[TrajectoryBuffer, str]:
    """Simulate, and write nothing; `progress` and `stop` are those of `simulate`.

    Returns:
        The rows, and what ended them early: a breakdown, or the end of the ground; else empty.
    """
    # What is not finite is found by the loop and told by the log, not by numpy on stderr.
    with np.errstate(all="ignore"), quiet() as warnings:
        outcome = simulate(
            scenario,
            scenario.config.duration,
            scenario.config.physics.contact_capacity,
            progress,
            stop,
        )
    # MuJoCo counts most warnings, and the loop stops at those; not all are counted.
    heard = f"MuJoCo warns: {warnings[0]}" if warnings else ""
    broken = outcome.breakdown or heard
    if not broken:
        return outcome.buffer, outcome.left
    ended = outcome.buffer.steps / scenario.config.controller.rate
    return outcome.buffer, f"physics broke down at t = {ended:.2f} s: {broken}"


def summarise(scenario: Scenario, buffer: TrajectoryBuffer, ending: str, wall: float) -> Summary:
    """The summary row of a simulated run.

    Args:
        ending: what ended it early; empty if nothing did.
        wall: the time the loop took [s].
    """
    config = scenario.config
    period = 1.0 / config.controller.rate
    judgement = judge(
        buffer.arrays(), config.criteria, config.behaviour.commanded, period, config.duration
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


def stored(folder: Path, run_id: str) -> RunLog:
    """The run in `folder`, all of it checked; puts back the files beside it after a kill.

    Raises:
        LogError: the log there is not whole, or of another run.
    """
    log = RunLog.open(folder / LOG_NAME, linked=False)
    log.verify()
    if log.attributes["run_id"] != run_id:
        raise LogError(f"{log.path}: is run {log.attributes['run_id']}, expected {run_id}")
    outcome = log.outcome
    try:
        require_verdict(outcome)
    except LogError as error:
        raise LogError(f"{log.path}: {error}") from None
    if not all((folder / name).exists() for name in (SUMMARY_NAME, CONFIG_NAME)):
        _write_beside(folder, outcome, str(log.attributes["config"]))
    return log


def _write_beside(folder: Path, summary: Summary, config: str) -> None:
    """What people and other programs read without HDF5; the log has all of it."""
    files.replace(folder / SUMMARY_NAME, f"{json.dumps(summary, indent=2)}\n".encode())
    files.replace(folder / CONFIG_NAME, config.encode())
