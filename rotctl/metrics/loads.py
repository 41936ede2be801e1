"""The contacts of a log one after the other: most of a row's slots are empty."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rotctl.maths.rotations import Array
from rotctl.metrics.columns import Arrays, slots_taken


class Loads(NamedTuple):
    """k contacts, row by row.

    Attributes:
        steps: rows of the log.
        row: (k,) of the log.
        body: (k,) its id.
        up: (k,) upward force of the ground [N].
        place: (k, 3) [m].
    """

    steps: int
    row: NDArray[np.int64]
    body: NDArray[np.int32]
    up: Array
    place: Array

    def on(self, some: NDArray[np.bool_], load: Array) -> Array:
        """What (k,) of `some` contacts (k,) adds up to in each row (steps,)."""
        return np.bincount(self.row[some], load[some], self.steps).astype(float, copy=False)


def taken(log: Arrays) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int32]]:
    """Rows, slots and bodies (k,) of all contacts of a log."""
    body = np.asarray(log["contacts/body"])[:, : slots_taken(log)]
    row, slot = np.nonzero(body >= 0)
    return row, slot, body[row, slot]


def loads(log: Arrays) -> Loads:
    """All contacts of a log."""
    row, slot, body = taken(log)
    up = np.asarray(log["contacts/force_realised"][row, slot, 2], dtype=float)
    place = np.asarray(log["contacts/position"][row, slot], dtype=float)
    return Loads(len(log["contacts/body"]), row, body, up, place)
