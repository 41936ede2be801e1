"""Metrics of one's own: what an expression such as `max(com[:, 2])` may say, and checking that.

The text is Python's grammar and nothing of its power: numbers, names of the log's arrays,
arithmetic, comparisons, indices and a fixed list of functions. Whatever else is written is refused
by the kind of its node, before anything is computed.
"""

import ast
import operator
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from rotctl.errors import InputError
from rotctl.log.schema import SCHEMA
from rotctl.metrics.expressions.operations import FUNCTIONS, LOOKED_UP, power
from rotctl.settings import documents
from rotctl.suggestion import instead

LONGEST = 1000  # characters
MOST_NODES = 200
MOST_METRICS = 50
CONSTANTS = {"pi": np.pi}
PERIOD = "period"  # of the control [s]
BINARY: Mapping[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: power,
    ast.BitAnd: np.logical_and,
    ast.BitOr: np.logical_or,
}
UNARY: Mapping[type, Callable[[Any], Any]] = {
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
    ast.Not: np.logical_not,
    ast.Invert: np.logical_not,
}
COMPARED: Mapping[type, Callable[[Any, Any], Any]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}
_ALLOWED = (
    *(ast.BinOp, ast.UnaryOp, ast.Compare, ast.BoolOp, ast.And, ast.Or),
    *(ast.Name, ast.Load, ast.Constant, ast.Subscript, ast.Slice, ast.Tuple, ast.Call, ast.keyword),
    *BINARY,
    *UNARY,
    *COMPARED,
)


def _names() -> dict[str, str]:
    """What an array of numbers is called -> its path in the log."""
    paths = [path for path, spec in SCHEMA.items() if np.dtype(spec.dtype).kind in "fib"]
    found = {path.replace("/", "_"): path for path in paths}
    for path in reversed(paths):  # of two of a name the former, as of all times the trajectory's
        name = path.rpartition("/")[2]
        if name not in FUNCTIONS and name not in LOOKED_UP:
            found[name] = path
    return found


NAMES = _names()


@dataclass(frozen=True)
class Expression:
    """A metric: a column's name, and the checked text of what is in it."""

    name: str
    text: str

    @property
    def tree(self) -> ast.expr:
        """Its syntax."""
        return _parsed(self.name, self.text)


def read(name: str, text: str) -> Expression:
    """A metric by that name.

    Raises:
        InputError: the text is none; one line that says what is not allowed.
    """
    if not name.isidentifier() or not name.isascii():
        raise InputError(f"metric {name!r:.60}: must be letters, digits and _, a letter first")
    _parsed(name, text)
    return Expression(name, text)


def read_all(texts: Mapping[str, str]) -> tuple[Expression, ...]:
    """Metrics by name.

    Raises:
        InputError: one is wrong, or there are too many.
    """
    if len(texts) > MOST_METRICS:
        raise InputError(f"metrics: {len(texts)} of them, valid: up to {MOST_METRICS}")
    return tuple(read(name, text) for name, text in texts.items())


def file_of_metrics(path: Path) -> dict[str, str]:
    """The texts of a YAML file, by name.

    Raises:
        InputError: it cannot be read, or is no such file.
    """
    data = documents.read_yaml(path, linked=True)
    if not isinstance(data, dict) or not all(isinstance(v, str) for v in data.values()):
        raise InputError(f"{path}: must be NAME: EXPRESSION, one a line")
    return {str(name): text for name, text in data.items()}


@lru_cache(maxsize=MOST_METRICS * 2)
def _parsed(name: str, text: str) -> ast.expr:
    shown = f"metric {name}"
    if len(text) > LONGEST:
        raise InputError(f"{shown}: longer than {LONGEST} characters")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of odd spellings, which are right or refused
            tree = ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise InputError(f"{shown}={text!r:.80}: cannot be read; such as max(com[:, 2])") from None
    nodes = list(ast.walk(tree))
    if len(nodes) > MOST_NODES:
        raise InputError(f"{shown}: more than {MOST_NODES} parts")
    functions = {id(node.func) for node in nodes if isinstance(node, ast.Call)}
    words = {id(arg) for node in nodes if isinstance(node, ast.Call) for arg in node.args}
    for node in nodes:
        _require(shown, node, id(node) in functions, id(node) in words)
    return tree


def _require(shown: str, node: ast.AST, called: bool, argument: bool) -> None:
    """Raises InputError for a node that no metric has."""
    if not isinstance(node, _ALLOWED):
        kind = type(node).__name__
        raise InputError(f"{shown}: {kind} is not allowed; numbers, arrays and functions are")
    if isinstance(node, ast.Name) and not called and node.id not in _known():
        raise InputError(
            f"{shown}: no array {node.id!r:.60} in a log; {instead(node.id, _known())}"
        )
    if isinstance(node, ast.Call):
        _require_function(shown, node)
    if isinstance(node, ast.Constant):
        sound = isinstance(node.value, int | float) or argument and isinstance(node.value, str)
        if not sound or isinstance(node.value, int) and abs(node.value) > 2**53:
            raise InputError(f"{shown}: {node.value!r:.40} is no number here")


def _require_function(shown: str, node: ast.Call) -> None:
    """Raises InputError for a call of no function, or with arguments that it has not."""
    valid = [*FUNCTIONS, *LOOKED_UP]
    if not isinstance(node.func, ast.Name):
        called = f"{ast.unparse(node.func):.60}"
        right = "such as max(com[:, 2]) is"
        if isinstance(node.func, ast.Attribute) and node.func.attr in valid:
            right = f"write {node.func.attr}({ast.unparse(node.func.value):.60})"
        raise InputError(f"{shown}: {called}(...) is no function; {right}")
    name = node.func.id
    if name not in valid:
        raise InputError(f"{shown}: no function {name!r:.60}; {instead(name, valid)}")
    texts = [isinstance(arg, ast.Constant) and isinstance(arg.value, str) for arg in node.args]
    if name in LOOKED_UP:
        if texts != [True] or node.keywords:
            raise InputError(f"{shown}: {name} takes one name in quotes")
        return
    function = FUNCTIONS[name]
    least, most = function.arguments
    if any(texts) or not least <= len(node.args) <= most:
        many = f"{least}" if least == most else f"{least} to {most}"
        plural = "s" * (most > 1)
        raise InputError(f"{shown}: {name} takes {many} argument{plural}: arrays and numbers")
    for keyword in node.keywords:
        axis = keyword.value.value if isinstance(keyword.value, ast.Constant) else None
        if keyword.arg != "axis" or not function.axis or type(axis) is not int:
            valid_one = "axis=0, 1 or 2" if function.axis else "no axis"
            raise InputError(f"{shown}: {name} takes {valid_one}, and no other keyword")


def _known() -> list[str]:
    return [*NAMES, PERIOD, *CONSTANTS]
