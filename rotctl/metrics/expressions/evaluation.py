"""Computing a metric of one's own, within bounds of memory and work."""

import ast
import warnings
from math import prod
from typing import Any

import numpy as np

from rotctl.errors import InputError, RotctlError
from rotctl.metrics.columns import Arrays
from rotctl.metrics.expressions.expression import (
    BINARY,
    COMPARED,
    CONSTANTS,
    NAMES,
    PERIOD,
    UNARY,
    Expression,
)
from rotctl.metrics.expressions.operations import FUNCTIONS, LOOKED_UP, SLOW

LARGEST = 20_000_000  # elements of an array: twenty minutes of all contacts; 160 MB
MOST_WORK = 100_000_000  # elements of all arrays together: 800 MB if all are held, a second


def evaluate(expression: Expression, log: Arrays) -> float:
    """The value of a metric of a run; 1 or 0 for what holds or does not.

    Args:
        log: arrays by schema path, a `RunLog` or a buffer's.

    Raises:
        InputError: it has none here; one line that says why.
    """
    shown = f"metric {expression.name}"
    try:
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of means of nothing, which are NaN
            found = np.asarray(_Evaluation(log).value(expression.tree))
    except RotctlError as error:
        raise InputError(f"{shown}: {error}") from None
    except (ArithmeticError, IndexError, RecursionError, TypeError, ValueError) as error:
        raise InputError(f"{shown}: {' '.join(str(error).split())}") from None
    if found.size != 1:
        shape = " x ".join(map(str, found.shape))
        raise InputError(f"{shown}: gives {shape} values; make one of them, such as by max(...)")
    return float(found.reshape(()))


class _Evaluation:
    """Of one tree, with what it may still spend."""

    def __init__(self, log: Arrays) -> None:
        self._log, self._left = log, MOST_WORK
        self._arrays: dict[str, Any] = {}

    def value(self, node: ast.AST) -> Any:
        """The value of a node; all numbers are floats, or truth values."""
        match node:
            case ast.Constant(value=int() | float() as number):
                return np.float64(number)
            case ast.Name(id=name):
                return self._named(name)
            case ast.BinOp(left=left, op=op, right=right):
                cost = SLOW if isinstance(op, ast.Pow) else 1
                return self._applied(BINARY[type(op)], [left, right], cost)
            case ast.UnaryOp(op=op, operand=operand):
                return self._applied(UNARY[type(op)], [operand])
            case ast.BoolOp(op=op, values=values):
                both = isinstance(op, ast.And)
                return self._folded(np.logical_and if both else np.logical_or, values)
            case ast.Compare(left=left, ops=ops, comparators=others):
                pairs = zip([left, *others], ops, others, strict=False)
                compared = [self._applied(COMPARED[type(op)], [a, b]) for a, op, b in pairs]
                return self._folded(np.logical_and, compared)
            case ast.Subscript(value=array, slice=index):
                return np.asarray(self.value(array))[self._index(index)]
            case ast.Call(func=ast.Name(id=name), args=args, keywords=keywords):
                if name in LOOKED_UP:
                    assert isinstance(args[0], ast.Constant)  # as the expression was checked
                    return self._number(LOOKED_UP[name], str(args[0].value))
                chosen = {
                    k.arg: k.value.value for k in keywords if isinstance(k.value, ast.Constant)
                }
                function = FUNCTIONS[name]
                return self._applied(function.made, args, function.cost, chosen)
        raise InputError(f"{type(node).__name__} has no value")

    def _named(self, name: str) -> Any:
        if name in CONSTANTS:
            return np.float64(CONSTANTS[name])
        if name == PERIOD:
            time = self._array("trajectory/time")
            return time[1] - time[0]
        return self._array(NAMES[name])

    def _array(self, path: str) -> Any:
        if path not in self._arrays:
            if path not in self._log:
                raise InputError(f"this log has no {path}")
            found = np.asarray(self._log[path])
            self._spend(found.size)
            self._arrays[path] = found if found.dtype == bool else found.astype(float)
        return self._arrays[path]

    def _number(self, path: str, name: str) -> Any:
        """The place of a name in a list of the log."""
        if path not in self._log:
            raise InputError(f"this log has no {path}")
        names = [text.decode("utf-8", "replace") for text in np.asarray(self._log[path]).tolist()]
        if name not in names:
            raise InputError(f"{path} has no {name!r:.60}; it has: {', '.join(names)}")
        return np.float64(names.index(name))

    def _applied(
        self, function: Any, arguments: list[Any], cost: int = 1, chosen: Any = None
    ) -> Any:
        given = [self.value(a) if isinstance(a, ast.AST) else a for a in arguments]
        values = [np.asarray(value, dtype=float) for value in given]  # truth values are 0 and 1
        self._spend(prod(np.broadcast_shapes(*map(np.shape, values))), cost)
        return function(*values, **(chosen or {}))

    def _folded(self, function: Any, values: list[Any]) -> Any:
        found = values[0]
        for value in values[1:]:
            found = self._applied(function, [found, value])
        return self.value(found) if isinstance(found, ast.AST) else found

    def _spend(self, elements: int, cost: int = 1) -> None:
        if elements > LARGEST:
            raise InputError(f"an array of {elements} elements, valid: up to {LARGEST}")
        self._left -= elements * cost
        if self._left < 0:
            raise InputError("too much to compute")

    def _index(self, node: ast.AST) -> Any:
        match node:
            case ast.Tuple(elts=parts):
                return tuple(map(self._index, parts))
            case ast.Slice(lower=lower, upper=upper, step=step):
                return slice(
                    *(None if part is None else self._whole(part) for part in (lower, upper, step))
                )
        value = self.value(node)
        return value if np.ndim(value) and np.asarray(value).dtype == bool else _whole(value)

    def _whole(self, node: ast.AST) -> int:
        return _whole(self.value(node))


def _whole(value: Any) -> int:
    """A number as an index."""
    if np.ndim(value) or not float(value).is_integer():
        raise InputError("an index must be a whole number, or a truth value for each row")
    return int(value)
