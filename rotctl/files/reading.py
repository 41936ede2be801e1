"""Regular files are read, and nothing else, within a limit."""

import errno
import os
import stat
from pathlib import Path
from typing import BinaryIO

from rotctl.errors import InputError

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


def _require_regular(path: Path, mode: int) -> None:
    if stat.S_ISREG(mode):
        return
    if stat.S_ISLNK(mode):
        raise InputError(f"{path}: is a link; only plain files are read here")
    raise InputError(f"{path}: {'is a folder' if stat.S_ISDIR(mode) else 'is no plain file'}")


def _reason(error: OSError) -> str:
    return _REASONS.get(error.errno or 0) or error.strerror or str(error)
