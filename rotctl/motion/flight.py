"""Is the clock of a capture right? In flight the centre of mass must fall at 9.81 m/s2."""

from dataclasses import dataclass
from math import sqrt

import numpy as np

from rotctl.maths.rotations import Array
from rotctl.mechanics.model import Model
from rotctl.motion.ground import centres, heights

GRAVITY = 9.81  # [m/s2]
ADULT_LEG = 0.86  # [m] the actor's, hip to knee to ankle: no file says how tall he was
OFF_GROUND = 0.06  # [m] from there on the body flies: captures sink and float by centimetres
# [m] A flight must reach it: an error of the capture does not, nor who rolls with limbs of other
# lengths than the character has, which lift it by 0.2 m where it should lie on its back.
LEAST_HEIGHT = 0.25
LEAST_FRAMES = 5
TOLERANCE = 0.25  # of 9.81: what the actor's unknown height explains, and some more


@dataclass(frozen=True)
class Flight:
    """A time in which nothing touches the ground.

    Attributes:
        start, end: [s].
        fall: acceleration of the centre of mass, downward [m/s2].
    """

    start: float
    end: float
    fall: float

    @property
    def haste(self) -> float:
        """By how much the clock is too fast, if the fall is its fault [-]."""
        return sqrt(max(self.fall, 0.0) / GRAVITY)

    @property
    def plausible(self) -> bool:
        """Whether it falls as things do."""
        return abs(self.fall / GRAVITY - 1.0) <= TOLERANCE


def flights(model: Model, time: Array, positions: Array, leg: float) -> list[Flight]:
    """The flights of a motion, from take-off to landing.

    What the motion begins or ends with is none: a roll that a capture hangs in the air looks
    like that.

    Args:
        time: (n,) [s].
        positions: (n, nq) generalised positions.
        leg: of the character [m]; sizes are scaled back to an adult's.
    """
    low = heights(model, positions)
    low -= np.percentile(low, 20)
    flying = np.concatenate([[False], low > OFF_GROUND, [False]])
    found = []
    edges = np.flatnonzero(np.diff(flying.astype(int)))
    for start, end in zip(edges[::2] + 1, edges[1::2] - 1, strict=True):  # less the edges' frames
        if start == 1 or end == len(low) - 1:
            continue
        if end - start < LEAST_FRAMES or low[start:end].max() < LEAST_HEIGHT:
            continue
        height = centres(model, positions[start:end])[:, 2] * ADULT_LEG / leg
        curve = np.polyfit(time[start:end] - time[start], height, 2)
        found.append(Flight(float(time[start]), float(time[end - 1]), float(-2.0 * curve[0])))
    return found
