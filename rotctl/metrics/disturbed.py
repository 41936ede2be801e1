"""What came from outside, as the log has it: a push that waits for a phase may never come."""

import math

import numpy as np

from rotctl.metrics.columns import Arrays, Column, floats

COLUMNS = (
    Column("disturbed_at", "When something from outside first pushed", "s"),
    Column("disturbed_by", "All that pushed from outside, without regard to its direction", "N s"),
)


def measure(log: Arrays, period: float) -> dict[str, float]:
    """When the first force from outside came [s], NaN if none, and the impulse of all [N s].

    Args:
        period: of the control [s].
    """
    force = floats(log, "disturbance/wrench")[:, :3]
    size = np.sqrt((force * force).sum(axis=1))
    pushed = np.flatnonzero(size)
    at = float(floats(log, "trajectory/time")[pushed[0]]) if len(pushed) else math.nan
    return {"disturbed_at": at, "disturbed_by": float(size.sum()) * period}
