"""Folders to write into, which go again where nothing came of it."""

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from rotctl.errors import InputError


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
        reason = dangling([path, *path.parents]) or error.strerror or error
        raise InputError(f"cannot write {path}: {reason}") from None
    if not linked and path.is_symlink():
        raise InputError(f"cannot write {path}: is a link")
    if not os.access(path, os.W_OK):
        raise InputError(f"cannot write {path}: no permission, or read-only")


def dangling(folders: Iterable[Path]) -> str:
    """Which of them is a link to nothing, of which the system says that it exists, or does not."""
    links = [each for each in folders if os.path.islink(each) and not os.path.exists(each)]
    return f"{links[0]} is a link to what is not there" if links else ""
