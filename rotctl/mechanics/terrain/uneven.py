"""Uneven ground: a smooth seeded heightfield, with scattered low bumps on it if asked for."""

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import mujoco
import numpy as np
from numpy.typing import NDArray
from pydantic import Field, Strict
from pydantic.dataclasses import dataclass as validated

from rotctl.linear import product
from rotctl.mechanics.terrain.ground import FLOOR_DEPTH, add_geom
from rotctl.rotations import Array
from rotctl.settings import STRICT, NonNegative, Positive

LENGTH, WIDTH = 60.0, 10.0  # [m] of the field, from 5 m behind the start
BEHIND = 5.0  # [m]
CELL = 0.1  # [m] spacing of the heights
WAVES = 64  # random plane waves the field is the sum of


@validated(frozen=True, config=STRICT)
class Uneven:
    """Smooth random ground.

    Attributes:
        height: from the lowest valley to the highest hill [m].
        wavelength: of the hills [m].
        bumps: number of scattered bumps; bump_height: of the highest [m].
        run_in: level ground ahead of the start before the hills are full [m].
    """

    name: str
    seeded: ClassVar[bool] = True
    kind: Literal["uneven"]
    friction: Positive
    height: Annotated[NonNegative, Field(le=1)]
    wavelength: Annotated[Positive, Field(ge=0.5)]
    bumps: Annotated[int, Strict(), Field(ge=0, le=5000)]
    bump_height: Annotated[NonNegative, Field(le=0.3)]
    run_in: NonNegative
    description: str = ""

    def make(self, generator: np.random.Generator) -> "Heightfield":
        """The ground of one run, drawn from `generator`."""
        x = np.arange(-BEHIND, LENGTH - BEHIND + 0.5 * CELL, CELL)
        y = np.arange(-0.5 * WIDTH, 0.5 * WIDTH + 0.5 * CELL, CELL)
        heights = _hills(x, y, self.wavelength, generator) * self.height
        for _ in range(self.bumps):
            heights = np.maximum(heights, self._bump(x, y, generator))
        ramp = np.clip(x / max(self.run_in, CELL), 0.0, 1.0)
        return Heightfield(self.friction, heights * ramp)

    def _bump(self, x: Array, y: Array, generator: np.random.Generator) -> Array:
        """One smooth bump (rows y, columns x) [m], 0.3 to 0.9 m in radius."""
        centre = generator.uniform((x[0], y[0]), (x[-1], y[-1]))
        radius = generator.uniform(0.3, 0.9)
        top = self.bump_height * generator.uniform(0.3, 1.0)
        distance = np.hypot(x[None, :] - centre[0], y[:, None] - centre[1]) / radius
        return np.asarray(top * np.cos(0.5 * np.pi * np.minimum(distance, 1.0)) ** 2)


@dataclass(frozen=True)
class Heightfield:
    """Heights (rows y, columns x) [m] on a grid of `CELL`, linear in between."""

    friction: float
    heights: NDArray[np.float64]
    slope: float = 0.0

    def height(self, x: float, y: float) -> float:
        """See `Ground`."""
        rows, columns = self.heights.shape
        u = min(max((x + BEHIND) / CELL, 0.0), columns - 1.000001)
        v = min(max((y + 0.5 * WIDTH) / CELL, 0.0), rows - 1.000001)
        i, j = int(v), int(u)
        b, a = v - i, u - j
        corner = self.heights[i : i + 2, j : j + 2]
        return float(product(np.array([1 - b, b]), corner, np.array([1 - a, a])))

    def normal(self, x: float, y: float) -> Array:
        """See `Ground`; from differences over one cell."""
        h = 0.5 * CELL
        slope_x = (self.height(x + h, y) - self.height(x - h, y)) / CELL
        slope_y = (self.height(x, y + h) - self.height(x, y - h)) / CELL
        normal = np.array([-slope_x, -slope_y, 1.0])
        return np.asarray(normal / np.sqrt(product(normal, normal)))

    def add(self, spec: mujoco.MjSpec) -> None:
        """See `Ground`."""
        low, high = float(self.heights.min()), float(self.heights.max())
        span = max(high - low, 1e-6)
        rows, columns = self.heights.shape
        spec.add_hfield(
            name="hills",
            nrow=rows,
            ncol=columns,
            size=[0.5 * LENGTH, 0.5 * WIDTH, span, FLOOR_DEPTH],
            userdata=((self.heights - low) / span).ravel(),
        )
        add_geom(
            spec,
            "ground",
            self.friction,
            type=mujoco.mjtGeom.mjGEOM_HFIELD,
            hfieldname="hills",
            pos=[0.5 * LENGTH - BEHIND, 0.0, low],
        )


def _hills(x: Array, y: Array, wavelength: float, generator: np.random.Generator) -> Array:
    """Sum of plane waves about that long, scaled to run from 0 to 1 (rows y, columns x)."""
    number = 2.0 * np.pi / wavelength * generator.uniform(0.7, 1.3, WAVES)
    direction = generator.uniform(0.0, 2.0 * np.pi, WAVES)
    shift = generator.uniform(0.0, 2.0 * np.pi, WAVES)
    total = np.zeros((len(y), len(x)))
    for k, angle, phase in zip(number, direction, shift, strict=True):
        along = k * (x[None, :] * np.cos(angle) + y[:, None] * np.sin(angle))
        total += np.cos(along + phase)
    return np.asarray((total - total.min()) / np.ptp(total))
