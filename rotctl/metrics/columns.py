"""What a summary row's columns are called, and how metrics read a log."""

from dataclasses import dataclass
from math import atan2
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

ALL_FAILED = 2  # of the dataset solver/status


class Arrays(Protocol):
    """Arrays by schema path: a `RunLog`, or those of a buffer."""

    def __getitem__(self, name: str, /) -> NDArray[Any]:
        """One array."""
        ...

    def __contains__(self, name: object, /) -> bool:
        """Whether there is one of that name."""
        ...


@dataclass(frozen=True)
class Column:
    """A column of a summary row: its name, what it is called, its unit."""

    name: str
    title: str
    unit: str


def floats(log: Arrays, name: str) -> NDArray[np.float64]:
    """An array of the log as floats."""
    return np.asarray(log[name], dtype=float)


def solver_failures(log: Arrays) -> int:
    """Control steps on which every solver failed."""
    return int(np.count_nonzero(np.asarray(log["solver/status"]) == ALL_FAILED))


def frame(log: Arrays) -> NDArray[np.float64]:
    """(3, 3) rows are forward, left and up of the behaviour, world axes."""
    axes = floats(log, "command/axes") if "command/axes" in log else np.empty((0, 3, 3))
    return axes[0] if len(axes) else np.eye(3)


def heading(log: Arrays) -> float:
    """Of the behaviour's forward, from +x towards +y [rad]."""
    x, y, _ = frame(log)[0].tolist()
    return atan2(y, x)


def in_frame(log: Arrays, name: str) -> NDArray[np.float64]:
    """World vectors (steps, 3) of the log along the behaviour's forward, left and up."""
    return along_frame(log, floats(log, name))


def along_frame(log: Arrays, vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """World vectors (n, 3) along the behaviour's forward, left and up."""
    from rotctl.linear import product  # MuJoCo's: to import it fails where MUJOCO_GL is wrong

    return product(vectors, frame(log).T)
