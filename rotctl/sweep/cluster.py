"""Workers on other machines, through a Dask scheduler that somebody has started."""

import logging
import threading
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import CancelledError
from itertools import islice
from typing import TYPE_CHECKING, Any, TypeVar
from uuid import uuid4

from rotctl.errors import InputError, RotctlError
from rotctl.sweep.engines import Failure, carried_out

if TYPE_CHECKING:
    from distributed import Client

T = TypeVar("T")
R = TypeVar("R")

PATIENCE = 10.0  # [s] for a scheduler to answer
# Tasks at the scheduler at once. Results wait in the workers' memory until they are fetched,
# at about 1 MB a run: this bounds them, and keeps a hundred workers busy.
IN_FLIGHT = 512
TLS = "distributed.comm.tls, see docs/sweeps.md"
NOT_INSTALLED = "--scheduler needs Dask, which is not installed: pip install 'rotctl[cluster]'"


def connect(address: str) -> "DaskEngine":
    """The engine of the scheduler at `address`; TLS files come from Dask's own settings.

    Raises:
        InputError: Dask is not installed, the address is none, or nobody answers there.
    """
    if not address.startswith(("tcp://", "tls://")):
        raise InputError(
            f"--scheduler={address}: must be tcp://HOST:PORT or tls://HOST:PORT, "
            "such as tcp://127.0.0.1:8786"
        )
    try:
        from distributed import Client, Security
    except ImportError:
        raise InputError(NOT_INSTALLED) from None
    security = Security()
    if address.startswith("tls://") and not security.get_connection_args("client")["ssl_context"]:
        raise InputError(f"--scheduler={address}: Dask's settings name no TLS files: {TLS}")
    if address.startswith("tcp://") and security.require_encryption:
        raise InputError(f"--scheduler={address}: Dask's settings ask for encryption: tls://...")
    # A lost worker is no news to the user: its tasks are tried again, or listed at the end. That
    # the scheduler is lost is said below, in one line and not in a traceback.
    for name in ("distributed", "distributed.client", "asyncio"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        client = Client(address, timeout=PATIENCE, set_as_default=False, security=security)
    except (OSError, ValueError, TypeError, RuntimeError) as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise InputError(f"--scheduler={address}: no Dask scheduler there: {reason}") from None
    return DaskEngine(client, address)


class DaskEngine:
    """Tasks on a scheduler's workers; Dask replaces dead ones and gives their tasks to others.

    Dask gives up on a task when 4 workers died that held it (its `allowed-failures`), perhaps
    at the hands of another: that counts as one death here.
    """

    def __init__(self, client: "Client", address: str) -> None:
        self._client = client
        self._address = address

    @property
    def where(self) -> str:
        """Where the tasks run, for people."""
        workers = self.workers
        return f"{self._address} with {workers or 'no'} worker{'s' * (workers != 1)} so far"

    @property
    def workers(self) -> int:
        """How many tasks run at once: one in a process, whatever its threads."""
        return len(self._client.nthreads())

    def map(
        self, task: Callable[[T], R], items: Sequence[T], retries: int
    ) -> Generator[tuple[int, R | Failure], None, None]:
        """As `Engine.map` has it."""
        from distributed import as_completed

        series = uuid4().hex  # the scheduler may have other clients
        left = iter(enumerate(items))
        going: dict[str, tuple[int, int]] = {}  # key -> (index, deaths so far)
        pending = as_completed(loop=self._client.loop)

        def submit(index: int, item: T, deaths: int) -> None:
            key = f"rotctl-{series}-{index}-{deaths}"
            going[key] = index, deaths
            pending.add(self._client.submit(_one_at_a_time, task, item, key=key, pure=False))

        for index, item in islice(left, IN_FLIGHT):
            submit(index, item, 0)
        for future in pending:
            index, deaths = going.pop(future.key)
            result = self._result(future)
            if result is None:
                if deaths < retries:
                    submit(index, items[index], deaths + 1)
                    continue
                result = Failure("the workers that tried it died")
            for following, item in islice(left, 1):
                submit(following, item, 0)
            yield index, result

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


def _one_at_a_time(task: Callable[[T], R], item: T) -> R | Failure:
    """MuJoCo's warnings and Hydra are one for a process: no two tasks in threads of it."""
    with _LOCK:
        return carried_out(task, item)
