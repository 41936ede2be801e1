"""A roll about an oblique axis of the trunk: over one shoulder, across the back, to the other hip.

Who rolls about its left axis goes over its head, which is furthest ahead where it is face down. Who
rolls about an axis between left and up has its right shoulder ahead there, and comes off the back
over its left hip: what bears it lies across the axis. (Towards the feet in place of the head, over
the left shoulder.) In the squat such a body leans aside.
"""

from collections.abc import Sequence
from math import cos, radians, sin
from typing import Annotated

from pydantic import Field

from rotctl.maths.rotations import Array
from rotctl.motion import FourierSeries, over_phase
from rotctl.settings.fields import Finite

Oblique = FourierSeries[Annotated[Finite, Field(ge=-60, le=60)]]
"""From the left, or right, towards the head [deg], over the phase."""


def axis(side: Array, up: Array, oblique: Sequence[float] | None, phase: float) -> Array:
    """The axis (3,) at a phase [rad], unit, between a trunk's `side` and `up` (3,), unit."""
    if oblique is None:
        return side
    tilt = radians(over_phase(oblique, phase))
    return cos(tilt) * side + sin(tilt) * up
