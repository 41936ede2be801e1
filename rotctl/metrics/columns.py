"""What a summary row's columns are called, and how metrics read a log."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rotctl.linear import product

Arrays = Mapping[str, NDArray[np.generic]]


@dataclass(frozen=True)
class Column:
    """A column of a summary row: its name, what it is called, its unit."""

    name: str
    title: str
    unit: str


def floats(log: Arrays, name: str) -> NDArray[np.float64]:
    """An array of the log as floats."""
    return np.asarray(log[name], dtype=float)


def frame(log: Arrays) -> NDArray[np.float64]:
    """(3, 3) rows are forward, left and up of the behaviour, world axes."""
    axes = floats(log, "command/axes") if "command/axes" in log else np.empty((0, 3, 3))
    return axes[0] if len(axes) else np.eye(3)


def in_frame(log: Arrays, name: str) -> NDArray[np.float64]:
    """World vectors (steps, 3) of the log along the behaviour's forward, left and up."""
    return product(floats(log, name), frame(log).T)
