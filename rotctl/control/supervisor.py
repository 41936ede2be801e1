"""Ground contact supervisor, [Brown2013] section 5: which contacts may the controller use?

A first pass of the optimisation uses every contact; an inclusion test then looks at what
each contact would do, and the second pass uses the contacts that pass. The simulation
always keeps all of them.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic.dataclasses import dataclass as validated

from rotctl.rotations import Array
from rotctl.settings import STRICT, NonNegative

SupervisorName = Literal["as_written", "modified", "none"]
Mask = NDArray[np.bool_]


@validated(frozen=True, config=STRICT)
class Thresholds:
    """What a contact must show to be used: force [N], torque [N m], separation speed [m/s]."""

    force: NonNegative
    torque: NonNegative
    separation: NonNegative


@dataclass(frozen=True)
class Evidence:
    """What the first pass says of the m contacts.

    Attributes:
        force: (m,) magnitude of the contact's force [N].
        torque: (m,) magnitude of its torque about the centre of mass [N m].
        separation: (m,) current speed out of the ground [m/s].
    """

    force: Array
    torque: Array
    separation: Array


def as_written(evidence: Evidence, limits: Thresholds) -> Mask:
    """Keep a contact whose force or whose torque about the centre of mass is large enough."""
    return (evidence.force > limits.force) | (evidence.torque > limits.torque)


def modified(evidence: Evidence, limits: Thresholds) -> Mask:
    """As written, and keep every contact that is not already leaving the ground."""
    return as_written(evidence, limits) | (evidence.separation < limits.separation)


RULES: dict[str, Callable[[Evidence, Thresholds], Mask]] = {
    "as_written": as_written,
    "modified": modified,
}
