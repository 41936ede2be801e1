"""Signals that end a command, none of which is lost."""

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

SOON = 0.05  # [s] until it is tried again: nobody notices, and few are in the way twice


@contextmanager
def interruptible() -> Iterator[None]:
    """While it lasts, SIGTERM ends a command as cleanly as Ctrl-C does.

    What a signal raises would be lost where nobody can catch it, as while an object is deleted, and
    while a module in C is imported: MuJoCo, for one, makes another error of it, or none. There it
    is raised a little later, or at the end. An alarm of whoever calls the command stays his until
    then.
    """
    postponed = False

    def postpone() -> None:
        nonlocal postponed
        postponed = True
        signal.setitimer(signal.ITIMER_REAL, SOON)

    def interrupt(signum: int, frame: FrameType | None) -> None:
        nonlocal postponed
        if signum == signal.SIGALRM and not postponed and callable(usual_alarm):
            usual_alarm(signum, frame)
        elif _imports_c(frame):
            postpone()
        else:
            postponed = False
            raise KeyboardInterrupt

    def lost(error: "UnraisableHookArgs") -> None:
        if isinstance(error.exc_value, KeyboardInterrupt):
            postpone()
        else:
            usual_hook(error)

    numbers = [signal.SIGTERM, signal.SIGALRM]
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # else it is ignored
        numbers.append(signal.SIGINT)
    usual_alarm = signal.getsignal(signal.SIGALRM)
    try:
        before = [(number, signal.signal(number, interrupt)) for number in numbers]
    except ValueError:  # not the main thread, which alone gets signals
        yield
        return
    usual_hook, sys.unraisablehook = sys.unraisablehook, lost
    try:
        yield
    finally:
        sys.unraisablehook = usual_hook
        if postponed:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number, handler in before:
            signal.signal(number, handler)
    if postponed:  # and over before it was tried again
        raise KeyboardInterrupt


def _imports_c(frame: FrameType | None) -> bool:
    """Whether a module in C is being imported there; one in Python hands on what is raised."""
    while frame and not frame.f_code.co_qualname.startswith("ExtensionFileLoader."):
        frame = frame.f_back
    return frame is not None
