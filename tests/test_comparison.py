"""How values that differ between two sweeps are told."""

import pytest

from rotctl.results.comparison import Several, Some, _flat, _table

LONG = "a" * 90


def told(one, other):
    """The row of a key that has these values; empty if it is told to be the same."""
    table = _table("config", {"key": one}, {"key": other}, "one", "other")
    return " | ".join(cell.strip() for cell in table[-1].split("  ") if cell) if table[1:] else ""


def of_runs(*values):
    """A side's value of a key that its runs have these values of; None is none."""
    return _flat([{} if value is None else {"key": value} for value in values])["key"]


@pytest.mark.parametrize(
    ("one", "other", "row"),
    [
        (
            (0, 1, 2, 3, 9),
            (0, 5, 6, 7, 9),
            "key | 5 values, 0 to 9; only here: 1, 2, 3 | 5 values, 0 to 9; only here: 5, 6, 7",
        ),
        (
            (0, 1, 2, 3, 4, 5, 6, 7, 20),
            (0, 11, 12, 13, 14, 15, 16, 17, 20),
            "key | 9 values, 0 to 20; only here: 1, 2, 3, 4 and 3 more "
            "| 9 values, 0 to 20; only here: 11, 12, 13, 14 and 3 more",
        ),
        ((1.00001, 1.00002), (3,), "key | 1.00001, 1.00002 | 3"),
        ((1.00001, 2.0), (1.00002, 2.0), "key | 1.00001, 2.0 | 1.00002, 2.0"),
        ((1.00001,), (1.00002,), "key | 1.00001 | 1.00002"),
        ((1.00001, 1.1, 1.2, 1.3, 1.5), (3,), "key | 5 values, 1 to 1.5 | 3"),
        ((1.0, 1.00001, 1.00002, 1.00003, 1.00004), (3,), "key | 5 values, 1.0 to 1.00004 | 3"),
        ((1, 2, 3, 4, None), (1, 2), "key | 5 values | 1, 2"),
        ((1, None), (1,), "key | 1, - | 1"),
        ((1, 2, 3, 4, "five"), (1, 2), "key | 5 values | 1, 2"),
        (
            (*"abcd", 1),
            (*"abce", 1),
            'key | 5 values; only here: "d" | 5 values; only here: "e"',
        ),
        ((True,), (1,), "key | True | 1"),
        ((True, 1), (1,), "key | 1, True | 1"),
        ((True, 2), (1, 2), "key | 2, True | 1, 2"),
        ((1, 2), (1.0, 2.0), ""),
        ((LONG,), ("b",), f'key | "{"a" * 76}... | "b"'),
        ((LONG, LONG + "b"), ("b",), f'key | "{"a" * 76}... | "b"'),
        ((LONG,), (LONG + "b",), f'key | "{LONG}" | "{LONG}b"'),
        (
            (LONG, "b"),
            (LONG, "c"),
            f'key | "{"a" * 76}...; only here: "b" | "{"a" * 76}...; only here: "c"',
        ),
        (
            (LONG, "b"),
            (LONG, "b", "c"),
            f'key | "{"a" * 76}... | "{"a" * 76}...; only here: "c"',
        ),
    ],
)
def test_values_that_differ_are_told_so_that_one_sees_it(one, other, row):
    assert told(of_runs(*one), of_runs(*other)) == row


def test_figures_that_differ_beyond_four_digits_are_told_with_all():
    assert told((1.0, 2.00001, 3.0), (1.0, 2.00002, 3.0)) == (
        "key | 2.00001 [1.0, 3.0] | 2.00002 [1.0, 3.0]"
    )
    assert told(Some(0.50001, 3), Some(0.50002, 3)) == "key | 0.50001 of 3 | 0.50002 of 3"
    assert told(0.5, 0.25) == "key | 0.5 | 0.25"


def test_values_in_another_order_are_the_same():
    assert of_runs(3, 1) == of_runs(1, 3) == Several((1, 3))
