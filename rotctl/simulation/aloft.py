"""Starts high in the air, with momentum about any axis: drawn from the seed, for a flight alone."""

from dataclasses import dataclass
from math import copysign, cos, exp, log, pi, sin

import mujoco
import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import similarity
from rotctl.maths.linear import solve
from rotctl.maths.rotations import Array, quaternion_from_rotation_vector
from rotctl.mechanics.model import Model
from rotctl.mechanics.momentum import read_momentum
from rotctl.settings.fields import STRICT, Finite, Fraction, Positive, Range


@validated(frozen=True, config=STRICT)
class AloftSettings:
    """Uniform ranges of how a body is spawned in the air.

    Attributes:
        height: of the centre of mass over the ground, or the water, below it [m].
        ahead: of where starts are otherwise: beyond an edge [m].
        speed: of the centre of mass, up [m/s].
        momentum: |H| about left [kg m2/s], uniform in its logarithm; backward where both ends are
            negative.
        across: H about an axis across left, up to so much of that, whichever way it points [-].
        pose: by joint name, before joints are scattered [rad].
    """

    height: Positive
    ahead: Finite
    speed: Range
    momentum: Range
    across: Fraction
    pose: dict[str, Finite]

    def __post_init__(self) -> None:
        if self.momentum[0] * self.momentum[1] <= 0.0:
            low, high = self.momentum
            raise ValueError(
                f"momentum must keep to one side of 0, and is from {low:g} to {high:g}"
            )


UNITS = {
    AloftSettings: similarity.all_of(similarity.length, "height", "ahead")
    | similarity.all_of(similarity.speed, "speed")
    | similarity.all_of(similarity.turning, "momentum"),
}
"""Of a start high in the air, for `rotctl.behaviours.similarity`."""


@dataclass(frozen=True)
class Aloft:
    """A drawn state.

    Attributes:
        speed: up [m/s].
        angular_velocity: (3,) about the behaviour's forward, left and up [rad/s].
    """

    speed: float
    angular_velocity: Array


def draw(
    settings: AloftSettings,
    model: Model,
    pitch: float,
    pose: Array,
    generator: np.random.Generator,
) -> Aloft:
    """Draw how a body is spawned.

    Args:
        pitch: about left [rad]; pose: (nu,) [rad].
    """
    speed = float(generator.uniform(*settings.speed))
    least, most = sorted(abs(end) for end in settings.momentum)
    about_left = copysign(exp(generator.uniform(log(least), log(most))), settings.momentum[0])
    way = generator.uniform(0.0, 2.0 * pi)
    across = generator.uniform(0.0, settings.across) * abs(about_left)
    momentum = np.array([across * cos(way), about_left, across * sin(way)])
    data = mujoco.MjData(model.mj)
    data.qpos[3:7] = quaternion_from_rotation_vector(np.array([0.0, pitch, 0.0]))
    data.qpos[model.angles] = pose
    mujoco.mj_kinematics(model.mj, data)
    mujoco.mj_comPos(model.mj, data)
    mujoco.mj_makeM(model.mj, data)
    inertia = read_momentum(model.mj, data).inertia
    return Aloft(speed, solve(inertia, momentum))
