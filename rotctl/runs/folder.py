"""A run's folder: its log, and beside it what people read without HDF5."""

import json
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rotctl import files
from rotctl.errors import LogError
from rotctl.log import LOG_NAME, RunLog, write_log
from rotctl.log.outcome import require_verdict
from rotctl.runs.summary import Summary

SUMMARY_NAME, CONFIG_NAME = "summary.json", "config.yaml"
INTERRUPTED_NAME = "interrupted.h5"  # the beginning of a run that is not over


@dataclass(frozen=True)
class EncodedRun:
    """A simulated run that is on no disk yet.

    Attributes:
        summary: the summary row.
        log: the bytes of its `run.h5`; empty if nobody wants to keep it.
        config: as YAML; empty without a log.
        origin: code, versions and machine.
        wall_time: of the simulation [s].
        trajectory: SHA-256 of what was simulated.
    """

    summary: Summary
    log: bytes
    config: str
    origin: Mapping[str, Any]
    wall_time: float
    trajectory: str


def publish(run: EncodedRun, folder: Path) -> None:
    """Put a run into its folder: first the log, which alone says that the run is there.

    Raises:
        InputError: it cannot be written.
    """
    with files.folder(folder, linked=False):
        write_log(folder / LOG_NAME, run.log)
        _write_beside(folder, run.summary, run.config)
        with suppress(OSError):
            (folder / INTERRUPTED_NAME).unlink(missing_ok=True)


def open_published(folder: Path, run_id: str) -> tuple[RunLog, str]:
    """The log of the run in `folder`, all of it checked; puts back what is missing beside it.

    Returns:
        It, and the SHA-256 of what was simulated.

    Raises:
        LogError: the log there is not whole, or of another run.
    """
    log = RunLog.open(folder / LOG_NAME, linked=False)
    trajectory = log.verify()
    if log.attributes["run_id"] != run_id:
        raise LogError(f"{log.path}: is run {log.attributes['run_id']}, expected {run_id}")
    outcome = log.outcome
    try:
        require_verdict(outcome)
    except LogError as error:
        raise LogError(f"{log.path}: {error}") from None
    if not has_all_beside(folder):  # after a kill
        _write_beside(folder, outcome, str(log.attributes["config"]))
    return log, trajectory


def has_all_beside(folder: Path) -> bool:
    """Whether what people read lies beside the log."""
    return all((folder / name).exists() for name in (SUMMARY_NAME, CONFIG_NAME))


def _write_beside(folder: Path, summary: Summary, config: str) -> None:
    files.replace(folder / SUMMARY_NAME, f"{json.dumps(summary, indent=2)}\n".encode())
    files.replace(folder / CONFIG_NAME, config.encode())
