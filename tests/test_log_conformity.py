"""A log's datasets are those of the schema, or the first that is not is named."""

import numpy as np
import pytest

from rotctl.errors import LogError
from rotctl.log.conformity import check_layout
from rotctl.log.schema import CONSTANTS, MODEL_PATH, SCHEMA

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
