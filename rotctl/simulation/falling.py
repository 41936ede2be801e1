"""Starts in the air, just above the ground, as a flight ends: drawn from the seed."""

from dataclasses import dataclass

import mujoco
import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours import similarity
from rotctl.behaviours.aerial.landing import Contact, Landing, LandingSettings
from rotctl.maths.linear import solve
from rotctl.maths.rotations import Array, quaternion_from_rotation_vector
from rotctl.mechanics.model import Model
from rotctl.mechanics.momentum import read_momentum
from rotctl.settings.fields import STRICT, NonNegative, Range

SLOWEST = 0.1  # [m/s] down, for a landing


@validated(frozen=True, config=STRICT)
class FallingSettings:
    """Uniform ranges of how a body meets the ground.

    Attributes:
        gap: of the lowest point over the ground [m].
        speed: of the centre of mass, down [m/s].
        momentum: H about left, before joints are scattered [kg m2/s].
        across: H about forward and up, either way [kg m2/s].
        offset: of the centre of mass ahead of the feet, beyond what the landing law asks for [m].
        landing: that law, and the pose.
    """

    gap: Range
    speed: Range
    momentum: Range
    across: NonNegative
    offset: Range
    landing: LandingSettings

    def __post_init__(self) -> None:
        if self.gap[0] < 0.0:
            raise ValueError(f"gap must not be negative, and may be {self.gap[0]:g} m")
        if self.speed[0] < SLOWEST:
            raise ValueError(
                f"speed must be at least {SLOWEST:g} m/s, and may be {self.speed[0]:g}"
            )


UNITS = {
    **similarity.UNITS,
    FallingSettings: similarity.all_of(similarity.length, "gap", "offset")
    | similarity.all_of(similarity.speed, "speed")
    | similarity.all_of(similarity.turning, "momentum", "across"),
}
"""Of a start in the air, for `rotctl.behaviours.similarity`."""


@dataclass(frozen=True)
class Falling:
    """A drawn state.

    Attributes:
        gap: of the lowest point over the ground [m].
        speed: down [m/s].
        angular_velocity: (3,) about the behaviour's forward, left and up [rad/s].
        contact: attitude and pose.
    """

    gap: float
    speed: float
    angular_velocity: Array
    contact: Contact


def draw(
    settings: FallingSettings, model: Model, forward: float, generator: np.random.Generator
) -> Falling:
    """Draw how a body falls that moves forward at a speed [m/s].

    Raises:
        InputError: a joint or a body of the landing is not there.
    """
    gap, speed, about_left, shift = (
        float(generator.uniform(*bounds))
        for bounds in (settings.gap, settings.speed, settings.momentum, settings.offset)
    )
    aside = generator.uniform(-settings.across, settings.across, 2)
    momentum = np.array([aside[0], about_left, aside[1]])
    landing = Landing(settings.landing, model, "start.falling.landing")
    contact = landing.at(0.0)
    for _ in range(3):  # its height hangs on where it is
        offset = landing.offset(about_left, forward, speed, contact.height)
        contact = landing.at(offset + shift)
    return Falling(gap, speed, solve(_inertia(model, contact), momentum), contact)


def _inertia(model: Model, contact: Contact) -> Array:
    """Of the whole body (3, 3), facing forward [kg m2]."""
    data = mujoco.MjData(model.mj)
    data.qpos[3:7] = quaternion_from_rotation_vector(np.array([0.0, contact.attitude, 0.0]))
    data.qpos[model.angles] = contact.pose
    mujoco.mj_kinematics(model.mj, data)
    mujoco.mj_comPos(model.mj, data)
    mujoco.mj_makeM(model.mj, data)
    return read_momentum(model.mj, data).inertia
