"""`sweep.jsonl`: which runs a folder is meant to have, with what values, and which failed to run.

The logs say what is done. This file says what should be there, so that a run that failed, or
never started, is a row in a summary and not a gap.
"""

import json
import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rotctl import files
from rotctl.errors import InputError
from rotctl.settings.json_documents import read_json_lines

MANIFEST_NAME = "sweep.jsonl"


_FIELDS = {"run_id", "values", "failure"}


@dataclass(frozen=True)
class Entry:
    """A run that a folder is meant to have.

    Attributes:
        values: `behaviour`, `seed` and every overridden config key -> value.
        failure: why it failed to run; empty if it did not, or was not tried.
    """

    run_id: str
    values: dict[str, Any]
    failure: str = ""


def read(folder: Path) -> dict[str, Entry]:
    """Run id -> entry, in the order of the file; empty if there is none.

    Raises:
        InputError: the file cannot be read, or is of somebody else.
    """
    path = folder / MANIFEST_NAME
    if not os.path.lexists(path):
        return {}
    entries = {}
    for number, data in read_json_lines(path, linked=False):
        if not _sound(data):
            raise InputError(f"{path}: line {number} is not a row of a sweep")
        entries[data["run_id"]] = Entry(**data)
    return entries


def write(folder: Path, entries: Iterable[Entry]) -> None:
    """Replace the file, at once or not at all.

    Raises:
        InputError: it cannot be written.
    """
    lines = "".join(json.dumps(vars(entry)) + "\n" for entry in entries)
    files.replace(folder / MANIFEST_NAME, lines.encode(), durable=True)


def _sound(data: Any) -> bool:
    """Whether the data of a line are those of an `Entry`."""
    if not isinstance(data, dict) or not {"run_id", "values"} <= set(data) <= _FIELDS:
        return False
    texts = (data["run_id"], data.get("failure", ""))
    return isinstance(data["values"], dict) and all(isinstance(text, str) for text in texts)
