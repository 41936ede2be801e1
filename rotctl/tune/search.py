"""The search: propose a generation, try it on fresh starts, remember; at the end, choose."""

import time
from collections.abc import Callable
from contextlib import closing
from dataclasses import asdict, dataclass, replace
from math import ceil, inf
from pathlib import Path
from statistics import fmean, median
from typing import Any

from rotctl.errors import InputError
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.sweep.engines import Engine
from rotctl.sweep.lock import locked
from rotctl.tune.attempt import searchable
from rotctl.tune.batches import Evaluator
from rotctl.tune.choice import BEST, Candidate, choose
from rotctl.tune.history import History, Trial, by_generation, open_history
from rotctl.tune.objective import finished, overall
from rotctl.tune.sampler import Generations, centre, need_extra, propose
from rotctl.tune.space import SamplerName, Space, load_space
from rotctl.tune.values import (
    Values,
    configs,
    final_seeds,
    start_values,
    training_seeds,
    variations,
)

SEEDS = 1_000_000  # searches, each with a block of training seeds of its own


@dataclass(frozen=True)
class Search:
    """All that decides what a search finds.

    Attributes:
        overrides: of the command line.
        seed: of the search; it also picks its block of training seeds.
    """

    space: Space
    overrides: list[str]
    seed: int


@dataclass(frozen=True)
class Budget:
    """Whole generations until `trials` are there; or those that fit into `minutes` from now."""

    trials: int | None
    minutes: float | None


@dataclass(frozen=True)
class Watch:
    """Whom to tell: `line` gets a line for each generation, `tick` is called after each run."""

    line: Callable[[str], object]
    tick: Callable[[], object]


@dataclass(frozen=True)
class SearchResult:
    """What a search came to.

    Attributes:
        data: the config that it started from, as plain data.
        trials: those of all complete generations.
        start: what it started from, on the final seeds.
        candidates: best first.
    """

    search: Search
    data: Any
    trials: list[Trial]
    start: Candidate
    candidates: list[Candidate]


def prepare(
    name: str,
    overrides: list[str],
    seed: int,
    sampler: SamplerName | None,
    trials: int | None,
    minutes: float | None,
) -> tuple[Search, Budget]:
    """What the command line asks for.

    Args:
        name: of a space.
        sampler: instead of the space's.
        trials, minutes: budget; neither: the trials that the space names.

    Raises:
        InputError: one line on what is wrong with it.
    """
    need_extra()
    space = load_space(name)
    if not 0 <= seed < SEEDS:
        raise InputError(f"--seed={seed}: must be 0 to {SEEDS - 1:,}")
    for option, value in (("--trials", trials), ("--minutes", minutes)):
        if value is not None and not 0 < value < inf:
            raise InputError(f"{option}={value:g}: must be above 0")
    if sampler:
        space = replace(space, sampler=replace(space.sampler, name=sampler))
    if trials is None and minutes is None:
        trials = space.trials
    return Search(space, overrides, seed), Budget(trials, minutes)


def tune(
    search: Search, folder: Path, budget: Budget, engine: Engine, watch: Watch
) -> SearchResult:
    """Search, or go on with the search in `folder`.

    Raises:
        InputError: the space does not fit the config, or the folder is not for this search.
        RotctlError: the engine carries nothing out.
    """
    space = search.space
    data = variations(space, search.overrides)
    start = start_values(space, data[0])
    _require_runs(search, data, start)
    with locked(folder) as notice:
        if notice:
            watch.line(notice)
        history = open_history(folder, space, _identity(search, data))
        evaluator = Evaluator(space, data, engine, watch.tick)
        done = _searched(search, start, evaluator, history, budget, watch.line)
        watch.line(f"choosing between the last candidates, on {space.runs.final} more starts")
        mean = centre(space, start, _scored(done))
        trials = [trial for generation in done for trial in generation]
        seeds = final_seeds(space, search.seed)
        first, others = choose(evaluator, start, trials, mean, seeds)
    return SearchResult(search, data[0], trials, first, others)


def _require_runs(search: Search, data: list[Any], start: Values) -> None:
    """See that what the search starts from makes runs, before there is a folder for them.

    Raises:
        InputError: a variation does not; one line that says why.
    """
    seeds = training_seeds(search.space, search.seed, 0)[: len(data)]
    for config in configs(data, start, seeds):
        searchable(config)
        in_memory(build(config), look=lambda buffer, done: True)  # its first step


def _searched(
    search: Search,
    start: Values,
    evaluator: Evaluator,
    history: History,
    budget: Budget,
    line: Callable[[str], object],
) -> list[list[Trial]]:
    """Generations until the budget is spent."""
    space = search.space
    size = space.sampler.population
    wanted = ceil(budget.trials / size) if budget.trials else inf
    # What the final choice takes, in generations.
    final = (BEST + 2) * space.runs.final / (size * space.runs.seeds)
    if budget.trials and budget.trials % size:
        line(f"{size * wanted} trials in place of {budget.trials}: whole generations of {size}")
    begin, longest = time.monotonic(), 0.0
    while True:
        done, _ = by_generation(history.trials(), size)
        left = 60.0 * budget.minutes - (time.monotonic() - begin) if budget.minutes else inf
        if len(done) >= wanted or (done and left < (1.0 + final) * longest):
            return done
        before = time.monotonic()
        _generation(search, start, evaluator, history)
        took = time.monotonic() - before
        longest = max(longest, took)
        more = (wanted - len(done) - 1 + final) * took
        line(_line(history.trials(), len(done), min(left - took, more)))


def _generation(search: Search, start: Values, evaluator: Evaluator, history: History) -> None:
    """Try the candidates of the next generation, less those tried before an interruption."""
    space, begin = search.space, time.monotonic()
    done, begun = by_generation(history.trials(), space.sampler.population)
    number = len(done)
    points = propose(space, start, _scored(done), search.seed)
    seeds = training_seeds(space, search.seed, number)
    left = sorted(set(range(len(points))) - {trial.index for trial in begun})
    with closing(evaluator.runs([points[i] for i in left], seeds)) as results:
        for i, (runs, lost) in zip(left, results, strict=True):
            history.add(
                Trial(
                    generation=number,
                    index=i,
                    values=points[i],
                    score=overall(runs, space.objective),
                    finished=finished(runs),
                    lost=lost,
                    seconds=time.monotonic() - begin,
                )
            )


def _scored(done: list[list[Trial]]) -> Generations:
    return [[(trial.values, trial.score) for trial in generation] for generation in done]


def _line(trials: list[Trial], number: int, left: float) -> str:
    """How generation `number` went; `left` is the time until the end [s]."""
    generation = [trial for trial in trials if trial.generation == number]
    scores = [trial.score for trial in generation]
    lost = sum(trial.lost for trial in generation)
    minutes, seconds = divmod(max(0, round(left)), 60)
    return (
        f"generation {number:3}  trials {len(trials):4}  best {max(scores):.3f}  "
        f"median {median(scores):.3f}  best so far {max(t.score for t in trials):.3f}  "
        f"{fmean(t.finished for t in generation):4.0%} of runs to the end  "
        f"{max(t.seconds for t in generation):5.1f} s  "
        f"{minutes}:{seconds:02} left" + (f"  {lost} runs lost" if lost else "")
    )


def _identity(search: Search, data: list[Any]) -> dict[str, Any]:
    """What must be the same for a search to go on; texts and budget may change."""
    space = asdict(replace(search.space, title="", description="", trials=1))
    return {"space": space, "overrides": search.overrides, "seed": search.seed, "configs": data}
