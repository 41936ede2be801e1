"""Which parts come down on the ground, in their order: a list of events, read off the contacts."""

from typing import NamedTuple

import numpy as np

from rotctl.metrics.columns import Arrays, floats

APART = 0.05  # [s] a part that was off the ground for less has bounced or slid, not left it


class TouchDown(NamedTuple):
    """A part that comes down.

    Attributes:
        time: [s].
        body: its name.
    """

    time: float
    body: str


def touch_downs(log: Arrays, period: float) -> list[TouchDown]:
    """What comes down on the ground after the start, in the order of time.

    Args:
        period: of the control [s].
    """
    names = [name.decode("utf-8", "replace") for name in np.asarray(log["model/body"]).tolist()]
    bodies, time = np.asarray(log["contacts/body"]), floats(log, "trajectory/time")
    found = []
    for body in np.unique(bodies[(bodies > 0) & (bodies < len(names))]).tolist():
        rows = np.flatnonzero((bodies == body).any(axis=1))
        # Where the ground holds it at the start it has not come down.
        before = np.concatenate(([-1], rows[:-1]))
        away = (rows - before - 1) * period
        came = rows[away > np.where(before < 0, 0.0, APART)].tolist()
        found += [TouchDown(float(time[row]), names[body]) for row in came]
    return sorted(found)
