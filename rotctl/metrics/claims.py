"""Claims: one sentence of a paper as numbers, and the verdict of the runs that it is about."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import AfterValidator, Field
from pydantic.dataclasses import dataclass as validated

from rotctl.metrics.measured import SUCCESS_RATE, Measured, in_which, measured, picked, simulated
from rotctl.settings.fields import STRICT, Finite, NonNegative

if TYPE_CHECKING:  # pandas takes half a second, and who plans a sweep needs none
    import pandas as pd

NOT_TESTED, NOT_REPRODUCED = "not tested", "not reproduced"
PARTLY, REPRODUCED = "partly", "reproduced"
VERDICTS = (NOT_TESTED, NOT_REPRODUCED, PARTLY, REPRODUCED)  # from worst to best

Where = dict[str, bool | int | float | str]


def _printable(name: str) -> str:
    if not name.strip() or not name.isprintable():
        raise ValueError("reports go by it: must be printable, on one line and not empty")
    return name


@validated(frozen=True, config=STRICT)
class Claim:
    """One sentence of a paper, or of ours, as numbers.

    Attributes:
        metric: `success_rate`, or a column of the summary.
        quantile: of that column over the runs, which counts: 0.5 is the median; no rate has one.
        expected: the value, in the unit of the metric.
        tolerance: how far the wrong side of it still counts; either side, if `near`.
        comparison: which side of `expected` is the right one.
        where: column -> value of the runs that it is about; all runs if empty.
    """

    id: Annotated[str, AfterValidator(_printable)]
    metric: str
    expected: Finite
    tolerance: NonNegative
    source: str
    comparison: Literal["near", "at_least", "at_most"] = "near"
    note: str = ""
    where: Where = field(default_factory=dict)
    quantile: Annotated[float, Field(gt=0, lt=1)] = 0.5

    def __post_init__(self) -> None:
        if self.metric == SUCCESS_RATE and self.quantile != 0.5:
            raise ValueError(f"{SUCCESS_RATE} is one number of all runs and has no quantile")
        share = 0.0 <= self.expected <= 1.0 and self.tolerance < 1.0
        if self.metric == SUCCESS_RATE and not share:
            raise ValueError(
                f"expected={self.expected:g}, tolerance={self.tolerance:g}: {SUCCESS_RATE} is a "
                "share of the runs, 0 to 1, and 5 % of them are 0.05"
            )

    def gap(self, value: float) -> float:
        """How far a value is on the wrong side, in the unit of the metric; negative: not at all."""
        above = value - self.expected
        return {"near": abs(above), "at_least": -above, "at_most": above}[self.comparison]


@dataclass(frozen=True)
class Judged:
    """A claim with its verdict.

    Attributes:
        missing: runs that the claim is about without a result.
        remarks: what a reader should know of it, one line each.
    """

    claim: Claim
    verdict: str
    measured: Measured
    missing: int
    remarks: tuple[str, ...]


def judge(claim: Claim, table: "pd.DataFrame", keys: Sequence[str]) -> Judged:
    """Judge a claim.

    *Reproduced*: the value misses what is expected by no more than the tolerance, and every run
    has a result. *Partly*: it misses by no more than twice the tolerance, or the interval of a
    rate reaches as far as the tolerance, or runs are missing. *Not tested*: no run has a result.

    Args:
        table: a row a run; `success` is empty where a run has no result.
        keys: its columns that are config keys.
    """
    about = picked(table, claim.where)
    done = about[about["success"].notna()]
    missing = len(about) - len(done)
    remarks = _mixed(claim, done, keys) if len(done) else [_untested(claim, table, about)]
    if missing:
        remarks.append(f"{missing} of {len(about)} runs have no result")
    if len(done) and claim.metric not in (SUCCESS_RATE, *done.columns):
        remarks.append(f"the summary has no {claim.metric!r}")
    found = measured(done, claim.metric, claim.quantile)
    if len(done) and claim.metric in done.columns and not found.runs:
        remarks.append(f"no run has a number of {claim.metric!r}")
    elif 0 < found.runs < len(done):
        remarks.append(f"{len(done) - found.runs} of {len(done)} runs have no {claim.metric!r}")
    return Judged(claim, _verdict(claim, found, missing), found, missing, tuple(remarks))


def overall(verdicts: Sequence[str]) -> str:
    """One verdict for several claims: partly, unless all or none of them hold."""
    if set(verdicts) == {REPRODUCED}:
        return REPRODUCED
    if set(verdicts) <= {NOT_TESTED, NOT_REPRODUCED}:
        return max(verdicts, key=VERDICTS.index, default=NOT_TESTED)
    return PARTLY


_ROUNDING = 1e-9  # 19 / 20 is 0.95


def _verdict(claim: Claim, found: Measured, missing: int) -> str:
    if found.value is None:
        return NOT_TESTED
    if claim.gap(found.value) <= claim.tolerance + _ROUNDING:
        return PARTLY if missing else REPRODUCED
    if claim.gap(found.value) <= 2 * claim.tolerance + _ROUNDING:
        return PARTLY
    if claim.metric != SUCCESS_RATE or found.low is None or found.high is None:
        return NOT_REPRODUCED
    nearest = min(max(claim.expected, found.low), found.high)
    return PARTLY if claim.gap(nearest) <= claim.tolerance + _ROUNDING else NOT_REPRODUCED


def _untested(claim: Claim, table: "pd.DataFrame", about: "pd.DataFrame") -> str:
    if len(about):
        return "no run has a result"
    absent = [k for k in claim.where if k not in table and f"config.{k}" not in table]
    return f"no column {absent[0]!r} in the runs" if absent else "no such run in the sweep"


def _mixed(claim: Claim, done: "pd.DataFrame", keys: Sequence[str]) -> list[str]:
    """In what the runs differ that should be alike."""
    differing = in_which(done, keys, claim.where)
    remarks = [f"over runs that differ in {', '.join(differing)}"] if differing else []
    apart = simulated(done).nunique()
    remarks += [f"{len(done)} runs, {apart} distinct"] if apart < len(done) else []
    codes = done["code"].nunique() if "code" in done else 1
    return remarks + ([f"over runs of {codes} versions of the code"] if codes > 1 else [])
