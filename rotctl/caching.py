"""Results that are kept for the very objects they came from.

To compare or hash a whole config takes longer than to simulate its first steps; whether two are
the same object is known at once, and the points of a sweep share all that they do not change.
"""

from collections import OrderedDict
from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar

T = TypeVar("T")


def kept(most: int) -> Callable[[Callable[..., T]], Callable[..., T]]:
    """Keep the last `most` results of a function of positional arguments that nobody changes.

    Numbers and texts are compared, all else must be the same object.
    """

    def keeping(function: Callable[..., T]) -> Callable[..., T]:
        found: OrderedDict[tuple[Any, ...], tuple[Any, T]] = OrderedDict()

        @wraps(function)
        def keeper(*arguments: Any) -> T:
            key = tuple(map(_mark, arguments))
            if key not in found:
                found[key] = arguments, function(*arguments)  # with them, so that no id is reused
                if len(found) > most:
                    found.popitem(last=False)
            return found[key][1]

        return keeper

    return keeping


def _mark(argument: Any) -> Any:
    plain = isinstance(argument, int | float | str)
    return (type(argument), argument) if plain else id(argument)
