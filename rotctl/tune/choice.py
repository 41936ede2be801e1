"""The last candidates, tried on starts that no generation has seen.

A trial's score is the mean of few chaotic runs: the best of hundreds is mostly luck, which the
mean of the distribution is not.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from rotctl.tune.batches import Evaluator
from rotctl.tune.history import Trial
from rotctl.tune.objective import TrialRun, overall
from rotctl.tune.values import Values

BEST = 3  # trials that are tried again
DIGITS = 4  # of a result's numbers


@dataclass(frozen=True)
class Candidate:
    """What could be the result, tried on the final seeds.

    Attributes:
        name: where it comes from.
        values: rounded to what the result file will say.
        runs: how its runs went.
        score: over these runs.
    """

    name: str
    values: Values
    runs: list[TrialRun]
    score: float


def choose(
    evaluator: Evaluator,
    start: Values,
    trials: Sequence[Trial],
    mean: Values | None,
    seeds: range,
) -> tuple[Candidate, list[Candidate]]:
    """Try the last candidates.

    Args:
        mean: of the distribution; None if the search has none.
        seeds: for the runs of each.

    Returns:
        What the search started from, and the candidates, best first.
    """
    rivals = {"start": start}
    if mean is not None:
        rivals["mean of the distribution"] = mean
    for trial in sorted(trials, key=lambda trial: -trial.score)[:BEST]:
        rivals[f"generation {trial.generation}, candidate {trial.index}"] = trial.values
    rivals = {name: _rounded(values) for name, values in rivals.items()}
    objective, tried = evaluator.space.objective, evaluator.runs(list(rivals.values()), seeds)
    first, *others = (
        Candidate(name, values, runs, overall(runs, objective))
        for (name, values), (runs, _) in zip(rivals.items(), tried, strict=True)
    )
    return first, sorted(others, key=lambda candidate: -candidate.score)


def _rounded(values: Values) -> Values:
    return {key: float(f"{value:.{DIGITS}g}") for key, value in values.items()}
