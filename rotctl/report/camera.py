"""Directions to look in, and where world points are in a picture."""

from dataclasses import dataclass
from math import radians, tan

import numpy as np

from rotctl.maths.rotations import Array

FIELD_OF_VIEW = radians(24.0)  # vertical; narrow, so that limbs keep their lengths


@dataclass(frozen=True)
class View:
    """A direction to look in.

    Attributes:
        azimuth: of the horizontal direction, from +x to the left [rad].
        elevation: above the horizon [rad].
    """

    azimuth: float
    elevation: float

    @property
    def axes(self) -> Array:
        """Rows are the picture's right, its up and forward into it (3, 3), world."""
        ca, sa = np.cos(self.azimuth), np.sin(self.azimuth)
        ce, se = np.cos(self.elevation), np.sin(self.elevation)
        return np.array([[sa, -ca, 0.0], [-ca * se, -sa * se, ce], [ca * ce, sa * ce, se]])


SIDE = View(radians(90.0), radians(-7.0))  # along +y, so that +x is to the right; a little down
AHEAD = View(radians(150.0), radians(-16.0))  # from ahead and above, so that a long body is seen
ABOVE = View(radians(150.0), radians(-32.0))  # so that it is seen which way a lying body faces
LONG = 1.5  # times as wide across the way as along it, and a body is seen from ahead
FLAT = 0.5  # times as high as long, and it lies


@dataclass(frozen=True)
class Camera:
    """A camera that follows the character.

    Attributes:
        view: the direction it looks in.
        target: (3,) the point in the middle of the picture [m].
        distance: from there [m].
        width, height: of the picture in pixels.
    """

    view: View
    target: Array
    distance: float
    width: int
    height: int

    def pixels(self, points: Array) -> Array:
        """Where world points (..., 3) are in the picture (..., 2): x to the right, y down."""
        right, up, forward = self.view.axes
        offset = points - self.target
        scale = 0.5 * self.height / tan(0.5 * FIELD_OF_VIEW) / (offset @ forward + self.distance)
        return np.stack(
            [
                0.5 * self.width + scale * (offset @ right),
                0.5 * self.height - scale * (offset @ up),
            ],
            axis=-1,
        )
