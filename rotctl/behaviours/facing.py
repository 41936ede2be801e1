"""Which axis a behaviour turns about, which of the trunk's axes lies on it, and its heading."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from rotctl.maths.rotations import Array, about_up, crossed, multiply, rotate
from rotctl.motion import RollAbout

UP = np.array([0.0, 0.0, 1.0])

TurnAbout = Literal["left", "up", "forward"]

Lying = Literal["across", "along"]
"""How one who lies is faced: across the way, head to the left, or along it, where its face goes as
it comes up: feet ahead on the back, head ahead on the front."""


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
        turning: (3,) the one of them that it turns about.
        trunk_axis: (3,) the trunk's that lies along it, unit, in the trunk's frame.
        orientation: (4,) of the trunk at phase 0, unit quaternion.
        mark: (3,) there the trunk's own axis whose turn is told, unit: its front, or its up where
            it turns about its front.
        marked: which of the trunk's front, left and up that is.
        column, sign: which of them lies along the axis, and whether against it.
    """

    axes: Array
    turning: Array
    trunk_axis: Array
    orientation: Array
    mark: Array
    marked: int
    column: int
    sign: float

    def axis(self, trunk_axes: Array) -> Array:
        """That axis (3,) in the world, of a trunk whose axes (3, 3) are columns."""
        return trunk_axes[:, self.column] * self.sign

    def turned(self, trunk_axes: Array) -> float:
        """How far it has turned from phase 0 [rad], within a revolution."""
        (x, y, z), now = self.mark.tolist(), trunk_axes[:, self.marked].tolist()
        across, about = crossed((x, y, z), now), self.turning.tolist()
        sine = about[0] * across[0] + about[1] * across[1] + about[2] * across[2]
        return math.atan2(sine, x * now[0] + y * now[1] + z * now[2])


def frame_of(about: RollAbout, heading: float, turn_about: TurnAbout = "left") -> Frame:
    """The frame of a behaviour.

    Args:
        about: the trunk's axis that lies to the left.
        heading: of forward, from +x towards +y [deg].
        turn_about: what it turns about; about up and about forward it stands, its left to the
            left.
    """
    facing, turn = FACING[about], about_up(math.radians(heading))
    orientation = multiply(turn, facing.orientation)
    axes = np.array([rotate(turn, axis) for axis in np.eye(3)])
    number = ("forward", "left", "up").index(turn_about)
    axis = facing.trunk_axis if turn_about == "left" else np.eye(3)[number]
    marked = 2 if turn_about == "forward" else 0
    return Frame(
        axes=axes,
        turning=axes[number],
        trunk_axis=axis,
        orientation=orientation,
        mark=rotate(orientation, np.eye(3)[marked]),
        marked=marked,
        column=int(np.abs(axis).argmax()),
        sign=float(axis.sum()),
    )


def lying(how: Lying, trunk_axes: Array) -> Frame:
    """The frame of one who lies as it lies there.

    Args:
        how: `across`, to turn about the long axis, or `along`, to turn about left.
        trunk_axes: (3, 3) columns are the trunk's front, left and up, world.
    """
    x, y = trunk_axes[:2, 2].tolist()
    head = math.degrees(math.atan2(y, x))
    if how == "across":
        return frame_of("head", head - 90.0)
    prone = float(trunk_axes[2, 0]) < 0.0
    return frame_of("left", head if prone else head + 180.0)
