"""Starts in a state that is known to the last number, such as where an earlier run was."""

from dataclasses import dataclass, field
from math import atan2, pi, remainder, tau
from typing import Any

import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.behaviours.behaviour import Behaviour
from rotctl.maths.rotations import Array, dotted, length
from rotctl.settings.fields import SPARSE, STRICT, Finite, Positive, Vector

LEAST = 1e-3  # [-] of a quaternion's length, below which nobody knows what it is


@validated(frozen=True, config=STRICT)
class StateSettings:
    """Where a character is and how it moves, world axes, as in a log's qpos and qvel.

    Attributes:
        place: x and y of the pelvis [m].
        gap: between the lowest point and the ground [m]; negative where it has sunk in.
        orientation: of the pelvis, quaternion w, x, y, z [-]; of any length from
            `LEAST` on.
        velocity: of the pelvis [m/s].
        angular_velocity: of the pelvis, in its own frame [rad/s].
        pose: joint angles by name [rad]; those not named are 0.
        speeds: of the joints by name [rad/s]; those not named are 0.
        mass: of the character whose state it is [kg]; None says that it is any one's.
    """

    place: tuple[Finite, Finite]
    gap: Finite
    orientation: tuple[Finite, Finite, Finite, Finite]
    velocity: Vector
    angular_velocity: Vector
    pose: dict[str, Finite]
    speeds: dict[str, Finite]
    mass: Positive | None = field(default=None, metadata=SPARSE)

    def __post_init__(self) -> None:
        if dotted(self.orientation, self.orientation) < LEAST**2:
            raise ValueError(
                f"orientation: must be at least {LEAST:g} long, as 1, 0, 0, 0 is, which is upright"
            )


@dataclass(frozen=True)
class Known:
    """A known state, for a model.

    Attributes:
        settings: what is said of it.
        speeds: of its joints (nu,) [rad/s].
    """

    settings: StateSettings
    speeds: Array

    @property
    def orientation(self) -> Array:
        """Of the pelvis (4,), a unit quaternion."""
        said = np.array(self.settings.orientation)
        return said / length(said)


def pitch(known: Known, behaviour: Behaviour[Any]) -> float:
    """The pitch at which a behaviour would start nearest to this orientation [rad].

    A start at a pitch is turned by it about one axis, so that the scalar product of the two
    quaternions is a cosine of half of it.
    """
    now = known.settings.orientation
    cosine, sine = (dotted(behaviour.start(at).orientation.tolist(), now) for at in (0.0, pi))
    return remainder(2.0 * atan2(sine, cosine), tau)
