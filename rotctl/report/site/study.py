"""A sweep and one experiment that it was made for: the rows, and the claims line by line."""

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import islice

from hydra.core.override_parser.types import ChoiceSweep, RangeSweep

from rotctl.amounts import count
from rotctl.choices.overrides import parsed
from rotctl.errors import InputError
from rotctl.metrics.claims import (
    NOT_REPRODUCED,
    NOT_TESTED,
    PARTLY,
    REPRODUCED,
    VERDICTS,
    Judged,
    overall,
)
from rotctl.metrics.measured import SUCCESS_RATE
from rotctl.report.site.rows import Row, rows
from rotctl.report.site.words import quantity
from rotctl.results.experiments import Experiment
from rotctl.results.sweeps import Sweep

_IN_A_WORD = {REPRODUCED: "Yes", PARTLY: "In part", NOT_REPRODUCED: "No", NOT_TESTED: "Unknown"}
MOST_NAMED = 12  # claims on a line
_CITED = re.compile(r"\[[A-Za-z]+\d{4}[a-z]?\]")
FEW = 20  # runs; below that a success rate says little


@dataclass(frozen=True)
class Study:
    """What is judged together.

    Attributes:
        name: of the experiment; empty without one.
        experiment: None: there is nothing to judge.
    """

    name: str
    sweep: Sweep
    experiment: Experiment | None
    rows: list[Row]

    @property
    def title(self) -> str:
        """A heading."""
        return self.experiment.title if self.experiment else self.sweep.name


@dataclass(frozen=True)
class Line:
    """A judged claim and where it stands; `sweep`, `experiment` and its id name it."""

    sweep: str
    experiment: str
    judged: Judged

    @property
    def key(self) -> tuple[str, str, str]:
        """Its name."""
        return self.sweep, self.experiment, self.judged.claim.id


def studies(sweep: Sweep) -> list[Study]:
    """One for each experiment of a sweep; one without claims where it has none."""
    if not sweep.experiments:
        return [Study("", sweep, None, rows(sweep, None))]
    return [Study(name, sweep, each, rows(sweep, each)) for name, each in sweep.experiments.items()]


def lines(found: Iterable[Study]) -> list[Line]:
    """All claims in the order of the page."""
    return [
        Line(study.sweep.name, study.name, judged)
        for study in found
        for row in study.rows
        for judged in row.claims
    ]


def tally(found: Sequence[Line]) -> dict[str, int]:
    """Verdict -> how many claims, from best to worst."""
    counted = Counter(line.judged.verdict for line in found)
    return {verdict: counted[verdict] for verdict in reversed(VERDICTS)}


def answer(found: Sequence[Line]) -> str:
    """The sentence that the report is made for."""
    if not found:
        return "No claims to judge."
    word = _IN_A_WORD[overall([line.judged.verdict for line in found])]
    return f"{word}: {tally(found)[REPRODUCED]} of {len(found)} claims reproduced."


def question(found: Sequence[Study]) -> str:
    """What `answer` answers: without claims nothing was asked."""
    if not lines(found):
        return "What these runs did"
    return "Does it reproduce the paper?" if of_a_paper(found) else "Do the claims hold?"


def of_a_paper(found: Iterable[Study]) -> bool:
    """Whether an experiment, or a claim of one, has its source in a paper, as `[Brown2013]`."""
    judged = [study.experiment for study in found if study.experiment]
    sources = [each.source for each in judged]
    sources += [claim.source for each in judged for claim in each.claims]
    return any(_CITED.search(source) for source in sources)


def by_quantity(found: Sequence[Line]) -> list[str]:
    """How many claims on each metric are reproduced, in words."""
    metrics = dict.fromkeys(line.judged.claim.metric for line in found)
    of = {m: [x for x in found if x.judged.claim.metric == m] for m in metrics}
    return [
        f"{quantity(metric)}: {tally(some)[REPRODUCED]} of {len(some)}"
        for metric, some in of.items()
    ]


def untested(found: Iterable[Line]) -> list[str]:
    """Which claims nobody could test, by the reason why, one line each."""
    reasons: dict[str, list[str]] = {}
    for line in found:
        if line.judged.verdict == NOT_TESTED:
            reason = "; ".join(line.judged.remarks)
            reasons.setdefault(reason, []).append(line.judged.claim.id)
    return [
        f"Not tested, {reason}: {', '.join(ids[:MOST_NAMED])}"
        + (f" and {len(ids) - MOST_NAMED} more" if len(ids) > MOST_NAMED else "")
        for reason, ids in reasons.items()
    ]


def warnings(study: Study) -> list[str]:
    """What a reader of the verdicts must know first."""
    return [*_few(study), *_same(study), *untested(lines([study]))]


def _same(study: Study) -> list[str]:
    """In which rows runs are the same to the bit, one line each."""
    rates = [(row.name, row.metrics[SUCCESS_RATE]) for row in study.rows]
    return [
        f"{name}: {rate.runs} runs, {rate.distinct} distinct, as many as its interval is of"
        for name, rate in rates
        if rate.distinct < rate.runs
    ]


def _few(study: Study) -> list[str]:
    rates = [
        (judged.measured.runs, row.seeds)
        for row in study.rows
        for judged in row.claims
        if judged.claim.metric == SUCCESS_RATE and judged.measured.runs
    ]
    fewest, starts = min(rates, default=(FEW, 0))
    if fewest >= FEW or not study.experiment:
        return []
    counted = count(fewest, "start")
    if starts != fewest:
        counted = f"{count(fewest, 'run')} from {count(starts, 'seed')}"
    said = f"Only {counted} a row, so that the intervals are wide."
    seeds = study.experiment.seeds
    whole = _no_more(seeds, study.sweep.table.rows["seed"].nunique())
    return [said if whole else f"{said} The whole experiment has seed={seeds}."]


def _no_more(seeds: str, there: int) -> bool:
    """Whether seeds in sweep syntax are no more than are there; not where it cannot be read."""
    try:
        found = parsed(f"seed={seeds}")
    except InputError:  # a stranger's
        return False
    if not found.is_sweep_override():
        return there > 0
    listed = isinstance(found.value(), ChoiceSweep | RangeSweep)
    return listed and len(list(islice(found.sweep_string_iterator(), there + 1))) <= there
