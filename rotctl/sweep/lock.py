"""One sweep at a time in a folder: a lock that ends with its process, however that ends."""

import errno
import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rotctl import files
from rotctl.errors import InputError

LOCK_NAME = "sweep.lock"
_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP)  # some network disks


@contextmanager
def locked(folder: Path) -> Iterator[str]:
    """Hold the folder, made if need be; the lock file stays behind, which does not matter.

    Returns:
        What to tell where the disk knows no locks, so that nothing is held; mostly empty.

    Raises:
        InputError: another sweep holds it, or it cannot be written.
    """
    path = folder / LOCK_NAME
    with files.folder(folder, linked=True):
        try:  # no link is followed: the file would be made where it leads
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o666)
        except OSError as error:
            reason = "is a link" if error.errno == errno.ELOOP else error.strerror
            raise InputError(f"cannot write {path}: {reason}") from None
        try:
            yield _hold(descriptor, folder)
        finally:
            os.close(descriptor)


def _hold(descriptor: int, folder: Path) -> str:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise InputError(
            f"{folder}: another sweep is at work there; wait for it, or choose another --out"
        ) from None
    except OSError as error:
        if error.errno in _NO_LOCKS:
            return f"{folder}: its disk knows no locks; start no second sweep or search there"
        raise InputError(f"cannot lock {folder / LOCK_NAME}: {error.strerror}") from None
    return ""
