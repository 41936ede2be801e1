"""How a foot moves that is on its way: to be at rest in its place when its time is over."""

from math import cos, pi, sin
from typing import Protocol

import mujoco
import numpy as np

from rotctl.behaviours.scene import Scene
from rotctl.control.task import Tasks
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array

REACH_DOWN = 0.85  # of a swing, from which on the foot
UNDER = 0.03  # [m] is wanted so far under the ground: it meets it with some speed
SOONEST = 0.05  # [s] the shortest time to go that a swing is steered with


class Swing(Protocol):
    """The numbers of a foot's way."""

    @property
    def time(self) -> float:
        """That it takes [s]."""

    @property
    def lift(self) -> float:
        """In its middle [m]."""

    @property
    def height(self) -> float:
        """Of the task's point above the ground when the foot is down [m]."""


def rise(task: Tasks, scene: Scene, said: Swing, gone: float, place: Array, speed: Array) -> None:
    """Set target and velocity: up and down again over a swing, as fast as it is along the ground.

    Args:
        gone: share of the swing.
        place: of the task's point (3,) [m].
        speed: of it (3,) [m/s].
    """
    x, y, _ = place.tolist()
    over = said.lift * sin(pi * gone) - (UNDER if gone > REACH_DOWN else 0.0)
    task["target"][:3] = [x, y, scene.model.ground.height(x, y) + said.height + over]
    task["velocity"] = speed
    task["velocity"][2] = said.lift * pi / said.time * cos(pi * gone)


def arrival(way: float, speed: float, time: float) -> float:
    """Acceleration [m/s2] to be at rest after a way [m] and a time [s], the least in the square."""
    return 6.0 * way / time**2 - 4.0 * speed / time


def velocity_of(scene: Scene, body: int, place: Array) -> Array:
    """Of a point of a body (3,) [m/s]."""
    jacobian = np.zeros((3, scene.model.mj.nv))
    mujoco.mj_jac(scene.model.mj, scene.state.data, jacobian, None, place, body)
    return product(jacobian, scene.state.velocity)
