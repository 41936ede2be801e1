"""Worker processes on this machine, as many at once as are asked for."""

import os
import pickle
from collections import deque
from collections.abc import Callable, Generator, Sequence
from multiprocessing import connection
from multiprocessing.connection import Connection
from typing import TypeVar

from rotctl.amounts import count
from rotctl.errors import InputError
from rotctl.sweep.engines import TOGETHER, Failure, died
from rotctl.sweep.worker import Worker

T = TypeVar("T")
R = TypeVar("R")

MOST_JOBS = 1024
BLAS_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def cpus() -> int:
    """How many CPUs this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class LocalEngine:
    """Up to `jobs` processes, started when there is work and kept for the next map."""

    def __init__(self, jobs: int | None = None) -> None:
        if jobs is not None and not 1 <= jobs <= MOST_JOBS:
            raise InputError(f"--jobs={jobs}: valid: 1 to {MOST_JOBS}")
        self._jobs = jobs or cpus()
        self._idle: list[Worker] = []

    @property
    def where(self) -> str:
        """Where the tasks run, for people."""
        return count(self._jobs, "local process", "local processes")

    @property
    def workers(self) -> int:
        """How many tasks run at once."""
        return self._jobs

    @property
    def together(self) -> int:
        """How many short runs are best carried out in one task."""
        return TOGETHER

    def map(
        self, task: Callable[[T], R], items: Sequence[T], retries: int
    ) -> Generator[tuple[int, R | Failure], None, None]:
        """As `Engine.map` has it."""
        waiting = deque((index, 0) for index in range(len(items)))  # (index, deaths so far)
        busy: dict[Connection, tuple[Worker, int, int]] = {}
        try:
            while waiting or busy:
                while waiting and len(busy) < self._jobs:
                    index, deaths = waiting.popleft()
                    worker = self._idle.pop() if self._idle else _started()
                    busy[worker.pipe] = worker, index, deaths
                    worker.send(task, items[index])
                for pipe in connection.wait(list(busy)):
                    assert isinstance(pipe, Connection)
                    worker, index, deaths = busy[pipe]
                    try:
                        result = pickle.loads(pipe.recv_bytes())
                    except (EOFError, OSError):  # it died, perhaps in the middle of an answer
                        del busy[pipe]
                        how = worker.ending()
                        if deaths < retries:
                            waiting.append((index, deaths + 1))
                            continue
                        result = died(how, deaths + 1)
                    else:
                        if waiting:  # it works on while the caller looks at this result
                            following, before = waiting.popleft()
                            busy[pipe] = worker, following, before
                            worker.send(task, items[following])
                        else:
                            del busy[pipe]
                            self._idle.append(worker)
                    yield index, result
        finally:
            for worker, _, _ in busy.values():
                worker.stop()

    def close(self) -> None:
        """End all processes."""
        while self._idle:
            self._idle.pop().stop()


def _started() -> Worker:
    """A worker with one BLAS thread: matrices are small, and runs in parallel worth more."""
    for name in BLAS_THREADS:  # inherited, and read when numpy is first imported there
        os.environ.setdefault(name, "1")
    return Worker.start()
