"""Straight stairs along the line of travel, up or down."""

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import mujoco
import numpy as np
from pydantic import Field, Strict
from pydantic.dataclasses import dataclass as validated

from rotctl.mechanics.terrain.ground import FLOOR_DEPTH, add_geom
from rotctl.rotations import Array
from rotctl.settings import STRICT, NonNegative, Positive

WIDTH = 10.0  # [m] of every step
LANDING = 30.0  # [m] length of the ground before and after the stairs


@validated(frozen=True, config=STRICT)
class Stairs:
    """`count` steps of `riser` by `tread` [m] that begin `run_in` [m] ahead of the start."""

    name: str
    seeded: ClassVar[bool] = False
    kind: Literal["stairs"]
    friction: Positive
    direction: Literal["up", "down"]
    riser: Annotated[Positive, Field(le=0.5)]
    tread: Annotated[Positive, Field(ge=0.1, le=5)]
    count: Annotated[int, Strict(), Field(ge=1, le=500)]
    run_in: NonNegative
    description: str = ""

    def make(self, generator: np.random.Generator) -> "Steps":
        """The ground of one run."""
        rise = self.riser if self.direction == "up" else -self.riser
        return Steps(self.friction, rise, self.tread, self.count, self.run_in)


@dataclass(frozen=True)
class Steps:
    """Stairs with a signed rise per step [m]; the command stays level, so `slope` is 0."""

    friction: float
    rise: float
    tread: float
    count: int
    run_in: float
    slope: float = 0.0

    def height(self, x: float, y: float) -> float:
        """See `Ground`."""
        passed = np.floor((x - self.run_in) / self.tread) + 1.0
        return float(self.rise * min(max(passed, 0.0), self.count))

    def normal(self, x: float, y: float) -> Array:
        """See `Ground`; of the tread, also at a riser."""
        return np.array([0.0, 0.0, 1.0])

    def add(self, spec: mujoco.MjSpec) -> None:
        """See `Ground`."""
        edges = [self.run_in + i * self.tread for i in range(self.count)]
        begin = [edges[0] - LANDING, *edges]
        end = [*edges, edges[-1] + LANDING]
        for i, (x0, x1) in enumerate(zip(begin, end, strict=True)):
            top = i * self.rise
            add_geom(
                spec,
                f"step_{i}",
                self.friction,
                type=mujoco.mjtGeom.mjGEOM_BOX,
                size=[0.5 * (x1 - x0), 0.5 * WIDTH, 0.5 * FLOOR_DEPTH],
                pos=[0.5 * (x0 + x1), 0.0, top - 0.5 * FLOOR_DEPTH],
            )
