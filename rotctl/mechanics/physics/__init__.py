"""The two physics, as numbers and as what they set in a model: MuJoCo's own, and lockstep."""

from typing import Annotated

from pydantic import Field

from rotctl.mechanics.physics.lockstep_physics import LockstepPhysics
from rotctl.mechanics.physics.mujoco_physics import MujocoPhysics

__all__ = ["LockstepPhysics", "MujocoPhysics", "Physics"]

Physics = Annotated[MujocoPhysics | LockstepPhysics, Field(discriminator="stepper")]
