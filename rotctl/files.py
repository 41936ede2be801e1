"""Files are read only if they are plain ones, and replaced whole or not at all.

What lies in a folder that came from somebody else may be a pipe that never ends, or a link
that leads out of the folder. So whatever a command finds there by itself is no link, while a
path that the user names may be one.
"""

import errno
import fcntl
import os
import stat
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from io import FileIO
from pathlib import Path
from typing import BinaryIO

from rotctl.errors import InputError

PATIENCE = 60.0  # [s] with another process that writes the same file
TURN = 0.005  # [s] from one look at it to the next
_REASONS = {
    errno.ENOENT: "no such file",
    errno.ENOTDIR: "no such file",
    errno.ENAMETOOLONG: "no such file",
    errno.EACCES: "permission denied",
}


def opened(path: Path, *, linked: bool) -> BinaryIO:
    """A regular file, open for reading; nothing else is opened, so that nothing waits.

    Args:
        linked: whether a symbolic link is followed: only where the user names the path.

    Raises:
        InputError: `<path>: <reason>`.
    """
    try:
        _require_regular(path, os.stat(path, follow_symlinks=linked).st_mode)
        flags = os.O_RDONLY | os.O_NONBLOCK | (0 if linked else os.O_NOFOLLOW)
        file = open(os.open(path, flags), "rb")  # noqa: SIM115
        try:  # it may have been exchanged
            _require_regular(path, os.fstat(file.fileno()).st_mode)
        except InputError:
            file.close()
            raise
        return file
    except OSError as error:
        raise InputError(f"{path}: {_reason(error)}") from None
    except ValueError:  # a name that no file can have
        raise InputError(f"{path}: no such file") from None


def read(path: Path, limit: int, *, linked: bool) -> bytes:
    """The content of a regular file.

    Args:
        limit: largest size that is read [bytes].
        linked: see `opened`.

    Raises:
        InputError: `<path>: <reason>`.
    """
    try:
        with opened(path, linked=linked) as file:
            content = file.read(limit + 1)
    except OSError as error:
        raise InputError(f"{path}: {_reason(error)}") from None
    if len(content) > limit:
        raise InputError(f"{path}: larger than {limit / 1e6:g} MB")
    return content


def text(path: Path, limit: int, *, linked: bool) -> str:
    """The content of a text file; arguments and errors are those of `read`."""
    content = read(path, limit, linked=linked)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"{path}:{line}: is no text (UTF-8)") from None


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
        reason = _dangling(path.parents) or error.strerror or error
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


@contextmanager
def folder(path: Path, *, linked: bool) -> Iterator[None]:
    """A folder to write into, made with its parents; if the work fails, what is still empty goes.

    Args:
        linked: whether it may be a symbolic link: only where the user names it.

    Raises:
        InputError: `cannot write <path>: <reason>`.
    """
    # Known before they are made: an interrupt may come right after.
    missing = [each for each in (path, *path.parents) if not os.path.lexists(each)]
    try:
        _make(path, linked)
        yield
    except BaseException:
        for each in missing:
            with suppress(OSError):  # it holds something
                each.rmdir()
        raise


def _make(path: Path, linked: bool) -> None:
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = _dangling([path, *path.parents]) or error.strerror or error
        raise InputError(f"cannot write {path}: {reason}") from None
    if not linked and path.is_symlink():
        raise InputError(f"cannot write {path}: is a link")
    if not os.access(path, os.W_OK):
        raise InputError(f"cannot write {path}: no permission, or read-only")


def _dangling(folders: Iterable[Path]) -> str:
    """Which of them is a link to nothing, of which the system says that it exists, or does not."""
    links = [each for each in folders if os.path.islink(each) and not os.path.exists(each)]
    return f"{links[0]} is a link to what is not there" if links else ""


def _require_regular(path: Path, mode: int) -> None:
    if stat.S_ISREG(mode):
        return
    if stat.S_ISLNK(mode):
        raise InputError(f"{path}: is a link; only plain files are read here")
    raise InputError(f"{path}: {'is a folder' if stat.S_ISDIR(mode) else 'is no plain file'}")


def _reason(error: OSError) -> str:
    return _REASONS.get(error.errno or 0) or error.strerror or str(error)


def sync(path: Path) -> None:
    """Have a file, or the names in a folder, on the disk on return."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
