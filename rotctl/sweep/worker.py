"""A worker process with a pipe of its own.

The pools of the standard library and of loky break as a whole when one process dies, and leave
open whose task killed it. Here a dead worker is an end of file on its own pipe: its task is
known, and the others do not notice.
"""

import gc
import os
import pickle
import signal
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any

from rotctl.engine import mujoco_without_opengl
from rotctl.sweep.engines import Failure, carried_out, ending

PATIENCE = 5.0  # [s] for a process that was told to end


@dataclass(frozen=True)
class Worker:
    """A process that takes (task, item) from its pipe and gives back results."""

    process: BaseProcess
    pipe: Connection

    @classmethod
    def start(cls) -> "Worker":
        """Forked, and there at once with all that is imported, where this is the only thread.

        Else spawned, so that no lock that another thread holds is copied half-way.
        """
        forked = _alone()
        context = get_context("fork" if forked else "spawn")
        ours, theirs = context.Pipe()
        inherited = _open_files() - {theirs.fileno()} if forked else set()
        process = context.Process(target=serve, args=(theirs, inherited), daemon=True)  # type: ignore[attr-defined]
        process.start()
        theirs.close()  # else the pipe would not end with the worker
        return cls(process, ours)

    def send(self, task: Callable[[Any], Any], item: Any) -> None:
        """Give it something to do; a dead one is noticed when its result is read."""
        message = pickle.dumps((task, item))
        with suppress(OSError):
            self.pipe.send_bytes(message)

    def stop(self) -> None:
        """End the process, busy or not."""
        self.pipe.close()
        self.process.terminate()
        self.process.join(PATIENCE)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()

    def ending(self) -> str:
        """How a process ended that has let go of its pipe."""
        self.process.join(PATIENCE)
        code = self.process.exitcode
        self.stop()
        return ending(code)


def _alone() -> bool:
    """Whether this process has one thread; False where nobody tells."""
    try:
        return len(os.listdir("/proc/self/task")) == 1
    except OSError:  # not Linux
        return False


def _open_files() -> set[int]:
    """Descriptors of this process, but for the standard streams."""
    found = {int(name) for name in os.listdir("/proc/self/fd")} - {0, 1, 2}
    still = set()
    for descriptor in found:
        with suppress(OSError):  # that of the listing is closed again
            os.fstat(descriptor)
            still.add(descriptor)
    return still


def serve(pipe: Connection, inherited: set[int]) -> None:
    """The life of a worker: until the driver closes the pipe, or is gone.

    Args:
        inherited: descriptors of the driver that a fork has copied: its lock on a folder, and its
            ends of pipes, which would not end with it as long as a copy is open.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all; the driver decides
    for number in (signal.SIGTERM, signal.SIGALRM):  # a fork has the driver's handlers
        signal.signal(number, signal.SIG_DFL)
    _let_go(inherited)
    gc.freeze()  # what the driver has made stays: to look at it would copy its memory
    mujoco_without_opengl()
    while True:
        try:
            message = pipe.recv_bytes()
        except (EOFError, OSError):
            return
        try:
            answer = pickle.dumps(carried_out(_call, message), pickle.HIGHEST_PROTOCOL)
        except Exception as error:  # a result that cannot travel
            answer = pickle.dumps(Failure(f"{type(error).__name__}: {error}"))
        try:
            pipe.send_bytes(answer)
        except OSError:
            return


def _let_go(inherited: set[int]) -> None:
    """Put nothing in place of descriptors, which somebody here may still close, or has closed."""
    nothing = os.open(os.devnull, os.O_RDWR)  # may be one that was closed
    for descriptor in inherited - {nothing}:
        os.dup2(nothing, descriptor, inheritable=False)
    if nothing not in inherited:
        os.close(nothing)


def _call(message: bytes) -> Any:
    task, item = pickle.loads(message)
    return task(item)
