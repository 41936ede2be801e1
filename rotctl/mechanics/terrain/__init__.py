"""The ground: what it looks like to the physics, and its height and normal at a point."""

from typing import Annotated

from pydantic import Field

from rotctl.mechanics.terrain.ground import (
    CHARACTER_CONTACT,
    FASTEST,
    GROUND_CONTACT,
    Extent,
    Ground,
    add_tiles,
)
from rotctl.mechanics.terrain.hazards import Hazards
from rotctl.mechanics.terrain.plane import Flat, Plane, Slope
from rotctl.mechanics.terrain.pool import Basin, Pool
from rotctl.mechanics.terrain.stairs import Stairs
from rotctl.mechanics.terrain.uneven import Uneven

Terrain = Annotated[Flat | Hazards | Pool | Slope | Stairs | Uneven, Field(discriminator="kind")]

__all__ = [
    "Basin",
    "CHARACTER_CONTACT",
    "FASTEST",
    "GROUND_CONTACT",
    "Extent",
    "Flat",
    "Ground",
    "Hazards",
    "Plane",
    "Pool",
    "Slope",
    "Stairs",
    "Terrain",
    "Uneven",
    "add_tiles",
]
