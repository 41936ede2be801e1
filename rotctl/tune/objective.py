"""What a run is worth, and a candidate over its runs."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from pydantic.dataclasses import dataclass as validated

from rotctl.errors import InputError
from rotctl.metrics import appearance, pace
from rotctl.metrics.criteria import rolling
from rotctl.metrics.expressions import expression
from rotctl.settings.fields import STRICT, Finite, NonNegative, Positive

ROLLING = tuple(c.name for kind in (rolling, appearance, pace) for c in kind.COLUMNS)


@validated(frozen=True, config=STRICT)
class Wish:
    """What a column of the summary should be.

    Attributes:
        weight: taken off where it is missed by `miss` or more [-].
        low, high: between which all is well, in the column's unit; one of them may be absent.
        miss: so far outside takes off all of the weight, less in proportion [unit of the column].
    """

    weight: NonNegative
    miss: Positive
    low: Finite | None = None
    high: Finite | None = None

    def __post_init__(self) -> None:
        if self.low is None and self.high is None:
            raise ValueError("give low, high or both")
        if self.low is not None and self.high is not None and self.low > self.high:
            raise ValueError(f"low={self.low:g} must not exceed high={self.high:g}")

    def missed(self, value: float) -> float:
        """By how much of `miss` a value is outside, at most 1; all of it if it is no number."""
        if not math.isfinite(value):
            return 1.0
        below = 0.0 if self.low is None else self.low - value
        above = 0.0 if self.high is None else value - self.high
        return min(max(below, above, 0.0) / self.miss, 1.0)


@validated(frozen=True, config=STRICT)
class Objective:
    """Weights of a run's score, and how the scores of runs make that of a candidate.

    Attributes:
        over_runs: `mean` is the usual; `worst` asks for the same on every start.
        survival: on the fraction of the time before the run was cut [-].
        progress: on the revolutions, as a fraction of those at `pace` [-].
        pace: revolutions a second that earn full marks, and no more than that [rev/s].
        drift: taken off for each metre of lateral drift [1/m].
        heading: taken off for each degree of heading error at the end [1/deg].
        success: on what the config's criteria call a success [-].
        columns: of the summary row or of `metrics`, by name, and what they should be.
        metrics: further columns by name, as expressions; see `rotctl.metrics.expressions`.
    """

    over_runs: Literal["mean", "worst"]
    survival: NonNegative
    progress: NonNegative
    pace: Positive
    drift: NonNegative
    heading: NonNegative
    success: NonNegative = 0.0
    columns: dict[str, Wish] = field(default_factory=dict)
    metrics: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        weights = [self.survival, self.progress, self.drift, self.heading, self.success]
        if not any(weights + [wish.weight for wish in self.columns.values()]):
            raise ValueError("all weights are 0, so that no run is better than another")
        try:
            expression.read_all(self.metrics)
        except InputError as error:
            raise ValueError(str(error)) from None
        for name in self.metrics:
            if name in ROLLING:
                raise ValueError(f"metric {name}: there is a column of that name already")
            if name not in self.columns:
                raise ValueError(
                    f"metric {name}: acts on nothing, no column of that name is wished for"
                )
        for name in self.columns:
            if name not in (*ROLLING, *self.metrics):
                raise ValueError(
                    f"a roll has no column {name!r}; it has: {', '.join((*ROLLING, *self.metrics))}"
                )


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
