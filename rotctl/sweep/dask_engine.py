"""The workers of a Dask scheduler as an engine."""

import threading
import time
from collections import deque
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import CancelledError
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar
from uuid import uuid4

from rotctl.amounts import count
from rotctl.errors import RotctlError
from rotctl.sweep.apart import Death, apart
from rotctl.sweep.engines import TOGETHER, Failure, carried_out, died
from rotctl.sweep.task_size import IN_FLIGHT, Pace

if TYPE_CHECKING:
    from distributed import Client

T = TypeVar("T")
R = TypeVar("R")


class Batch(NamedTuple):
    """A task of the scheduler's.

    Attributes:
        indices: of its items.
        deaths: that its one item has seen: of the workers that it shared, of processes of its own.
        sheltered: whether it is in a process of its own.
    """

    indices: tuple[int, ...]
    deaths: int = 0
    sheltered: bool = False


class DaskEngine:
    """Tasks on a scheduler's workers; Dask replaces dead ones and gives their tasks to others.

    Dask gives up on a task when 4 workers died that held it (its `allowed-failures`), and with it
    on those that waited there: at whose hands they died nobody knows. So when all others are
    done, each of them goes into a process of its own on a worker, whose death is its own.
    """

    def __init__(self, client: "Client", address: str) -> None:
        self._client = client
        self._address = address

    @property
    def where(self) -> str:
        """Where the tasks run, for people."""
        n = self.workers
        return f"{self._address} with {count(n, 'worker') if n else 'no workers'} so far"

    @property
    def workers(self) -> int:
        """How many tasks run at once: one in a process, whatever its threads."""
        return len(self._client.nthreads())

    @property
    def together(self) -> int:
        """How many short runs are best carried out in one task."""
        return TOGETHER

    def map(
        self, task: Callable[[T], R], items: Sequence[T], retries: int
    ) -> Generator[tuple[int, R | Failure], None, None]:
        """As `Engine.map` has it."""
        from distributed import as_completed

        series = uuid4().hex  # the scheduler may have other clients
        left = deque(range(len(items)))
        suspects: deque[Batch] = deque()
        going: dict[str, Batch] = {}
        pending = as_completed(loop=self._client.loop)
        pace = Pace()

        def submit(batch: Batch) -> None:
            key = f"rotctl-{series}-{batch.indices[0]}-{len(batch.indices)}-{batch.deaths}"
            going[key] = batch
            some = [items[index] for index in batch.indices]
            work = _in_a_process if batch.sheltered else _one_by_one
            pending.add(self._client.submit(work, task, some, key=key, pure=False))

        def fill() -> None:
            while left and sum(len(batch.indices) for batch in going.values()) < pace.in_flight:
                size = pace.size(len(left))
                submit(Batch(tuple(left.popleft() for _ in range(size))))
            if all(batch.sheltered for batch in going.values()):  # none that kills its worker
                while suspects and len(going) < IN_FLIGHT:
                    submit(suspects.popleft())

        fill()
        for future in pending:
            batch = going.pop(future.key)
            result = self._result(future)
            results: list[R | Failure] = []
            if isinstance(result, Failure):
                results = [result] * len(batch.indices)
            elif result is None and not batch.sheltered:
                suspects.extend(Batch((index,), 1, sheltered=True) for index in batch.indices)
            elif result is None or isinstance(result, Death):
                deaths = batch.deaths + 1
                if deaths <= retries:
                    suspects.append(batch._replace(deaths=deaths))
                elif result is None:
                    results = [Failure("the workers that tried it died")]
                else:
                    results = [died(result.ending, deaths, least=True)]  # Dask tells of one
            else:
                results, seconds = result
                pace = pace.after(len(results), seconds)
            fill()
            if results:
                yield from zip(batch.indices, results, strict=True)

    def _result(self, future: Any) -> Any:
        """What became of a task; None if it was the death of its workers."""
        from distributed import KilledWorker

        try:
            return future.result()
        except KilledWorker:
            return None
        except CancelledError:
            raise RotctlError(
                f"{self._address}: the scheduler is gone; start it again and repeat the command"
            ) from None
        except Exception as error:  # a worker that could not read its task
            return Failure(" ".join(f"{type(error).__name__}: {error}".split()))

    def close(self) -> None:
        """Leave the scheduler; tasks that still run are dropped."""
        self._client.close()


_LOCK = threading.Lock()
"""MuJoCo's warnings and Hydra are one for a process: no two tasks in threads of it."""


def _one_by_one(task: Callable[[T], R], items: Sequence[T]) -> tuple[list[R | Failure], float]:
    """The results, and how long they took [s]."""
    with _LOCK:
        begin = time.perf_counter()
        results = [carried_out(task, item) for item in items]
        return results, time.perf_counter() - begin


def _in_a_process(task: Callable[[T], R], items: Sequence[T]) -> Any:
    """As `_one_by_one`, of one item in a process of its own; its `Death`, if it dies of it."""
    with _LOCK:
        begin = time.perf_counter()
        result = apart(task, items[0])
        if isinstance(result, Death):
            return result
        return [result], time.perf_counter() - begin
