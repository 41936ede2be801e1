"""Batches of runs through an engine: carried out in any order, given back in theirs."""

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import Any

from rotctl.errors import RotctlError
from rotctl.metrics.expressions.expression import read_all
from rotctl.sweep.engines import Engine, Failure
from rotctl.tune.attempt import Attempt, attempt
from rotctl.tune.objective import LOST, TrialRun
from rotctl.tune.space import Space
from rotctl.tune.values import Values, configs

RETRIES = 2  # for a run whose worker died


@dataclass(frozen=True)
class Evaluator:
    """What candidates are tried with.

    Attributes:
        space: that they are from.
        data: the configs that they are put into, as plain data.
        engine: carries their runs out.
        tick: called after every run.
    """

    space: Space
    data: Sequence[Any]
    engine: Engine
    tick: Callable[[], object]

    def runs(
        self, candidates: Sequence[Values], seeds: Sequence[int]
    ) -> Generator[tuple[list[TrialRun], int]]:
        """The runs of each candidate, one a seed, and how many of them were lost.

        All are worked on together, and each candidate is given as soon as it and those before it
        are done. Close the generator to drop what still runs.

        Raises:
            RotctlError: every run of a candidate was lost.
        """
        batches = [configs(self.data, values, seeds) for values in candidates]
        places = [(b, i) for b, batch in enumerate(batches) for i in range(len(batch))]
        stopping, columns = self.space.stopping, tuple(self.space.objective.columns)
        metrics = read_all(self.space.objective.metrics)
        items = [Attempt(batches[b][i], stopping, columns, metrics) for b, i in places]
        results: list[dict[int, TrialRun | Failure]] = [{} for _ in batches]
        following = 0
        for place, result in self.engine.map(attempt, items, RETRIES):
            b, i = places[place]
            results[b][i] = result
            self.tick()
            while following < len(batches) and len(results[following]) == len(batches[following]):
                yield _counted([results[following][i] for i in sorted(results[following])])
                following += 1


def _counted(results: list[TrialRun | Failure]) -> tuple[list[TrialRun], int]:
    lost = [result.reason for result in results if isinstance(result, Failure)]
    if len(lost) == len(results):
        raise RotctlError(f"no run of a candidate gave a result: {lost[0]}")
    return [LOST if isinstance(result, Failure) else result for result in results], len(lost)
