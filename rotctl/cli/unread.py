"""Output that nobody reads any more: the command goes on, and its exit code is its own."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from typing import Any, TextIO, cast


@contextmanager
def left_unread() -> Iterator[None]:
    """While it lasts, what goes to a closed pipe is dropped, as `| head` closes one."""
    with redirect_stdout(_droppable(sys.stdout)), redirect_stderr(_droppable(sys.stderr)):
        try:
            yield
        finally:
            with suppress(OSError, AttributeError):  # a full disk the interpreter tells; or None
                sys.stdout.flush()


def drop(stream: TextIO) -> None:
    """Let what a stream still holds go nowhere: the interpreter flushes it once more."""
    with suppress(OSError, AttributeError):  # it is no file, or None
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


class _Droppable:
    """A stream, whoever reads it or not."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        try:
            return self._stream.write(text)
        except BrokenPipeError:
            drop(self._stream)
            return len(text)

    def flush(self) -> None:
        try:
            self._stream.flush()
        except BrokenPipeError:
            drop(self._stream)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def _droppable(stream: TextIO | None) -> TextIO:
    """Such a one of it; None, which `print` knows, where the shell has closed it."""
    return cast(TextIO, stream and _Droppable(stream))
