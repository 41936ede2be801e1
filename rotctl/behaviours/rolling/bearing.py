"""How a roll lies to the world: its frame, which may turn, and the slope along its way."""

from math import atan, cos, degrees, sin, tan
from typing import NamedTuple

from rotctl.behaviours.facing import UP, Frame, frame_of
from rotctl.maths.rotations import Array
from rotctl.motion import RollAbout


class Bearing(NamedTuple):
    """How a roll lies at one instant.

    Attributes:
        frame: forward, left and up, and where the trunk lies in them.
        left: (3,) the rolling axis, unit, world.
        slope: of the ground along the way [rad].
        way: (3,) along which it is to travel, unit, world.
    """

    frame: Frame
    left: Array
    slope: float
    way: Array


class Bearings:
    """The bearings of one roll, by how far its way has turned."""

    def __init__(self, about: RollAbout, heading: float, slope: float, aligned: bool) -> None:
        """For a roll.

        Args:
            about: the trunk's axis that lies to the left.
            heading: at first, from +x towards +y [deg].
            slope: of the ground along +x [rad].
            aligned: whether it travels along the slope, or level.
        """
        self._about: RollAbout = about
        self._heading, self._rise, self._aligned = heading, tan(slope), aligned

    def at(self, turned: float) -> Bearing:
        """That of a way that has turned from its first heading [rad]."""
        frame = frame_of(self._about, self._heading + degrees(turned))
        forward, left, _ = frame.axes
        slope = atan(self._rise * forward[0])
        along = slope if self._aligned else 0.0
        return Bearing(frame, left, slope, cos(along) * forward + sin(along) * UP)
