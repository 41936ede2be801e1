"""Short runs in groups of a task: what a step of one needs is still at hand for the next.

A worker makes the parts of all runs of a group, simulates one after the other, and judges them in
the end. After a simulation nothing of Python is left in a processor's caches: run by run, what is
beside the simulation of a second takes half as long again.
"""

from collections.abc import Generator, Sequence
from contextlib import closing

from rotctl.runs.folder import EncodedRun
from rotctl.sweep.engines import Engine, Failure
from rotctl.sweep.task import Order, carry_out

LONGEST = 8.0  # [s] of simulated time in a group, a tenth of a second's work; a longer run is alone
SHARES = 4  # of what is left for a worker, a group has at most one


def sizes(durations: Sequence[float], workers: int, most: int) -> list[int]:
    """How many of the runs make each group, in their order.

    Args:
        durations: of each run [s].
        workers: that share them.
        most: runs of a group.
    """
    found: list[int] = []
    begin = 0
    while begin < len(durations):
        fair = (len(durations) - begin) // (SHARES * max(1, workers))
        count, length = 1, durations[begin]
        while count < min(most, fair) and length + durations[begin + count] <= LONGEST:
            length += durations[begin + count]
            count += 1
        found.append(count)
        begin += count
    return found


def results(
    engine: Engine, orders: Sequence[Order], durations: Sequence[float], retries: int
) -> Generator[tuple[int, EncodedRun | Failure], None, None]:
    """(index, what became of it) of every run, in the order of their completion.

    Of a group that no worker survives nobody knows at whose hands: its runs are done one by one.
    Close it to drop what still runs.

    Args:
        durations: of each run [s].
        retries: further tries for a run whose worker died.
    """
    groups, begin = [], 0
    for count in sizes(durations, engine.workers, engine.together):
        groups.append(range(begin, begin + count))
        begin += count
    alone: list[range] = []
    for group, result in _carried_out(engine, orders, groups, retries):
        if isinstance(result, Failure) and len(group) > 1:
            alone += [range(index, index + 1) for index in group]
        else:
            yield from _told(group, result)
    for group, result in _carried_out(engine, orders, alone, retries):
        yield from _told(group, result)


Told = Sequence[EncodedRun | Failure] | Failure


def _carried_out(
    engine: Engine, orders: Sequence[Order], groups: Sequence[range], retries: int
) -> Generator[tuple[range, Told], None, None]:
    tasks = [[orders[index] for index in group] for group in groups]
    with closing(engine.map(carry_out, tasks, retries)) as found:
        for place, result in found:
            yield groups[place], result


def _told(group: range, result: Told) -> list[tuple[int, EncodedRun | Failure]]:
    results = [result] * len(group) if isinstance(result, Failure) else result
    return list(zip(group, results, strict=True))
