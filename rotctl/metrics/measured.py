"""One number of many runs: a rate with its interval, or a quantile with its quartiles."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rotctl.metrics.rates import wilson

if TYPE_CHECKING:  # pandas takes half a second, and who plans a sweep needs none
    import pandas as pd

SUCCESS_RATE = "success_rate"


@dataclass(frozen=True)
class Measured:
    """A rate, or a quantile of a quantity, the median if nothing else is said.

    Attributes:
        value: the rate or the quantile; None if nothing was measured.
        low: Wilson's 95 % interval of a rate, quartiles of the rest.
        high: see `low`.
        runs: how many it comes from.
        distinct: of a rate how many of them are no other one to the bit, as its interval has it.
    """

    value: float | None = None
    low: float | None = None
    high: float | None = None
    runs: int = 0
    distinct: int = 0


def picked(table: "pd.DataFrame", where: Mapping[str, Any]) -> "pd.DataFrame":
    """The runs of a table that have these values; none if a column is not there."""
    for key, value in where.items():
        # A key that is also measured is `config.<key>`: what was asked for.
        column = f"config.{key}" if f"config.{key}" in table else key
        if column not in table:
            return table.iloc[:0]
        found = table[column].tolist()
        table = table.iloc[[row for row, its in enumerate(found) if same(its, value)]]
    return table


def same(found: object, wanted: object) -> bool:
    """Whether a run has what is asked for; yes is no 1, and no is no 0."""
    return bool(found == wanted) and isinstance(found, bool) == isinstance(wanted, bool)


def measured(done: "pd.DataFrame", metric: str, quantile: float = 0.5) -> Measured:
    """A metric over runs with results; values that are no finite numbers are left out."""
    if metric == SUCCESS_RATE:
        n, succeeded = len(done), int(done["success"].astype(bool).sum())
        if not n:
            return Measured()
        apart = simulated(done).nunique()
        return Measured(succeeded / n, *wilson(succeeded, n, apart), n, apart)
    values = [
        float(value)
        for value in done.get(metric, [])
        if isinstance(value, int | float) and math.isfinite(value)
    ]
    if not values:
        return Measured()
    import numpy as np

    low, value, high = np.quantile(values, [0.25, quantile, 0.75]).tolist()
    return Measured(value, low, high, len(values))


def simulated(runs: "pd.DataFrame") -> "pd.Series[Any]":
    """What of runs is the same if they are to the bit, as where seeds draw nothing.

    A run of which that is not known is taken for one of its own.
    """
    own = runs.index.to_series()
    return runs["trajectory"].where(runs["trajectory"] != "", own) if "trajectory" in runs else own


def in_which(runs: "pd.DataFrame", keys: Sequence[str], where: Mapping[str, Any]) -> list[str]:
    """The keys in which runs differ that are taken together, beside their seed."""
    return [
        key
        for key in keys
        if key != "seed" and key not in where and runs[key].nunique(dropna=False) > 1
    ]
