"""Verdicts and measures once more, by other criteria, out of the logs: nothing is simulated."""

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, NamedTuple

from rotctl.choices.overrides import assigned, single
from rotctl.config.loading import composed
from rotctl.config.schema import Config, check
from rotctl.errors import InputError
from rotctl.log import RunLog
from rotctl.metrics.expressions.evaluation import evaluate
from rotctl.metrics.expressions.expression import Expression
from rotctl.results.stored_runs import DONE, StoredRun, stored_runs
from rotctl.results.table import TAKEN, Table, tabulated
from rotctl.runs.summary import Summary, judged_again
from rotctl.settings.complaints import unknown_key
from rotctl.settings.plain import NOTHING, Way, exchanged, way
from rotctl.sweep.engines import Engine, Failure

NOT_JUDGED = "not judged"
BEFORE = "success_before"
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


@dataclass(frozen=True)
class Criteria:
    """What is asked for.

    Attributes:
        base: criteria in place of a run's own; None: its own.
        changes: values that are set on them.
    """

    base: Mapping[str, Any] | None
    changes: Sequence[tuple[Way, Any]]

    def of(self, own: Mapping[str, Any]) -> Mapping[str, Any]:
        """The criteria for a run with these of its own.

        Raises:
            InputError: they have no such key.
        """
        found: Any = own if self.base is None else self.base
        if not isinstance(found, Mapping):
            raise InputError("its config has no criteria")
        if found.get("kind") == own.get("kind") == "chain" and not found.get("parts"):
            found = own  # those that its parts have by themselves, which came with the behaviour
        for place, value in self.changes:
            changed = exchanged(found, place, value)
            if changed is NOTHING:
                raise InputError(unknown_key(f"criteria.{place[0]}", "criteria", list(found)))
            found = changed
        return dict(found)


def criteria(overrides: Sequence[str], none: bool = False) -> Criteria:
    """What overrides such as `criteria=landing criteria.tilt=20` ask for.

    Args:
        none: whether there may be none, which are a run's own.

    Raises:
        InputError: one is about something else, which would have to be simulated.
    """
    base, changes = None, []
    for text in overrides:
        found = assigned(single(text))
        if found and found.key == "criteria":
            base = composed([text])["criteria"]
        elif found and found.key.startswith("criteria."):
            changes.append((way(found.key)[1:], found.value))
        else:
            raise InputError(f"{text}: judge takes criteria=CHOICE and criteria.KEY=VALUE alone")
    if base is None and not changes and not none:
        raise InputError(
            "no criteria; such as criteria=landing or criteria.stall_time=2, or --metric"
        )
    return Criteria(base, changes)


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
        raise InputError(f"{folder}: no run can be judged: {(reasons or ['none is done'])[0]}")
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
        raise InputError(f"{folder}: no run can be judged: {found[asked[0][0].run_id].reason}")
    for complaint, count in complaints.items():
        if count == len(asked):
            raise InputError(complaint)
        notes.append(f"{count} runs: {complaint}")
    notes += [f"{count} runs: {remark}" for remark, count in remarks.items()]
    after = {name: bool(run.outcome["success"]) for name, run in found.items() if run.outcome}
    untold = Counter(run.reason for run in found.values() if run.status == NOT_JUDGED)
    notes += [
        f"{count} run{'s' * (count > 1)} not judged: {reason}" for reason, count in untold.items()
    ]
    table = tabulated(list(found.values()), notes)
    table.rows[BEFORE] = table.rows["run_id"].map(before)
    return Judged(
        table,
        lost=sum(before[name] and not success for name, success in after.items()),
        won=sum(success and not before[name] for name, success in after.items()),
    )


def _without(run: StoredRun, reason: str) -> StoredRun:
    return replace(run, status=NOT_JUDGED, reason=reason, outcome={}, code="")
