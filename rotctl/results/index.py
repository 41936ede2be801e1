"""`runs.jsonl`: a line for each finished run of a sweep: all of it but its trajectory.

So what is done is known without a look into any log, and logs need not be kept. Lines are only
ever added, each with a checksum: a line that a kill cut off, or a disk spoiled, is none. What many
rows have in common - the parts of their configs, the columns, the code and the machine - is said
once, in a line before them, by a name that is its hash; so two such files may be joined into one.
"""

import os
import re
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from rotctl import files
from rotctl.amounts import count
from rotctl.choices.contents import MOST_VALUES
from rotctl.errors import InputError, LogError
from rotctl.log import LOG_NAME
from rotctl.log.outcome import plain_outcome, require_verdict
from rotctl.settings.documents import DEEPEST
from rotctl.settings.json_documents import from_json_line

INDEX_NAME = "runs.jsonl"
LARGEST = 300_000_000  # bytes of an index: a row takes 800, and 1,000 more with gains of its own
LONGEST = 4_000_000  # bytes of a line
REFERENCE = "="  # the only key of what stands for something that has a name
ORIGIN = {"machine": str, "versions": str, "git_commit": str, "git_dirty": bool}
BEFORE = b'{"crc": "'
_ID, _DIGEST = re.compile(r"[0-9a-f]{12}"), re.compile(r"[0-9a-f]{64}")


class Stamp(NamedTuple):
    """By which a file is known again that nobody has touched: its size and when it was written."""

    size: int
    time: int  # [ns]


class Row(NamedTuple):
    """A finished run.

    Attributes:
        config: as plain data.
        outcome: the summary row.
        origin: code, versions and machine, as a log's attributes have them.
        wall_time: of the simulation [s].
        trajectory: SHA-256 of what was simulated, to be compared if it is simulated again.
        log: of the `run.h5` in its folder; None if it was not kept.
    """

    run_id: str
    config: Mapping[str, Any]
    outcome: Mapping[str, Any]
    origin: Mapping[str, Any]
    wall_time: float
    trajectory: str
    log: Stamp | None


@dataclass(frozen=True)
class Index:
    """What a file says.

    Attributes:
        rows: by run id; of two lines the later one counts.
        named: what rows have in common.
        damaged: how many lines could not be used.
    """

    rows: dict[str, Row] = field(default_factory=dict)
    named: dict[str, Any] = field(default_factory=dict)
    damaged: int = 0

    @property
    def complaint(self) -> str:
        """That lines could not be used; empty if all could."""
        return f"{count(self.damaged, 'line')} damaged, left out" if self.damaged else ""


def stamp(path: str | Path) -> Stamp | None:
    """Of a file as it lies there now; None if there is none, or its folder is a link."""
    try:
        if os.path.islink(os.path.dirname(path)):
            return None
        found = os.stat(path, follow_symlinks=False)
    except (OSError, ValueError):
        return None
    return Stamp(found.st_size, found.st_mtime_ns)


def fits(row: Row) -> bool:
    """Whether it can be written, and would be read again: a stranger's log may be odd."""
    return type(row.config.get("seed")) is int and row.outcome.get("run_id") == row.run_id


def read(folder: Path) -> Index:
    """What the index of a folder says, which may be a stranger's; empty if there is none.

    Raises:
        InputError: there is something else in its place, or it is too large.
    """
    path = folder / INDEX_NAME
    if not os.path.lexists(path):
        return Index()
    rows: dict[str, Row] = {}
    named: dict[str, Any] = {}
    damaged = 0
    try:
        with files.opened(path, linked=False) as file:
            if os.fstat(file.fileno()).st_size > LARGEST:
                raise InputError(f"{path}: larger than {LARGEST / 1e6:g} MB")
            while line := file.readline(LONGEST):
                try:
                    _take(line, rows, named)
                except (ValueError, LogError, LookupError, TypeError, AttributeError):
                    damaged += 1
    except OSError as error:
        raise InputError(f"{path}: {error.strerror or error}") from None
    return Index(rows, named, damaged)


def row_at(path: Path) -> Row | None:
    """The row of a run whose log is not kept, by where it would lie: its folder, or the log in it.

    None where a log lies, or no index knows of one.

    Raises:
        InputError: see `read`.
    """
    place = path.parent if path.name == LOG_NAME else path
    if os.path.lexists(place / LOG_NAME):
        return None
    return read(place.parent).rows.get(place.name)


def _take(line: bytes, rows: dict[str, Row], named: dict[str, Any]) -> None:
    """Read one line; what it raises says that rotctl has not written it."""
    body = line[len(BEFORE) + 8 : -1]
    sound = line.startswith(BEFORE) and line.endswith(b"\n")
    if not sound or line[len(BEFORE) :][:8] != b"%08x" % zlib.crc32(body):
        raise ValueError("cut off or damaged")
    data = from_json_line(line.decode("ascii"))
    if "is" in data:
        named[_text(data["name"])] = _value(data["is"], named)
        return
    log = data.get("log")
    outcome = dict(zip(named[data["columns"]], data["outcome"], strict=True))
    plain_outcome(outcome)
    require_verdict(outcome)
    row = Row(
        _matching(_ID, data.get("run_id")),
        {**named[data["config"]], "seed": data["seed"]},
        outcome,
        _origin(named, data["origin"]),
        _number(data["wall_time"]),
        _matching(_DIGEST, data.get("trajectory")),
        None if log is None else Stamp(*map(_number, log)),
    )
    if not fits(row):
        raise ValueError("no seed, or the summary of another run")
    rows[row.run_id] = row


def _value(data: Any, named: Mapping[str, Any]) -> Any:
    """What is named: the columns, whose names all rows share, or keys with values."""
    if isinstance(data, list):
        return tuple(map(_text, data))
    if not isinstance(data, dict):
        raise ValueError("neither columns nor keys with values")
    whole = {
        key: named[value[REFERENCE]] if isinstance(value, dict) and REFERENCE in value else value
        for key, value in data.items()
    }
    require_size(whole)  # of parts that name parts, which a stranger may have written
    return whole


def require_size(data: Any) -> None:
    """See that plain data is no deeper and no larger than a config may be.

    Raises:
        ValueError: it is.
    """
    waiting, values = [(data, 0)], 0
    while waiting:
        value, depth = waiting.pop()
        values += 1
        if values > MOST_VALUES or depth > DEEPEST:
            raise ValueError("parts that name parts without end")
        if isinstance(value, Mapping):
            waiting += [(inner, depth + 1) for inner in value.values()]
        elif isinstance(value, list | tuple):
            waiting += [(inner, depth + 1) for inner in value]


def _origin(named: dict[str, Any], name: Any) -> Mapping[str, Any]:
    found: Mapping[str, Any] = named[_text(name)]
    if any(type(found[key]) is not kind for key, kind in ORIGIN.items()):
        raise ValueError("an origin that is none")
    return found


def _matching(pattern: re.Pattern[str], value: Any) -> str:
    if not isinstance(value, str) or not pattern.fullmatch(value):
        raise ValueError("no name that rotctl gives")
    return value


def _number(value: Any) -> Any:
    if type(value) not in (int, float):
        raise ValueError("no number")
    return value


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise ValueError("no text")
    return value
