"""What a summary row's columns are called, and how metrics read a log."""

from dataclasses import dataclass
from math import atan2
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from rotctl.errors import LogError

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


def joint_rates(log: Arrays) -> NDArray[np.float64]:
    """Of the character's joints (steps, nu) [rad/s]; behind them are velocities of loose boxes."""
    joints = np.asarray(log["trajectory/ctrl"]).shape[1]
    return floats(log, "trajectory/qvel")[:, 6 : 6 + joints]


def slots_taken(log: Arrays) -> int:
    """How many slots of contacts have ever been taken; all beyond are empty."""
    taken = np.flatnonzero((np.asarray(log["contacts/body"]) >= 0).any(axis=0))
    return int(taken[-1]) + 1 if len(taken) else 0


def no_room(log: Arrays, period: float) -> str:
    """When contacts first took all slots of a row, as there may have been more; empty if never."""
    taken = np.asarray(log["contacts/body"]) >= 0
    full = np.flatnonzero(taken.all(axis=1) & (taken.size > 0))
    if not len(full):
        return ""
    return (
        f"contacts fill all {taken.size // len(taken)} slots at t = {full[0] * period:.2f} s: what "
        "else touched is not known; physics.contact_capacity makes room"
    )


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


def turns(log: Arrays) -> bool:
    """Whether the behaviour's frame turns in the course of a run."""
    axes = floats(log, "command/axes") if "command/axes" in log else np.empty((0, 3, 3))
    return len(axes) > 0 and bool((axes != axes[0]).any())


def in_frame(log: Arrays, name: str) -> NDArray[np.float64]:
    """World vectors (steps, 3) of the log along the behaviour's forward, left and up."""
    return along_frame(log, floats(log, name))


def along_frame(
    log: Arrays, vectors: NDArray[np.float64], rows: slice = slice(None)
) -> NDArray[np.float64]:
    """World vectors (n, 3) of some rows along the behaviour's forward, left and up there."""
    from rotctl.maths.linear import product  # MuJoCo's: to import it fails where MUJOCO_GL is wrong

    if not turns(log):
        return product(vectors, frame(log).T)
    x, y, z = floats(log, "command/axes")[rows].transpose(2, 0, 1)
    return vectors[:, :1] * x + vectors[:, 1:2] * y + vectors[:, 2:] * z


def nearest_places(log: Arrays) -> NDArray[np.float64]:
    """Of a way that turns the nearest place (steps, 3) [m]: what the task `linear` aims at.

    Raises:
        LogError: there is no such task.
    """
    tasks = np.asarray(log["model/task"]).tolist()
    if b"linear" not in tasks:
        raise LogError("model/task: no task linear, which tells the way that is rolled along")
    return floats(log, "command/target")[:, tasks.index(b"linear"), :3]


def along_way(log: Arrays) -> NDArray[np.float64]:
    """The centre of mass (steps, 3): how far along its way, left of it, and high [m].

    A way that turns is as long as what was travelled along it; what is left of it is the distance
    to its nearest place; NaN of a way without places, which aims at where it is.
    """
    com = in_frame(log, "trajectory/com")
    if not turns(log):
        return com
    place = floats(log, "trajectory/com")
    off = place - nearest_places(log)
    off[:, 2] = 0.0
    side = np.sign(along_frame(log, off)[:, 1]) if off.any() else np.nan
    ahead = along_frame(log, np.diff(place, axis=0), slice(0, -1))[:, 0]
    way = np.concatenate(([0.0], np.cumsum(ahead)))[: len(place)]
    return np.column_stack((way, side * np.sqrt((off**2).sum(axis=1)), com[:, 2]))
