"""Proposes a generation of candidates from all that is known: pure functions.

A generation depends on the finished ones before it and the seed, on nothing else: a search
that was killed and goes on gives the same result as one that was never interrupted.
"""

import math
import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.tune.space import Parameter, Space
from rotctl.tune.values import Values

if TYPE_CHECKING:
    from cmaes import SepCMA
    from optuna.distributions import BaseDistribution

Scored = tuple[Values, float]
Generations = Sequence[Sequence[Scored]]  # finished generations, each complete and in order
EXTRA = "rotctl tune needs Optuna and cmaes, which are not installed: pip install 'rotctl[tune]'"


def need_extra() -> None:
    """Refuse to start a search that cannot be carried out.

    Raises:
        InputError: the extra is not installed.
    """
    try:
        import cmaes  # noqa: F401
        import optuna  # noqa: F401
    except ImportError:
        raise InputError(EXTRA) from None


def propose(space: Space, start: Values, told: Generations, seed: int) -> list[Values]:
    """The candidates of the generation after those told."""
    drawn = int(np.random.SeedSequence([seed, len(told)]).generate_state(1)[0])
    if space.sampler.name == "tpe":
        return _tpe(space, start, told, drawn)
    normal = _normal(space, start, told)
    normal.reseed_rng(drawn)
    return [_values(space, normal.ask()) for _ in range(space.sampler.population)]


def centre(space: Space, start: Values, told: Generations) -> Values | None:
    """The mean of the distribution that the search has come to; None if it has none."""
    if space.sampler.name != "cmaes":
        return None
    return _values(space, _normal(space, start, told).mean.clip(0.0, 1.0))


def _normal(space: Space, start: Values, told: Generations) -> "SepCMA":
    """The distribution after all that was told, over the unit cube.

    Separable: with few candidates of noisy score, a variance for each number is all that can
    be learnt.
    """
    from cmaes import SepCMA

    normal = SepCMA(
        mean=_unit(space, start),
        sigma=space.sampler.sigma,
        bounds=np.array([[0.0, 1.0]] * len(space.parameters)),
        population_size=space.sampler.population,
    )
    for generation in told:
        normal.tell([(_unit(space, values), -score) for values, score in generation])
    return normal


def _tpe(space: Space, start: Values, told: Generations, seed: int) -> list[Values]:
    import optuna
    from optuna.trial import create_trial

    optuna.logging.set_verbosity(optuna.logging.WARNING)
    ranges = distributions(space)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
        sampler = optuna.samplers.TPESampler(
            seed=seed,
            multivariate=True,
            constant_liar=True,  # keeps the candidates of a generation apart
            n_startup_trials=space.sampler.population,
        )
    study = optuna.create_study(direction="maximize", sampler=sampler)
    for generation in told:
        study.add_trials(
            [create_trial(params=v, distributions=ranges, value=score) for v, score in generation]
        )
    if not told:
        study.enqueue_trial(start)
    return [dict(study.ask(ranges).params) for _ in range(space.sampler.population)]


def distributions(space: Space) -> "dict[str, BaseDistribution]":
    """The parameters in Optuna's terms."""
    from optuna.distributions import FloatDistribution

    return {p.key: FloatDistribution(p.low, p.high, log=p.scale == "log") for p in space.parameters}


def _unit(space: Space, values: Values) -> Array:
    return np.array([_to_unit(p, values[p.key]) for p in space.parameters]).clip(0.0, 1.0)


def _to_unit(p: Parameter, value: float) -> float:
    if p.scale == "log":
        return math.log(value / p.low) / math.log(p.high / p.low)
    return (value - p.low) / (p.high - p.low)


def _values(space: Space, unit: Array) -> Values:
    pairs = zip(space.parameters, unit, strict=True)
    return {p.key: min(max(_from_unit(p, float(u)), p.low), p.high) for p, u in pairs}


def _from_unit(p: Parameter, unit: float) -> float:
    if p.scale == "log":
        return p.low * math.exp(unit * math.log(p.high / p.low))
    return p.low + unit * (p.high - p.low)
