"""`sweep.jsonl`: which runs a folder is meant to have, with what values, and which failed to run.

The logs say what is done. This file says what should be there, so that a run that failed, or
never started, is a row in a summary and not a gap.
"""

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from rotctl import files
from rotctl.errors import InputError

MANIFEST_NAME = "sweep.jsonl"


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
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except FileNotFoundError:
        return {}
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"cannot read {path}: {error}") from None
    found = [_entry(path, number, line) for number, line in enumerate(lines, 1)]
    return {entry.run_id: entry for entry in found}


def write(folder: Path, entries: Iterable[Entry]) -> None:
    """Replace the file, at once or not at all.

    Raises:
        InputError: it cannot be written.
    """
    lines = "".join(json.dumps(asdict(entry)) + "\n" for entry in entries)
    files.replace(folder / MANIFEST_NAME, lines.encode(), durable=True)


def _entry(path: Path, number: int, line: str) -> Entry:
    try:
        entry = Entry(**json.loads(line))
        sound = isinstance(entry.values, dict) and isinstance(entry.run_id, str)
    except (ValueError, TypeError, RecursionError):
        sound = False
    if not sound:
        raise InputError(f"{path}: line {number} is not a row of a sweep")
    return entry
