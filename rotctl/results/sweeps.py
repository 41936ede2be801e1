"""The sweeps below a folder, each with its table and the experiments that it was made for."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from rotctl.errors import InputError
from rotctl.log import LOG_NAME
from rotctl.results.experiments import Experiment, copies, read
from rotctl.results.manifest import MANIFEST_NAME
from rotctl.results.stored_runs import StoredRun, stored_runs
from rotctl.results.table import Table, tabulated


@dataclass(frozen=True)
class Sweep:
    """One sweep, read back.

    Attributes:
        name: its folder, relative to the one that was asked for.
        runs: run id -> run.
        experiments: name -> experiment.
        notes: what a reader should know, one line each.
    """

    name: str
    folder: Path
    runs: Mapping[str, StoredRun]
    table: Table
    experiments: Mapping[str, Experiment]
    notes: list[str]


def sweeps(folder: Path) -> tuple[list[Sweep], list[str]]:
    """The sweeps below a folder, itself included, by name; and what was left out, one line each.

    A sweep is a folder with a `sweep.jsonl`. Where there is none at all, all runs below count as
    one.

    Raises:
        InputError: there is no such folder, or no run in it that can be read.
    """
    places, loose = _places(folder)
    notes = [f"{path.relative_to(folder)}: is part of no sweep, left out" for path in loose]
    read_back = []
    for place in places or [folder]:
        try:
            read_back.append(_sweep(place, folder))
        except InputError as error:
            if not places:
                raise
            notes.append(f"left out: {error}")
    if not read_back:
        raise InputError(notes[-1].removeprefix("left out: "))
    return read_back, notes


def _places(folder: Path) -> tuple[list[Path], list[Path]]:
    """Folders of sweeps, the outermost ones, and logs outside of them."""
    places: list[Path] = []
    loose = []
    for at, inside, names in os.walk(folder):
        inside.sort()
        if MANIFEST_NAME in names:
            places.append(Path(at))
            inside.clear()
        elif LOG_NAME in names:
            loose.append(Path(at, LOG_NAME))
    return places, loose if places else []


def _sweep(place: Path, folder: Path) -> Sweep:
    runs, copied = stored_runs(place)
    table = tabulated(runs, copied)
    experiments, wrong = {}, []
    for name, path in copies(place).items():
        try:
            experiments[name] = read(path)
        except InputError as error:
            wrong.append(f"its claims are not judged: {error}")
    name = str(place.relative_to(folder)) if place != folder else folder.resolve().name
    by_id = {run.run_id: run for run in runs}
    return Sweep(name, place, by_id, table, experiments, [*table.notes, *wrong])
