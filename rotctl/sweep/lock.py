"""One sweep at a time in a folder: a lock that ends with its process, however that ends."""

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rotctl.errors import InputError

LOCK_NAME = "sweep.lock"


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the folder, made if need be; the lock file stays behind, which does not matter.

    Raises:
        InputError: another sweep holds it, or it cannot be written.
    """
    path = folder / LOCK_NAME
    try:
        folder.mkdir(parents=True, exist_ok=True)
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    except OSError as error:
        raise InputError(f"cannot write {folder}: {error.strerror}") from None
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError(
                f"{folder}: another sweep is at work there; wait for it, or choose another --out"
            ) from None
        except OSError as error:
            raise InputError(f"cannot lock {path}: {error.strerror}") from None
        yield
    finally:
        os.close(descriptor)
