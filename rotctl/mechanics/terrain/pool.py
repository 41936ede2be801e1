"""A platform over water: it ends ahead of the start, and what goes over its edge falls."""

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import mujoco
import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.maths.rotations import Array
from rotctl.mechanics.terrain.ground import BEHIND, EVERYWHERE, WIDTH, Extent, Friction, add_geom
from rotctl.settings.fields import STRICT, Positive

THICKNESS = 0.25  # [m] of the platform
BASIN = 25.0  # [m] of water to either side
WATER_COLOUR = (0.16, 0.47, 0.66, 0.55)
BOTTOM_COLOUR = (0.55, 0.76, 0.84, 1.0)


@validated(frozen=True, config=STRICT)
class Pool:
    """A platform `height` [m] above water `depth` [m] deep, that ends `edge` [m] ahead.

    Attributes:
        density: of the water, and
        body: of whoever falls into it [kg/m3].
        drag, ends: coefficients of limbs across the flow, and along their length [-].
    """

    name: str
    seeded: ClassVar[bool] = False
    endless: ClassVar[bool] = True
    kind: Literal["pool"]
    friction: Friction
    height: Annotated[Positive, Field(le=30)]
    depth: Annotated[Positive, Field(le=30)]
    edge: Annotated[Positive, Field(le=5)]
    density: Annotated[Positive, Field(le=2000)]
    body: Annotated[Positive, Field(ge=500, le=2000)]
    drag: Annotated[Positive, Field(le=5)]
    ends: Annotated[Positive, Field(le=5)]
    description: str = ""

    def make(self, generator: np.random.Generator, reach: float) -> "Basin":
        """The ground of one run."""
        return Basin(
            friction=self.friction,
            drop=self.height,
            depth=self.depth,
            edge=self.edge,
            density=self.density,
            body=self.body,
            drag=self.drag,
            ends=self.ends,
        )


@dataclass(frozen=True)
class Basin:
    """The platform's top is at z = 0; nothing touches the surface of the water, only its floor."""

    friction: float
    drop: float
    depth: float
    edge: float
    density: float
    body: float
    drag: float
    ends: float
    slope: float = 0.0
    extent: Extent = EVERYWHERE

    @property
    def water(self) -> float:
        """Height of the water [m]."""
        return -self.drop

    def height(self, x: float, y: float) -> float:
        """See `Ground`: of the platform, or of the water."""
        return 0.0 if x <= self.edge else self.water

    def normal(self, x: float, y: float) -> Array:
        """See `Ground`."""
        return np.array([0.0, 0.0, 1.0])

    def add(self, spec: mujoco.MjSpec) -> None:
        """See `Ground`."""
        long = 0.5 * (self.edge + BEHIND)
        add_geom(
            spec,
            "platform",
            self.friction,
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[long, 0.25 * WIDTH, 0.5 * THICKNESS],
            pos=[self.edge - long, 0.0, -0.5 * THICKNESS],
        )
        bottom = self.water - self.depth
        add_geom(
            spec,
            "bottom",
            self.friction,
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[BASIN, BASIN, 0.5],
            pos=[0.0, 0.0, bottom - 0.5],
            material="",
            rgba=BOTTOM_COLOUR,
        )
        spec.worldbody.add_geom(
            name="water",
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[BASIN, BASIN, 0.5 * self.depth],
            pos=[0.0, 0.0, self.water - 0.5 * self.depth],
            contype=0,
            conaffinity=0,
            rgba=WATER_COLOUR,
        )
