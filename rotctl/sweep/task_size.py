"""How many items go together into one task of a scheduler."""

from dataclasses import dataclass

TASK = 1.0  # [s] of work in a task
MOST_TOGETHER = 128  # items of a task
FIRST = 32  # tasks of one item each, before anything is known
SHARES = 32  # of what is left, a task has at most one
# Items at the scheduler at once. Results wait in the workers' memory until they are fetched, at
# about 2 MB an item: this bounds them, and keeps a hundred workers busy.
IN_FLIGHT = 512


@dataclass(frozen=True)
class Pace:
    """How many items make a task.

    A task costs some milliseconds of the scheduler's and the client's, however short it is. So
    short ones go together; few towards the end, that no worker has much left when others have none.

    Attributes:
        done, seconds: items that are done, and the time they took.
    """

    done: int = 0
    seconds: float = 0.0

    @property
    def in_flight(self) -> int:
        """Items that may be at the scheduler at once: few until it is known how long one takes."""
        return IN_FLIGHT if self.done else FIRST

    def size(self, left: int) -> int:
        """Items of the next task."""
        if not self.done:
            return 1
        wanted = round(TASK * self.done / max(self.seconds, 1e-6))
        return max(1, min(wanted, MOST_TOGETHER, left // SHARES, left))

    def after(self, count: int, seconds: float) -> "Pace":
        """The pace when so many more are done."""
        return Pace(self.done + count, self.seconds + seconds)
