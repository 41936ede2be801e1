"""Batches of runs through an engine: carried out in any order, given back in theirs."""

from collections.abc import Callable, Generator, Sequence

from rotctl.config import Config
from rotctl.errors import RotctlError
from rotctl.sweep.engines import Engine, Failure
from rotctl.tune.attempt import Attempt, attempt
from rotctl.tune.objective import LOST, Rolled
from rotctl.tune.space import Stopping

RETRIES = 2  # for a run whose worker died


def tried(
    engine: Engine,
    batches: Sequence[Sequence[Config]],
    stopping: Stopping,
    tick: Callable[[], object] = lambda: None,
) -> Generator[tuple[list[Rolled], int]]:
    """The runs of each batch, and how many of them were lost, batch by batch.

    All batches are worked on together, and each is given as soon as it and those before it
    are done. Close the generator to drop what still runs.

    Args:
        tick: called after every run.

    Raises:
        RotctlError: every run of a batch was lost.
    """
    places = [(b, i) for b, batch in enumerate(batches) for i in range(len(batch))]
    items = [Attempt(batches[b][i], stopping) for b, i in places]
    found: list[dict[int, Rolled | Failure]] = [{} for _ in batches]
    following = 0
    for place, result in engine.map(attempt, items, RETRIES):
        b, i = places[place]
        found[b][i] = result
        tick()
        while following < len(batches) and len(found[following]) == len(batches[following]):
            yield _counted([found[following][i] for i in sorted(found[following])])
            following += 1


def _counted(results: list[Rolled | Failure]) -> tuple[list[Rolled], int]:
    lost = [result.reason for result in results if isinstance(result, Failure)]
    if len(lost) == len(results):
        raise RotctlError(f"no run of a candidate gave a result: {lost[0]}")
    return [LOST if isinstance(result, Failure) else result for result in results], len(lost)
