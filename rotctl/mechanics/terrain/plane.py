"""Level ground and slopes."""

from dataclasses import dataclass
from math import cos, radians, sin, tan
from typing import Annotated, ClassVar, Literal

import mujoco
import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.maths.rotations import Array
from rotctl.mechanics.terrain.ground import EVERYWHERE, Extent, Friction, add_geom
from rotctl.settings.fields import STRICT, Finite


@validated(frozen=True, config=STRICT)
class Flat:
    """Level ground; `friction` is sliding friction [-]."""

    name: str
    seeded: ClassVar[bool] = False
    endless: ClassVar[bool] = True
    kind: Literal["flat"]
    friction: Friction
    description: str = ""

    def make(self, generator: np.random.Generator, reach: float) -> "Plane":
        """The ground of one run."""
        return Plane(self.friction, 0.0)


@validated(frozen=True, config=STRICT)
class Slope:
    """A plane that climbs `angle` [deg] along +x; negative descends."""

    name: str
    seeded: ClassVar[bool] = False
    endless: ClassVar[bool] = True
    kind: Literal["slope"]
    friction: Friction
    angle: Annotated[Finite, Field(ge=-30, le=30)]
    description: str = ""

    def make(self, generator: np.random.Generator, reach: float) -> "Plane":
        """The ground of one run."""
        return Plane(self.friction, radians(self.angle))


@dataclass(frozen=True)
class Plane:
    """A plane through the origin with slope [rad] along x; MuJoCo's planes have no end."""

    friction: float
    slope: float
    extent: Extent = EVERYWHERE

    def height(self, x: float, y: float) -> float:
        """See `Ground`."""
        return x * tan(self.slope)

    def normal(self, x: float, y: float) -> Array:
        """See `Ground`."""
        return np.array([-sin(self.slope), 0.0, cos(self.slope)])

    def add(self, spec: mujoco.MjSpec) -> None:
        """See `Ground`."""
        half = -0.5 * self.slope  # about y, which turns x towards -z
        add_geom(
            spec,
            "ground",
            self.friction,
            type=mujoco.mjtGeom.mjGEOM_PLANE,
            size=[0.0, 0.0, 1.0],
            quat=[cos(half), 0.0, sin(half), 0.0],
        )
