"""A chain of behaviours in numbers: which part lasted from when to when, each by itself."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rotctl.metrics.columns import Arrays, Column, floats
from rotctl.metrics.excerpt import Excerpt
from rotctl.metrics.halts import Halts

COLUMNS = (
    Column("parts_succeeded", "Parts that succeeded", ""),
    Column("parts_begun", "Parts that began", ""),
    Column("parts", "Each part, when it began [s], and what came of it", ""),
)


class Link(NamedTuple):
    """What was asked of one part.

    Attributes:
        name: of its behaviour.
        stages: how many it has.
        commanded, halts: see `rotctl.metrics.criteria.judge.judge`.
    """

    name: str
    stages: int
    commanded: Mapping[str, float]
    halts: Halts = ()


@dataclass(frozen=True)
class Span(Excerpt):
    """A part's rows, as a log of their own that begins at time 0 in stage 0.

    Attributes:
        stage: number of the part's first.
    """

    stage: int

    def __getitem__(self, name: str) -> np.ndarray:
        """Those rows of one array."""
        own = super().__getitem__(name)
        if name == "trajectory/time":
            return np.asarray(own - own[:1])
        return np.asarray(own - self.stage) if name == "command/stage" else own


def spans(log: Arrays, stages: Sequence[int]) -> list[Span]:
    """The rows of each part that has begun, in their order; `stages` tells how many each has.

    Of a chain that began again they overlap, see `again`.
    """
    stage = np.asarray(log["command/stage"])
    first = np.concatenate(([0], np.cumsum(stages))).tolist()
    found = []
    for begin, end in zip(first, first[1:], strict=False):
        rows = np.flatnonzero((stage >= begin) & (stage < end))
        if len(rows):
            found.append(Span(log, slice(int(rows[0]), int(rows[-1]) + 1), begin))
    return found


def again(log: Arrays, stages: Sequence[int]) -> bool:
    """Whether an earlier part ever goes on after a later one; a part by itself may go back."""
    part = np.searchsorted(np.cumsum(stages), np.asarray(log["command/stage"]), side="right")
    return bool((np.diff(part) < 0).any())


def told(log: Arrays, links: Sequence[Link], parts: Sequence[Span], reasons: Sequence[str]) -> str:
    """Each part in words, for a summary row."""
    time = floats(log, "trajectory/time")
    return "; ".join(
        f"{link.name} {time[part.rows.start]:.2f}: {reason or 'success'}"
        for link, part, reason in zip(links, parts, reasons, strict=False)
    )
