"""A file that takes another's place in one step, whole or not at all."""

import errno
import fcntl
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import FileIO
from pathlib import Path

from rotctl.errors import InputError
from rotctl.files.folders import dangling

PATIENCE = 60.0  # [s] with another process that writes the same file
TURN = 0.005  # [s] from one look at it to the next


def require_ending(path: Path, *endings: str) -> None:
    """Check the name of a file that is to be written.

    Raises:
        InputError: it says that the file is something else.
    """
    if path.suffix.lower() not in endings:
        raise InputError(f"{path}: valid endings: {', '.join(endings)}")


def encoded(text: str) -> bytes:
    """UTF-8; what it cannot hold, such as a byte of a file's name, is spelled out."""
    return text.encode("utf-8", "backslashreplace")


def replace(path: Path, content: bytes, *, durable: bool = False) -> None:
    """Put `content` at `path` in one step; a link there is replaced, not followed.

    Args:
        durable: it is on the disk on return, for what must survive a loss of power.

    Raises:
        InputError: `cannot write <path>: <reason>`; what was there stays.
    """
    with _beside(path, durable) as (_, file):
        while content:
            content = content[file.write(content) or 0 :]


@contextmanager
def replacing(path: Path, *, durable: bool = False) -> Iterator[Path]:
    """An empty file beside `path` to write to, which takes its place when all went well.

    Arguments and errors are those of `replace`.
    """
    with _beside(path, durable) as (part, _):
        yield part


@contextmanager
def _beside(path: Path, durable: bool) -> Iterator[tuple[Path, FileIO]]:
    """That file, and it opened; whoever else writes to `path` meanwhile waits."""
    try:
        file, part = _new(path.with_name(f"{path.name}.part"))
        with file:
            try:
                yield part, file
                if durable:
                    os.fsync(file.fileno())
                os.replace(part, path)
            except BaseException:
                with suppress(OSError):
                    part.unlink(missing_ok=True)
                raise
        if durable:
            sync(path.parent)
    except OSError as error:
        reason = dangling(path.parents) or error.strerror or error
        raise InputError(f"cannot write {path}: {reason}") from None


def _new(part: Path) -> tuple[FileIO, Path]:
    """A file made anew, where nobody can have put a link, and locked: it is not left over.

    On a disk that knows no locks it has a name of its own where one lies at `part`, which may be
    left over, or another process's that still writes it.
    """
    while True:
        try:
            file = open(part, "xb", buffering=0)  # noqa: SIM115
        except FileExistsError:
            if not _removed(part):
                part = part.with_name(f"{part.stem}.{os.urandom(4).hex()}.part")
            continue
        _wait(file)
        if _still_at(part, file):
            return file, part
        file.close()


def _removed(part: Path) -> bool:
    """Remove what a kill left behind, or wait for the process that is writing it.

    Returns:
        False where the disk knows no locks, so that nobody can tell which it is.
    """
    try:
        left = os.open(part, os.O_WRONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except FileNotFoundError:  # it took its place meanwhile; what lies there next is another's
        return True
    except OSError:  # a link or a pipe, which nobody of ours made
        part.unlink(missing_ok=True)
        return True
    with open(left, "wb", buffering=0) as file:
        locked = _wait(file)
        if locked and _still_at(part, file):
            part.unlink(missing_ok=True)
    return locked


def _wait(file: FileIO) -> bool:
    """Lock a file; whether its disk knows locks.

    Raises:
        TimeoutError: the process that is writing it does not come to an end.
    """
    for _ in range(round(PATIENCE / TURN)):
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return True
        except BlockingIOError:
            time.sleep(TURN)
        except OSError:
            return False
    raise TimeoutError(errno.ETIMEDOUT, f"another process has been writing it for {PATIENCE:g} s")


def _still_at(part: Path, file: FileIO) -> bool:
    """Whether a file is the one that lies at `part`."""
    try:
        return os.path.samestat(os.fstat(file.fileno()), os.stat(part, follow_symlinks=False))
    except FileNotFoundError:
        return False


def sync(path: Path) -> None:
    """Have a file, or the names in a folder, on the disk on return."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
