"""Lines of `runs.jsonl` as they are written: see `rotctl.results.index`."""

import json
import os
import time
import zlib
from collections.abc import Mapping
from contextlib import suppress
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from rotctl import files
from rotctl.caching import kept
from rotctl.errors import InputError
from rotctl.results.index import BEFORE, INDEX_NAME, LARGEST, REFERENCE, Index, Row

SYNC_EVERY = 1.0  # [s] a loss of power may cost that much; a kill costs nothing
SMALL = 200  # characters of what is not worth a name


class Writer:
    """Adds rows; the caller holds the folder's lock."""

    def __init__(self, folder: Path, index: Index) -> None:
        """Open the file, made if need be, behind its last whole line.

        Raises:
            InputError: it cannot be written.
        """
        self._path, self._named = folder / INDEX_NAME, set(index.named)
        flags = os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_NOFOLLOW | os.O_NONBLOCK
        new = not os.path.lexists(self._path)
        try:
            self._file = os.open(self._path, flags, 0o666)
            self._size = _cut(self._file)
            if new:
                files.sync(folder)
        except OSError as error:
            raise InputError(f"cannot write {self._path}: {error.strerror or error}") from None
        self._synced = time.monotonic()

    def add(self, row: Row) -> None:
        """One more row; on return a kill cannot take it away.

        Raises:
            InputError: it cannot be written.
        """
        config = {name: part for name, part in row.config.items() if name != "seed"}
        common = {
            "config": _parts(config),
            "columns": [_named(json.dumps(list(row.outcome)))],
            "origin": _parts(row.origin),
        }
        new = dict(part for parts in common.values() for part in parts)
        lines = [
            _line(f'{{"name": "{name}", "is": {text}}}')
            for name, text in new.items()
            if name not in self._named
        ]
        data = {
            "run_id": row.run_id,
            **{key: parts[-1][0] for key, parts in common.items()},
            "seed": row.config["seed"],
            "outcome": list(row.outcome.values()),
            "wall_time": row.wall_time,
            "trajectory": row.trajectory,
            "log": row.log,
        }
        content = b"".join([*lines, _line(json.dumps(data))])
        self._size += len(content)
        if self._size > LARGEST:
            raise InputError(
                f"cannot write {self._path}: larger than {LARGEST / 1e6:g} MB; choose another --out"
            )
        try:
            _write(self._file, content)
            self._named.update(new)
            if time.monotonic() - self._synced > SYNC_EVERY:
                os.fsync(self._file)
                self._synced = time.monotonic()
        except OSError as error:
            raise InputError(f"cannot write {self._path}: {error.strerror or error}") from None

    def close(self) -> None:
        """Put all on the disk."""
        with suppress(OSError):  # a full disk has been told
            os.fsync(self._file)
        os.close(self._file)


def _parts(data: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Names and texts of an object and of what is large in it, itself last."""
    parts: list[tuple[str, str]] = []
    shown: dict[str, Any] = {}
    for key, value in data.items():
        inner = _inner(value) if isinstance(value, dict) else []
        parts += inner
        shown[key] = {REFERENCE: inner[-1][0]} if inner else value
    return [*parts, _named(json.dumps(shown))]


@kept(most=1000)
def _inner(data: Mapping[str, Any]) -> list[tuple[str, str]]:
    """The same of a part of it, if it is large; most parts are of many runs."""
    return _parts(data) if len(json.dumps(data)) > SMALL else []


@lru_cache(maxsize=1000)
def _named(text: str) -> tuple[str, str]:
    return sha256(text.encode()).hexdigest()[:16], text


def _line(text: str) -> bytes:
    """A line of a JSON object and its checksum, which comes first."""
    body = b'", ' + text.encode("ascii")[1:]
    return BEFORE + b"%08x" % zlib.crc32(body) + body + b"\n"


def _cut(file: int) -> int:
    """Drop what stands behind the last end of a line, as a kill left it; the size then."""
    end = os.fstat(file).st_size
    while end:
        begin = max(0, end - 2**16)
        found = os.pread(file, end - begin, begin).rfind(b"\n")
        if found >= 0:
            end = begin + found + 1
            break
        end = begin
    os.ftruncate(file, end)
    return end


def _write(file: int, content: bytes) -> None:
    while content:
        content = content[os.write(file, content) :]
