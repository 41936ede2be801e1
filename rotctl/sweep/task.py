"""Runs as a task for a worker.

The runs of a sweep differ in few parts of their configs. So the parts travel as bytes, and equal
bytes become one object again in a worker: what it has made of a part, it need not make twice.
"""

import pickle
import time
from collections.abc import Sequence
from dataclasses import fields
from functools import lru_cache
from typing import Any, NamedTuple

from rotctl.caching import kept
from rotctl.config.schema import Config
from rotctl.log import TrajectoryBuffer
from rotctl.runs.encoding import encoded
from rotctl.runs.folder import EncodedRun
from rotctl.runs.run import built, in_memory
from rotctl.runs.scenario import Scenario, shared
from rotctl.sweep import keep
from rotctl.sweep.engines import Failure, carried_out

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


def carry_out(orders: Sequence[Order]) -> list[EncodedRun | Failure]:
    """Simulate runs and write nothing: a worker need not see the driver's disk.

    First all are made, then all simulated, then all judged; see `rotctl.sweep.groups`.
    """
    runs: list[Any] = list(orders)
    for step in (_made, _simulated, _judged):
        runs = [run if isinstance(run, Failure) else carried_out(step, run) for run in runs]
    return runs


def _made(order: Order) -> tuple[Scenario, str]:
    parts: dict[str, Any] = dict(zip(NAMES, map(_unpacked, order.parts), strict=True))
    return built(Config(**parts), _SHARED), order.wish


def _simulated(made: tuple[Scenario, str]) -> tuple[Scenario, TrajectoryBuffer, str, float, str]:
    scenario, wish = made
    begin = time.perf_counter()
    buffer, ending = in_memory(scenario)
    return scenario, buffer, ending, time.perf_counter() - begin, wish


def _judged(simulated: tuple[Scenario, TrajectoryBuffer, str, float, str]) -> EncodedRun:
    scenario, buffer, ending, wall, wish = simulated
    return encoded(
        scenario, buffer, ending, wall, lambda summary: keep.kept(wish, summary["success"])
    )


@kept(most=1000)
def _packed(part: Any) -> bytes:
    return pickle.dumps(part, pickle.HIGHEST_PROTOCOL)


_SHARED = shared()
_unpacked = lru_cache(maxsize=1000)(pickle.loads)
