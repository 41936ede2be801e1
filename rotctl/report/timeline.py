"""When which body part touched the ground, as bars."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rotctl.log import RunLog
from rotctl.maths.rotations import Array
from rotctl.report.title import plain

if TYPE_CHECKING:
    import mujoco

MOST_PARTS = 40  # of a stranger's model


@dataclass(frozen=True)
class Bar:
    """A body part touches the ground without a break.

    Attributes:
        start: [s].
        duration: [s].
        used: at least one of its contacts is kept by the supervisor.
    """

    start: float
    duration: float
    used: bool


def contact_bars(log: RunLog, rows: slice, model: "mujoco.MjModel") -> dict[str, list[Bar]]:
    """Bars by the name of the body, in the model's order; bodies without a contact are left out.

    Args:
        rows: which rows of the log.
        model: the log's.
    """
    body, used = log["contacts/body"][rows], log["contacts/used"][rows]
    edges = _edges(log["trajectory/time"][rows])
    found = [int(b) for b in np.unique(body[body >= 0]) if b < model.nbody]
    bars = {}
    for part in found[:MOST_PARTS]:
        touches = body == part
        # 0: none, 1: left out, 2: used.
        state = touches.any(axis=1).astype(int) + (touches & used).any(axis=1)
        bars[plain(model.body(part).name or part)] = _bars(state, edges)
    return bars


def _edges(time: Array) -> Array:
    """Begin of every row, and the end of the last."""
    step = float(np.median(np.diff(time))) if len(time) > 1 else 0.0
    edges: Array = np.append(time, time[-1] + step)
    return edges


def _bars(state: Array, edges: Array) -> list[Bar]:
    changes = np.flatnonzero(np.diff(state)) + 1
    begins = np.concatenate([[0], changes])
    ends = np.concatenate([changes, [len(state)]])
    return [
        Bar(float(edges[a]), float(edges[b] - edges[a]), bool(state[a] == 2))
        for a, b in zip(begins, ends, strict=True)
        if state[a]
    ]
