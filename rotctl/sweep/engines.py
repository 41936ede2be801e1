"""What runs tasks, in processes here or on the workers of a Dask scheduler: the contract."""

import signal
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar

from rotctl.errors import RotctlError

T = TypeVar("T")
R = TypeVar("R")

TOGETHER = 8  # short runs in a task: more gain nothing


@dataclass(frozen=True)
class Failure:
    """Why a task gave no result.

    Attributes:
        reason: one line.
    """

    reason: str


class Engine(Protocol):
    """Something that runs tasks; close it when done, and what still runs is dropped."""

    @property
    def where(self) -> str:
        """Where the tasks run, for people."""
        ...

    @property
    def workers(self) -> int:
        """How many tasks run at once, as far as is known now; 0 if no worker has come yet."""
        ...

    @property
    def together(self) -> int:
        """How many short runs are best carried out in one task."""
        ...

    def map(
        self, task: Callable[[T], R], items: Sequence[T], retries: int
    ) -> Generator[tuple[int, R | Failure], None, None]:
        """Yield (index, result) in order of completion, each index once.

        An exception in a task is a `Failure` at once, as it would come again. A worker that
        dies is replaced, and its task tried again; a `Failure` when no try is left. Close the
        generator to drop what still runs.

        Args:
            task: picklable, and at home in a module that the workers can import.
            items: picklable.
            retries: further tries for a task whose worker died, >= 0.
        """
        ...

    def close(self) -> None:
        """Let the workers go."""
        ...


def carried_out(task: Callable[[T], R], item: T) -> R | Failure:
    """Run a task in a worker; what it raises is its `Failure`."""
    try:
        return task(item)
    except RotctlError as error:
        return Failure(str(error))
    except Exception as error:
        return Failure(" ".join(f"{type(error).__name__}: {error}".split()))


def ending(code: int | None) -> str:
    """How a process ended, by its exit code, for people."""
    if code is not None and code < 0:
        return f"killed by {signal.Signals(-code).name}"
    return f"exit code {code}"


def died(how: str, tries: int, *, least: bool = False) -> Failure:
    """What to say of a task that was tried so often and had a process each time.

    Args:
        how: the last of them ended.
        least: that it was so often at least.
    """
    often = f"at least {tries}" if least else tries
    counted = "" if tries == 1 else f", the last of {often} times"
    return Failure(f"its worker died: {how}{counted}")
