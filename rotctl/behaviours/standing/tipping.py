"""The way of who tips over: where the head goes, and how far it has come.

It lies across what is turned about, to the side that the target excursion has.
"""

from math import copysign, radians
from typing import NamedTuple

import numpy as np

from rotctl.behaviours import support
from rotctl.behaviours.scene import Scene
from rotctl.maths.rotations import Array, cross, dot
from rotctl.mechanics.bodies import body_ids

UP = np.array([0.0, 0.0, 1.0])


class Ways(NamedTuple):
    """Level unit vectors (3,), world: along the way, and across it, what is turned about."""

    along: Array
    across: Array


def ways(scene: Scene) -> Ways:
    """Of a behaviour that tips over to one side of what it turns about."""
    along = copysign(1.0, scene.target) * cross(scene.turning, UP)
    return Ways(along, scene.turning)


def share_of(scene: Scene, angles: tuple[float, float]) -> float:
    """How far it has turned from the one of these to the other [deg], from 0 to 1."""
    first, last = angles
    gone = copysign(1.0, scene.target) * scene.turned
    return min(max((gone - radians(first)) / radians(last - first), 0.0), 1.0)


def beyond(scene: Scene, bodies: tuple[str, ...]) -> float:
    """How far the centre of mass is beyond the middle of these bodies, along the way [m]."""
    found = body_ids(scene.model.mj, bodies)
    x, y = support.middle(support.ends(scene.model, scene.state.data, found))
    return dot(scene.state.momentum.com - np.array([x, y, 0.0]), ways(scene).along)


def rests(scene: Scene, across: Array) -> float:
    """Where along a level direction (3,) the body would come to rest [m]."""
    momentum = scene.state.momentum
    rate = support.pendulum_rate(scene.model, scene.state)
    return dot(momentum.com, across) + dot(momentum.com_velocity, across) / rate
