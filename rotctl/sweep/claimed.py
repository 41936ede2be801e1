"""Whether an experiment's claims can be judged at all, before hours are spent on its runs."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from rotctl.config.schema import Config
from rotctl.errors import InputError
from rotctl.metrics.criteria.kinds import COLUMNS
from rotctl.metrics.measured import SUCCESS_RATE, same
from rotctl.results import experiments
from rotctl.results.keys import value_at
from rotctl.runs.summary import numbers
from rotctl.settings.writing import to_dict
from rotctl.suggestion import instead
from rotctl.sweep.plan import Planned
from rotctl.sweep.points import points

# Of the summary row of every run, beside what its kind of motion has.
_ALWAYS = ("duration", "torque_p99_fraction", "solver_failures", "real_time_factor")
METRICS = (SUCCESS_RATE, *_ALWAYS, *COLUMNS)
Values = tuple[Mapping[str, Any], Config]  # of the overridden keys, and of all


def require_claims(overrides: Sequence[str], runs: Iterable[Planned]) -> None:
    """See that the claims of the experiment that is named, if one is, are about what is measured.

    Deviations are about its runs, too. A claim about runs that further overrides leave out is one
    that nobody tests this time.

    Args:
        runs: that the overrides make.

    Raises:
        InputError: a metric is none, or no run of the experiment's own grid is one of `where`, or
            none of those has the metric.
    """
    name = experiments.named(list(overrides))
    if not name:
        return
    read = experiments.experiment(name)
    for claim in read.claims:
        if claim.metric not in METRICS:
            raise InputError(
                f"{experiments.PREFIX}{name}: claim {claim.id}: metric: no {claim.metric!r} is "
                "measured, and one of your own has no claims: rotctl judge DIR --metric tells it; "
                f"{instead(claim.metric, METRICS)}"
            )
    told = [_Told(f"claim {it.id}", it.where, it.metric) for it in read.claims]
    told += [_Told(f"deviations.{i}", it.where) for i, it in enumerate(read.deviations)]
    here: list[Values] = [(run.values, run.config) for run in runs]
    absent, unmeasured = _faults(told, here)
    if (absent or unmeasured) and len(overrides) > 1:
        own = experiments.matrix([f"{experiments.PREFIX}{name}", "seed=0"])
        here = [(point.values, point.config) for point in points(own)]
        faulty = [*absent, *(one for one, _ in unmeasured)]
        absent, unmeasured = _faults([one.of_any_seed for one in faulty], here)
    if absent:
        one = absent[0]
        raise InputError(
            f"{experiments.PREFIX}{name}: {one.who}: where: no run of its grid has "
            f"{_wrong(one.where, here)}"
        )
    if unmeasured:
        one, measured = unmeasured[0]
        raise InputError(
            f"{experiments.PREFIX}{name}: {one.who}: metric: no run that it is about has a "
            f"number of {one.metric!r}; {instead(one.metric, [SUCCESS_RATE, *sorted(measured)])}"
        )


class _Told(NamedTuple):
    """What an experiment says of runs: who says it, of which, and what of them it asks for."""

    who: str
    where: Mapping[str, Any]
    metric: str = SUCCESS_RATE  # of which every run has its share

    @property
    def of_any_seed(self) -> "_Told":
        return self._replace(where={key: it for key, it in self.where.items() if key != "seed"})


def _faults(
    told: Iterable[_Told], runs: Sequence[Values]
) -> tuple[list[_Told], list[tuple[_Told, set[str]]]]:
    """What is about none of these runs; and what asks for a metric that its runs have not."""
    absent, unmeasured = [], []
    for one in told:
        about = _picked(one.where, runs)
        measured = _measured(about) if about and one.metric != SUCCESS_RATE else {one.metric}
        if not about:
            absent.append(one)
        elif one.metric not in measured:
            unmeasured.append((one, measured))
    return absent, unmeasured


def _picked(where: Mapping[str, Any], runs: Sequence[Values]) -> list[Values]:
    return [run for run in runs if all(same(_value(key, run), it) for key, it in where.items())]


def _measured(runs: Sequence[Values]) -> set[str]:
    """What one of these runs at least may have a number of; runs differ little in what decides."""
    apart = {
        (id(config.behaviour), id(config.criteria), id(config.disturbance)): config
        for _, config in runs
    }
    return {name for config in apart.values() for name in numbers(config)}


def _value(key: str, run: Values) -> Any:
    """What a run has at a column of the summary that is a key of its config."""
    values, config = run
    key = key.removeprefix("config.")
    return values[key] if key in values else value_at(to_dict(config), key)


def _wrong(where: Mapping[str, Any], runs: Sequence[Values]) -> str:
    """The value that no run has, and what to write; all where each by itself is there."""
    for key, value in where.items():
        known = list(dict.fromkeys(map(str, (_value(key, run) for run in runs))))
        if known == ["None"]:
            keys = dict.fromkeys(key for run in runs for key in run[0])
            return f"the key {key!r}; {instead(key, keys)}"
        if str(value) not in known:
            return f"{key} {value}; {instead(str(value), known)}"
    return ", ".join(f"{key} {value}" for key, value in where.items())
