"""The schema is complete in itself, and its check names what is wrong."""

import numpy as np
import pytest

from rotctl.errors import LogError
from rotctl.log.schema import (
    ATTRIBUTES,
    CONSTANTS,
    GROUPS,
    MODEL_PATH,
    SCHEMA,
    WRITER_ATTRIBUTES,
    check_layout,
)

SIZES = {"steps": 5, "nq": 4, "nv": 3, "nu": 2, "capacity": 6, "tasks": 7, "bodies": 8, "events": 1}


def layout(**changes):
    good = {
        name: (
            np.dtype(spec.dtype if spec.dtype != "S" else "S9"),
            tuple({**CONSTANTS, **SIZES}[dim] for dim in spec.shape),
        )
        for name, spec in SCHEMA.items()
    }
    return good | {name.replace("__", "/"): value for name, value in changes.items()}


def test_every_dataset_has_a_unit_and_a_one_line_description():
    for spec in SCHEMA.values():
        assert spec.unit
        assert spec.description
        assert "\n" not in spec.description


def test_groups_and_writer_attributes_are_part_of_the_schema():
    names = "trajectory command contacts disturbance solver events model"
    assert list(GROUPS) == names.split()
    assert set(WRITER_ATTRIBUTES) < set(ATTRIBUTES)


def test_a_good_layout_binds_the_sizes():
    assert check_layout(layout()) == SIZES


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"extra": (np.dtype("f8"), ())}, "unknown dataset 'extra'"),
        (
            {"trajectory__time": (np.dtype("f4"), (5,))},
            "trajectory/time has type float32, expected float64",
        ),
        (
            {"trajectory__time": (np.dtype(">f8"), (5,))},
            "trajectory/time has type >f8, expected float64",
        ),
        (
            {"trajectory__com": (np.dtype("f8"), (5,))},
            "trajectory/com has shape (5,), expected (steps, 3)",
        ),
        (
            {"trajectory__com": (np.dtype("f8"), (5, 2))},
            "trajectory/com has shape (5, 2), expected (steps, 3)",
        ),
        (
            {"trajectory__com": (np.dtype("f8"), None)},
            "trajectory/com has shape None, expected (steps, 3)",
        ),
        (
            {"trajectory__com": (np.dtype("f8"), (4, 3))},
            "trajectory/com has shape (4, 3), expected (steps, 3) with steps = 5",
        ),
        (
            {"model__mjcf": (np.dtype("S16777217"), ())},
            "model/mjcf is larger than 16777216 bytes",
        ),
        (
            {"trajectory__qpos": (np.dtype("f8"), (5, 10**13))},
            "declares more than 2147483648 bytes of data",
        ),
    ],
)
def test_a_bad_layout_is_named(changes, message):
    with pytest.raises(LogError) as caught:
        check_layout(layout(**changes))
    assert str(caught.value) == message


def test_a_missing_dataset_is_named():
    without = layout()
    del without[MODEL_PATH]
    with pytest.raises(LogError, match="^missing dataset 'model/mjcf'$"):
        check_layout(without)
