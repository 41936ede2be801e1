"""How a foot moves that is on its way: to be at rest in its place when its time is over."""

import mujoco
import numpy as np

from rotctl.behaviours.scene import Scene
from rotctl.linear import product
from rotctl.rotations import Array

REACH_DOWN = 0.85  # of a swing, from which on the foot
UNDER = 0.03  # [m] is wanted so far under the ground: it meets it with some speed
SOONEST = 0.05  # [s] the shortest time to go that a swing is steered with


def arrival(way: float, speed: float, time: float) -> float:
    """Acceleration [m/s2] to be at rest after a way [m] and a time [s], the least in the square."""
    return 6.0 * way / time**2 - 4.0 * speed / time


def velocity_of(scene: Scene, body: int, place: Array) -> Array:
    """Of a point of a body (3,) [m/s]."""
    jacobian = np.zeros((3, scene.model.mj.nv))
    mujoco.mj_jac(scene.model.mj, scene.state.data, jacobian, None, place, body)
    return product(jacobian, scene.state.velocity)
