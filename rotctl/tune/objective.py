"""What a run is worth, and a candidate over its runs."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from rotctl.tune.space import Objective


@dataclass(frozen=True)
class TrialRun:
    """How one run went.

    Attributes:
        survived: simulated until it was cut, broke down or ended [s].
        wanted: simulated time asked for [s].
        revolutions: in-plane, in the direction commanded [rev].
        drift: largest distance from the line of travel [m].
        heading: of the trunk's axis at the end, against the rolling axis [deg].
        success: by the criteria of its config.
        columns: of its summary row, those that the objective looks at.
    """

    survived: float
    wanted: float
    revolutions: float
    drift: float
    heading: float
    success: bool
    columns: Mapping[str, float] = field(default_factory=dict)

    @property
    def to_the_end(self) -> bool:
        """Whether it was neither cut nor broke down."""
        return self.survived >= self.wanted - 1e-6


LOST = TrialRun(0.0, 1.0, 0.0, 0.0, 0.0, False)  # a run whose worker died every time: worth nothing


def score(run: TrialRun, objective: Objective) -> float:
    """What a run is worth; a perfect one the sum of `survival`, `progress` and `success`.

    A number that a broken-down run does not have counts for nothing, and a column of `columns` that
    it does not have as missed by all of its weight.
    """
    paced = run.revolutions / (objective.pace * run.wanted)
    value = (
        objective.survival * run.survived / run.wanted
        + objective.progress * min(max(paced, 0.0), 1.0)
        + objective.success * run.success
        - objective.drift * abs(run.drift)
        - objective.heading * abs(run.heading)
    )
    cost = math.fsum(
        wish.weight * wish.missed(run.columns.get(name, math.nan))
        for name, wish in objective.columns.items()
    )
    return (value if math.isfinite(value) else 0.0) - cost


def overall(runs: Sequence[TrialRun], objective: Objective) -> float:
    """The score of a candidate over its runs."""
    scores = [score(run, objective) for run in runs]
    return min(scores) if objective.over_runs == "worst" else math.fsum(scores) / len(scores)


def finished(runs: Sequence[TrialRun]) -> float:
    """The fraction of runs that were not cut."""
    return sum(run.to_the_end for run in runs) / len(runs)
