"""The functions that metrics of one's own may call, by name: numpy's, as far as they are safe."""

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

SLOW = 50  # times as much work for an element as an addition


class Function(NamedTuple):
    """A function of arrays.

    Attributes:
        arguments: how many it takes, at least and at most.
        axis: whether it may be told one.
        cost: elements of work for each of its argument's.
    """

    made: Callable[..., Any]
    arguments: tuple[int, int]
    axis: bool = False
    cost: int = 1


def _norm(x: Any, axis: int = -1) -> Any:
    return np.sqrt(np.sum(np.square(x), axis=axis))


def _percentile(x: Any, q: Any, axis: int | None = None) -> Any:
    return np.percentile(x, float(q), axis=axis)


def _longest(mask: Any) -> int:
    """Rows of the longest stretch in which something holds."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], np.ravel(mask) != 0, [False]))))
    return int(np.max(edges[1::2] - edges[::2], initial=0))


def _first(mask: Any) -> float:
    """The first row in which something holds; NaN if it never does."""
    holds = np.ravel(mask) != 0
    return float(np.argmax(holds)) if holds.any() else np.nan


def _each(function: Callable[..., float], arguments: int) -> Callable[..., Any]:
    """Element by element by the C library: numpy's own has other last bits on other processors."""

    def safe(*values: float) -> float:
        try:
            return function(*values)
        except OverflowError:
            return math.inf
        except ValueError:
            return math.nan

    elementwise = np.frompyfunc(safe, arguments, 1)
    return lambda *arrays: np.asarray(elementwise(*arrays), dtype=float)


def _log(x: float) -> float:
    return math.log(x) if x else -math.inf


_pow = _each(math.pow, 2)


def power(x: Any, exponent: Any) -> Any:
    """To a power; a square or a cube by multiplication."""
    if np.ndim(exponent) == 0 and exponent in (2.0, 3.0):
        return x * x if exponent == 2.0 else x * x * x
    return _pow(x, exponent)


_ONE, _TWO, _THREE = (1, 1), (2, 2), (3, 3)
FUNCTIONS: Mapping[str, Function] = {
    "max": Function(np.max, _ONE, axis=True),
    "min": Function(np.min, _ONE, axis=True),
    "mean": Function(np.mean, _ONE, axis=True),
    "sum": Function(np.sum, _ONE, axis=True),
    "std": Function(np.std, _ONE, axis=True),
    "any": Function(np.any, _ONE, axis=True),
    "all": Function(np.all, _ONE, axis=True),
    "median": Function(np.median, _ONE, axis=True, cost=10),
    "percentile": Function(_percentile, _TWO, axis=True, cost=10),
    "norm": Function(_norm, _ONE, axis=True),
    "diff": Function(lambda x: np.diff(x, axis=0), _ONE),
    "cumsum": Function(lambda x: np.cumsum(x, axis=0), _ONE),
    "unwrap": Function(lambda x: np.unwrap(x, axis=0), _ONE, cost=10),
    "longest": Function(_longest, _ONE, cost=5),
    "first": Function(_first, _ONE),
    "abs": Function(np.abs, _ONE),
    "sqrt": Function(np.sqrt, _ONE),
    "exp": Function(_each(math.exp, 1), _ONE, cost=SLOW),
    "log": Function(_each(_log, 1), _ONE, cost=SLOW),
    "sin": Function(_each(math.sin, 1), _ONE, cost=SLOW),
    "cos": Function(_each(math.cos, 1), _ONE, cost=SLOW),
    "atan2": Function(_each(math.atan2, 2), _TWO, cost=SLOW),
    "degrees": Function(np.degrees, _ONE),
    "radians": Function(np.radians, _ONE),
    "isfinite": Function(np.isfinite, _ONE),
    "minimum": Function(np.minimum, _TWO),
    "maximum": Function(np.maximum, _TWO),
    "clip": Function(np.clip, _THREE),
    "where": Function(np.where, _THREE),
}
# Functions of a name in quotes: its number in one of the log's lists.
LOOKED_UP: Mapping[str, str] = {"joint": "model/joint", "body": "model/body", "task": "model/task"}
