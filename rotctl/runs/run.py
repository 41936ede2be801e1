"""One config to one log to one summary row."""

import json
import os
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rotctl import files
from rotctl.config.identity import acting
from rotctl.config.schema import Config
from rotctl.engine import quiet
from rotctl.errors import LogError
from rotctl.log import LOG_NAME, SCHEMA, RunLog, TrajectoryBuffer, encode_run
from rotctl.log.schema import MODEL_PATH
from rotctl.runs.checkpoint import Checkpoints
from rotctl.runs.encoding import encoded
from rotctl.runs.folder import EncodedRun, open_published, publish
from rotctl.runs.scenario import ANEW, Making, Scenario, build
from rotctl.runs.summary import Summary, broke_down, judged_again
from rotctl.settings.documents import from_yaml
from rotctl.settings.writing import to_dict, to_yaml
from rotctl.simulation.loop import Look, nobody, simulate


@dataclass(frozen=True)
class Result:
    """A run on disk.

    Attributes:
        folder: holds `run.h5`, `summary.json` and `config.yaml`.
        summary: the summary row.
        already_there: True if nothing was simulated because the run was there.
        trajectory: SHA-256 of what was simulated.
        replaced: why the log that was there was not used; empty if it was, or there was none.
        notice: what the user should know of how it was simulated; mostly empty.
    """

    folder: Path
    summary: Summary
    already_there: bool
    trajectory: str
    replaced: str = ""
    notice: str = ""

    @property
    def broke_down(self) -> bool:
        """Whether the run itself failed, as opposed to the roll."""
        return broke_down(self.summary)


def run(
    config: Config,
    out: Path,
    force: bool = False,
    progress: Callable[[], object] = lambda: None,
    *,
    again: bool = False,
) -> Result:
    """Simulate a config into `out/<run id>/`, unless that run is there already.

    Args:
        force: simulate again even so.
        progress: called after every control step.
        again: whether the config is one of a run that was made before.

    Raises:
        InputError: the config does not make a run, or the folder cannot be written.
    """
    scenario = built(config, again=again)
    folder = out / scenario.run_id
    replaced = ""
    if not force and os.path.lexists(folder / LOG_NAME):
        try:
            log, trajectory = open_published(folder, scenario.run_id)
            if not same_criteria(from_yaml("config", log.config_yaml), config):
                publish(by_other_criteria(log, config, trajectory), folder)
                log = RunLog.open(folder / LOG_NAME)
            return Result(folder, log.outcome, True, trajectory)
        except LogError as error:
            replaced = str(error)
    with files.folder(folder, linked=False):
        checkpoints = Checkpoints(scenario, folder)
        try:
            made = _simulated(scenario, progress, look=checkpoints)
        except KeyboardInterrupt:
            checkpoints.write()
            raise
        publish(made, folder)
    notices = (scenario.controller.notice, scenario.stepper.notice)
    notice = "; ".join(filter(None, notices))
    return Result(folder, made.summary, False, made.trajectory, replaced, notice)


def same_criteria(data: Mapping[str, Any], config: Config) -> bool:
    """Whether the plain data of a config have the criteria of another one."""
    there, here = acting(data.get("criteria")), acting(to_dict(config)["criteria"])
    return json.dumps(there) == json.dumps(here)


def by_other_criteria(log: RunLog, config: Config, trajectory: str) -> EncodedRun:
    """A logged run with another verdict: what was simulated stays as it is.

    Raises:
        LogError: the log is of another version.
        InputError: such criteria do not judge such a run.
    """
    if log.names != tuple(SCHEMA):
        raise LogError(f"{log.path}: is of an older schema, and has another verdict there")
    summary, text = judged_again(log, config), to_yaml(config)
    kept = {name: log.attributes[name] for name in ("versions", "machine", "git_commit")}
    source = {**kept, "git_dirty": log.attributes["git_dirty"]}
    rest = {name: log.attributes[name] for name in ("run_id", "seed", "wall_time")}
    arrays = log.arrays()
    del arrays[MODEL_PATH]
    content = encode_run(
        arrays,
        model_xml=log.model_xml,
        attributes={**source, **rest, "config": text, "outcome": summary},
    )
    return EncodedRun(summary, content, text, source, float(rest["wall_time"]), trajectory)


def make(config: Config) -> EncodedRun:
    """Simulate a config and write nothing.

    Raises:
        InputError: the config does not make a run.
    """
    return _simulated(built(config))


def built(config: Config, making: Making = ANEW, *, again: bool = False) -> Scenario:
    """The parts of a run, without a word from MuJoCo; see `rotctl.runs.scenario.build`.

    Raises:
        InputError: the config does not make a run.
    """
    with quiet():
        return build(config, making, again=again)


def _simulated(
    scenario: Scenario, progress: Callable[[], object] = lambda: None, look: Look = nobody
) -> EncodedRun:
    begin = time.perf_counter()
    buffer, ending = in_memory(scenario, progress, look=look)
    return encoded(scenario, buffer, ending, time.perf_counter() - begin)


def in_memory(
    scenario: Scenario,
    progress: Callable[[], object] = lambda: None,
    look: Look = nobody,
) -> tuple[TrajectoryBuffer, str]:
    """Simulate, and write nothing; `progress` and `look` are those of `simulate`.

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
            look,
        )
    # MuJoCo counts most warnings, and the loop stops at those; not all are counted.
    heard = f"MuJoCo warns: {warnings[0]}" if warnings else ""
    broken = outcome.breakdown or heard
    if not broken:
        return outcome.buffer, outcome.left
    ended = outcome.buffer.steps / scenario.config.controller.rate
    return outcome.buffer, f"physics broke down at t = {ended:.2f} s: {broken}"
