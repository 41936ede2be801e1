"""Verdicts and measures once more, by other criteria, out of the logs: nothing is simulated."""

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, NamedTuple

from rotctl.amounts import count
from rotctl.config.schema import Config, check
from rotctl.errors import InputError
from rotctl.log import RunLog
from rotctl.metrics.expressions.evaluation import evaluate
from rotctl.metrics.expressions.expression import Expression
from rotctl.results.stored_runs import DONE, StoredRun, stored_runs
from rotctl.results.table import TAKEN, Table, tabulated
from rotctl.runs.summary import Summary, judged_again
from rotctl.sweep.criteria import Criteria
from rotctl.sweep.engines import Engine, Failure

NOT_JUDGED = "not judged"
BEFORE = "success_before"
FEW = 3  # reasons that are told one by one
NO_LOG = "its log was not kept; rotctl sweep --keep all makes it again"


@dataclass(frozen=True)
class Judged:
    """Runs by other criteria.

    Attributes:
        table: with a column `success_before`.
        lost, won: how many verdicts have changed.
    """

    table: Table
    lost: int
    won: int


@dataclass(frozen=True)
class Question:
    """A log, its config with other criteria, and metrics to compute."""

    log: Path
    config: Mapping[str, Any]
    metrics: tuple[Expression, ...] = ()


class Answer(NamedTuple):
    """A summary row with its metrics.

    Attributes:
        complaints: why a metric cannot be computed.
        remarks: which metric is no finite number, as one of nothing, or by 0, is.
    """

    summary: Summary
    complaints: tuple[str, ...]
    remarks: tuple[str, ...]


def require_names(metrics: Sequence[Expression]) -> None:
    """See that no metric is called as a key is, by which runs are grouped, or as their verdict.

    Raises:
        InputError: one is.
    """
    keys = [part.name for part in fields(Config)]
    for metric in metrics:
        if metric.name in keys:
            raise InputError(f"metric {metric.name}: a key of the config has that name; rename it")
        if metric.name in (*TAKEN, BEFORE):
            raise InputError(_taken(metric))


def _taken(metric: Expression) -> str:
    return f"metric {metric.name}: there is a column of that name already"


def answer(question: Question) -> Answer:
    """The summary row of a logged run by its new criteria, with its metrics.

    Raises:
        LogError: the log cannot be read, or is damaged.
        InputError: such criteria do not judge such a run, or a metric has a column's name.
    """
    log = RunLog.open(question.log, linked=False)
    log.verify()
    summary = judged_again(log, check(dict(question.config)))
    complaints, remarks = [], []
    for metric in question.metrics:
        if metric.name in summary:
            raise InputError(_taken(metric))
        try:
            value = evaluate(metric, log)
        except InputError as error:
            value = math.nan
            complaints.append(str(error))
        else:
            if not math.isfinite(value):
                remarks.append(f"metric {metric.name}: is {value}, an empty cell")
        summary[metric.name] = value if math.isfinite(value) else None  # as JSON has it
    return Answer(summary, tuple(complaints), tuple(remarks))


def judge(
    folder: Path,
    wanted: Criteria,
    engine: Engine,
    progress: Callable[[], object] = lambda: None,
    metrics: tuple[Expression, ...] = (),
) -> Judged:
    """Judge all runs below a folder that have logs.

    Args:
        metrics: further columns; null in a run where one cannot be computed.
        progress: called after every run.

    Raises:
        InputError: there are none, none has criteria with such keys, or a metric has no value in
            any, or the name of something else.
    """
    require_names(metrics)
    runs, notes = stored_runs(folder)
    asked: list[tuple[StoredRun, Question]] = []
    found: dict[str, StoredRun] = {run.run_id: run for run in runs}
    for run in runs:
        if run.status != DONE:
            continue
        if not run.log:
            found[run.run_id] = _without(run, NO_LOG)
            continue
        try:
            config = {**run.config, "criteria": wanted.of(run.config.get("criteria", {}))}
        except InputError as error:
            found[run.run_id] = _without(run, str(error))
            continue
        asked.append((run, Question(folder / run.log, config, metrics)))
    if not asked:
        reasons = [run.reason for run in found.values() if run.reason]
        raise InputError(f"{folder}: no run can be judged: {_each(reasons or ['none is done'])}")
    before = {run.run_id: bool(run.outcome["success"]) for run, _ in asked}
    questions = [question for _, question in asked]
    complaints: Counter[str] = Counter()
    remarks: Counter[str] = Counter()
    with closing(engine.map(answer, questions, retries=2)) as results:
        for index, result in results:
            run = asked[index][0]
            if isinstance(result, Failure):
                found[run.run_id] = _without(run, result.reason)
            else:
                of = questions[index].config
                found[run.run_id] = replace(run, outcome=result.summary, config=of)
                complaints.update(result.complaints)
                remarks.update(result.remarks)
            progress()
    if all(found[run.run_id].status == NOT_JUDGED for run, _ in asked):
        reasons = [found[run.run_id].reason for run, _ in asked]
        raise InputError(f"{folder}: no run can be judged: {_each(reasons)}")
    for complaint, n in complaints.items():
        if n == len(asked):
            raise InputError(complaint)
        notes.append(f"{count(n, 'run')}: {complaint}")
    notes += [f"{count(n, 'run')}: {remark}" for remark, n in remarks.items()]
    after = {name: bool(run.outcome["success"]) for name, run in found.items() if run.outcome}
    untold = Counter(run.reason for run in found.values() if run.status == NOT_JUDGED)
    notes += [f"{count(n, 'run')} not judged: {reason}" for reason, n in untold.items()]
    table = tabulated(list(found.values()), notes)
    table.rows[BEFORE] = table.rows["run_id"].map(before)
    return Judged(
        table,
        lost=sum(before[name] and not success for name, success in after.items()),
        won=sum(success and not before[name] for name, success in after.items()),
    )


def _each(reasons: Sequence[str]) -> str:
    """The first few reasons: runs of several kinds have each their own."""
    told = list(dict.fromkeys(reasons))
    more = [f"and {len(told) - FEW} more"] if len(told) > FEW else []
    return "; ".join(told[:FEW] + more)


def _without(run: StoredRun, reason: str) -> StoredRun:
    return replace(run, status=NOT_JUDGED, reason=reason, outcome={}, code="")
