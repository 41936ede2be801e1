"""One run as a task for a worker.

The runs of a sweep differ in few parts of their configs. So the parts travel as bytes, and equal
bytes become one object again in a worker: what it has made of a part, it need not make twice.
"""

import pickle
from dataclasses import fields
from functools import lru_cache
from typing import Any, NamedTuple

from rotctl.control import Controller
from rotctl.run import simulated
from rotctl.run_folder import EncodedRun
from rotctl.same import kept
from rotctl.scenario import Making, behaviour_of
from rotctl.schema import Config
from rotctl.sweep import keep

NAMES = tuple(part.name for part in fields(Config))


class Order(NamedTuple):
    """What a worker is asked for.

    Attributes:
        parts: of the config, in the order of its fields.
        wish: when its log is kept, see `rotctl.sweep.keep`.
    """

    parts: tuple[bytes, ...]
    wish: str


def ordered(config: Config, wish: str) -> Order:
    """The task for a run."""
    return Order(tuple(_packed(getattr(config, name)) for name in NAMES), wish)


def carry_out(order: Order) -> EncodedRun:
    """Simulate a run and write nothing: a worker need not see the driver's disk.

    Raises:
        InputError: the config does not make a run.
    """
    parts: dict[str, Any] = dict(zip(NAMES, map(_unpacked, order.parts), strict=True))
    config = Config(**parts)
    return simulated(config, lambda summary: keep.kept(order.wish, summary["success"]), _SHARED)


@kept(most=1000)
def _packed(part: Any) -> bytes:
    return pickle.dumps(part, pickle.HIGHEST_PROTOCOL)


_SHARED = Making(kept(most=8)(Controller), kept(most=8)(behaviour_of))  # one run at a time
_unpacked = lru_cache(maxsize=1000)(pickle.loads)
