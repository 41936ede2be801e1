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


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the folder, made if need be; the lock file stays behind, which does not matter.

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
            _hold(descriptor, folder)
            yield
        finally:
            os.close(descriptor)


def _hold(descriptor: int, folder: Path) -> None:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise InputError(
            f"{folder}: another sweep is at work there; wait for it, or choose another --out"
        ) from None
    except OSError as error:
        raise InputError(f"cannot lock {folder / LOCK_NAME}: {error.strerror}") from None
