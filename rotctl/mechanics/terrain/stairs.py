"""Straight stairs along the line of travel, up or down, as many steps as the run needs."""

from dataclasses import dataclass
from math import ceil, floor
from typing import Annotated, ClassVar, Literal

import mujoco
import numpy as np
from pydantic import Field
from pydantic.dataclasses import dataclass as validated

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.terrain.ground import (
    BEHIND,
    FLOOR_DEPTH,
    WIDTH,
    Extent,
    Friction,
    add_geom,
)
from rotctl.settings.fields import STRICT, NonNegative, Positive

MOST_STEPS = 18_000  # an hour of treads of 60 cm; they take 0.7 s to build and 0.1 GB


@validated(frozen=True, config=STRICT)
class Stairs:
    """Steps of `riser` by `tread` [m] that begin `run_in` [m] ahead of the start."""

    name: str
    seeded: ClassVar[bool] = False
    endless: ClassVar[bool] = False
    kind: Literal["stairs"]
    friction: Friction
    direction: Literal["up", "down"]
    riser: Annotated[Positive, Field(le=0.5)]
    tread: Annotated[Positive, Field(ge=0.1, le=5)]
    run_in: Annotated[NonNegative, Field(le=50)]
    description: str = ""

    def make(self, generator: np.random.Generator, reach: float) -> "Steps":
        """The ground of one run that comes `reach` [m] ahead.

        Raises:
            InputError: that takes too many steps.
        """
        count = max(1, ceil((reach - self.run_in) / self.tread))
        if count > MOST_STEPS:
            raise InputError(
                f"terrain.tread={self.tread:g}: {self.name} would be {count} steps to x = "
                f"{reach:g} m, where a run of this duration may come, at most {MOST_STEPS} can be; "
                "choose a shorter duration or a longer tread"
            )
        rise = self.riser if self.direction == "up" else -self.riser
        return Steps(self.friction, rise, self.tread, count, self.run_in)


@dataclass(frozen=True)
class Steps:
    """`count` steps with a signed rise each [m]; the command stays level, so `slope` is 0."""

    friction: float
    rise: float
    tread: float
    count: int
    run_in: float
    slope: float = 0.0

    @property
    def extent(self) -> Extent:
        """See `Ground`."""
        return Extent(-BEHIND, self.run_in + self.count * self.tread, 0.5 * WIDTH)

    def height(self, x: float, y: float) -> float:
        """See `Ground`."""
        passed = floor((x - self.run_in) / self.tread) + 1
        return self.rise * min(max(passed, 0), self.count)

    def normal(self, x: float, y: float) -> Array:
        """See `Ground`; of the tread, also at a riser."""
        return np.array([0.0, 0.0, 1.0])

    def add(self, spec: mujoco.MjSpec) -> None:
        """See `Ground`."""
        edges = [-BEHIND, *(self.run_in + i * self.tread for i in range(self.count + 1))]
        for i, (x0, x1) in enumerate(zip(edges, edges[1:], strict=False)):
            top = i * self.rise
            add_geom(
                spec,
                f"step_{i}",
                self.friction,
                type=mujoco.mjtGeom.mjGEOM_BOX,
                size=[0.5 * (x1 - x0), 0.5 * WIDTH, 0.5 * FLOOR_DEPTH],
                pos=[0.5 * (x0 + x1), 0.0, top - 0.5 * FLOOR_DEPTH],
            )
