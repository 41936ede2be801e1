"""Short runs in groups of a task: how many, and what becomes of those whose group is lost."""

import pytest
from here import Here

from rotctl.config.loading import load
from rotctl.sweep.engines import Failure
from rotctl.sweep.groups import results, sizes
from rotctl.sweep.task import carry_out, ordered


def order(*overrides):
    return ordered(load(["duration=0.1", *overrides]), "never")


class Deadly(Here):
    """No worker survives a task that one of `orders` is in."""

    together = 4

    def __init__(self, *orders):
        super().__init__()
        self.orders = orders
        self.tasks = []

    def map(self, task, items, retries):
        self.tasks += [len(item) for item in items]
        self.fails = {i: "died" for i, item in enumerate(items) if set(item) & set(self.orders)}
        return super().map(task, items, retries)


@pytest.mark.parametrize(
    ("durations", "workers", "most", "expected"),
    [
        ([1.0] * 40, 1, 8, [8, 8, 6, 4, 3, 2, 2, 1, 1, 1, 1, 1, 1, 1]),
        ([1.0] * 16, 2, 8, [2, *[1] * 14]),  # no worker has much left when the other has none
        ([3.0] * 12, 1, 8, [2, 2, 2, *[1] * 6]),
        ([20.0] * 12, 1, 8, [1] * 12),
        ([1.0] * 40, 1, 1, [1] * 40),
        ([1.0, 7.5, *[1.0] * 30], 1, 8, [1, 1, 7, 5, 4, 3, 2, 2, 1, 1, 1, 1, 1, 1, 1]),
        ([], 1, 8, []),
    ],
)
def test_sizes(durations, workers, most, expected):
    assert sizes(durations, workers, most) == expected
    assert sum(expected) == len(durations)


def test_a_group_that_no_worker_survives_is_done_one_by_one():
    orders = [order(f"seed={seed}") for seed in range(20)]
    engine = Deadly(orders[2])
    found = list(results(engine, orders, [0.1] * 20, retries=0))
    assert sorted(index for index, _ in found) == list(range(20))
    assert {i: made.reason for i, made in found if isinstance(made, Failure)} == {2: "died"}
    assert engine.tasks == [4, 4, 3, 2, *[1] * 7, *[1] * 4]
    for index, made in found:
        if index != 2:
            assert made.summary["seed"] == index


def test_a_run_that_cannot_be_made_is_no_trouble_to_the_others_of_its_group():
    first, wrong, last = carry_out(
        [order("seed=1"), order("behaviour=stand", "criteria=rolling"), order("seed=2")]
    )
    assert wrong.reason.startswith("criteria=rolling does not judge behaviour=stand")
    assert (first.summary["seed"], last.summary["seed"]) == (1, 2)
