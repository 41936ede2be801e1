"""Which of the trunk's axes lies on the axis that a behaviour turns about, and its heading."""

import math
from dataclasses import dataclass

import numpy as np

from rotctl.motion import RollAbout
from rotctl.rotations import Array, about_up, crossed, multiply, rotate

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Facing:
    """How a trunk lies on the rolling axis.

    Attributes:
        trunk_axis: (3,) what it rolls about, unit, in the trunk's frame of front, left, up.
        orientation: (4,) of the trunk at phase 0, heading along +x: takes that axis to +y.
    """

    trunk_axis: Array
    orientation: Array


FACING: dict[RollAbout, Facing] = {
    "left": Facing(np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0, 0.0])),
    "right": Facing(np.array([0.0, -1.0, 0.0]), np.array([0.0, 0.0, 0.0, 1.0])),
    "head": Facing(np.array([0.0, 0.0, 1.0]), np.array([0.5, -0.5, -0.5, -0.5])),
}


@dataclass(frozen=True)
class Frame:
    """A behaviour's own frame, world axes.

    Attributes:
        axes: (3, 3) rows are forward, left and up.
        orientation: (4,) of the trunk at phase 0, unit quaternion.
        front: (3,) the trunk's front there.
        column, sign: which of the trunk's front, left and up lies along left, or against it.
    """

    axes: Array
    orientation: Array
    front: Array
    column: int
    sign: float

    def axis(self, trunk_axes: Array) -> Array:
        """That axis (3,) in the world, of a trunk whose axes (3, 3) are columns."""
        return trunk_axes[:, self.column] * self.sign

    def turned(self, trunk_axes: Array) -> float:
        """How far its front has turned about left from phase 0 [rad], within a revolution."""
        (x, y, z), now = self.front.tolist(), trunk_axes[:, 0].tolist()
        across, left = crossed((x, y, z), now), self.axes[1].tolist()
        sine = left[0] * across[0] + left[1] * across[1] + left[2] * across[2]
        return math.atan2(sine, x * now[0] + y * now[1] + z * now[2])


def frame_of(about: RollAbout, heading: float) -> Frame:
    """The frame of a behaviour that turns about one of the trunk's axes; `heading` in [deg]."""
    facing, turn = FACING[about], about_up(math.radians(heading))
    orientation = multiply(turn, facing.orientation)
    return Frame(
        axes=np.array([rotate(turn, axis) for axis in np.eye(3)]),
        orientation=orientation,
        front=rotate(orientation, np.array([1.0, 0.0, 0.0])),
        column=int(np.abs(facing.trunk_axis).argmax()),
        sign=float(facing.trunk_axis.sum()),
    )
