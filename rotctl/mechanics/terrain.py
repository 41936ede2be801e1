"""The ground: what it looks like to the physics, and its height and normal at a point."""

from typing import Literal

import mujoco
import numpy as np
from pydantic.dataclasses import dataclass as validated

from rotctl.mechanics.character import CHARACTER_CONTACT, GROUND_CONTACT
from rotctl.rotations import Array
from rotctl.settings import STRICT, Positive


@validated(frozen=True, config=STRICT)
class Terrain:
    """The ground of a scenario.

    Attributes:
        kind: shape of the ground; only `flat` so far.
        friction: sliding friction of the ground [-]; a contact takes the larger of the
            ground's and the character's.
    """

    name: str
    kind: Literal["flat"]
    friction: Positive
    description: str = ""

    def height(self, x: float, y: float) -> float:
        """Height of the ground [m] at world (x, y) [m]."""
        return 0.0

    def normal(self, x: float, y: float) -> Array:
        """Upward unit normal (3,) of the ground at world (x, y) [m]."""
        return np.array([0.0, 0.0, 1.0])


def add_terrain(spec: mujoco.MjSpec, terrain: Terrain) -> None:
    """Add the ground, with a grid of 1 m tiles so that travel can be seen."""
    spec.add_texture(
        name="tiles",
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER,
        rgb1=[0.93, 0.94, 0.95],
        rgb2=[0.84, 0.87, 0.89],
        width=256,
        height=256,
    )
    tiles = spec.add_material(name="tiles", texrepeat=[0.5, 0.5], texuniform=True)
    tiles.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "tiles"
    spec.worldbody.add_geom(
        name="ground",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0.0, 0.0, 1.0],
        contype=GROUND_CONTACT,
        conaffinity=CHARACTER_CONTACT,
        friction=[terrain.friction, 0.0, 0.0],
        material="tiles",
    )
