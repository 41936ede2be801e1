"""Uneven ground: a smooth seeded heightfield, with scattered low bumps on it if asked for.

One field is drawn, whose two ends fit together, and laid one behind the other as often as the run
needs: a seed has the same hills whatever the duration, and an hour of them takes no more memory
than two fields. The first has the run-in.
"""

from dataclasses import dataclass
from functools import cached_property
from math import ceil
from typing import Annotated, ClassVar, Literal

import mujoco
import numpy as np
from pydantic import Field, Strict
from pydantic.dataclasses import dataclass as validated

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

LENGTH = 66.0  # [m] of a field: with what is behind the start, 20 s at the fastest
CELL = 0.15  # [m] between heights; finer ones would give the engine more contacts than it keeps
COLUMNS, ROWS = round(LENGTH / CELL) + 1, round(WIDTH / CELL) + 1
WAVES = 64  # random plane waves the field is the sum of


@validated(frozen=True, config=STRICT)
class Uneven:
    """Smooth random ground.

    Attributes:
        height: from the lowest valley to the highest hill [m].
        wavelength: of the hills [m].
        bumps: number of scattered bumps in a field; bump_height: of the highest [m].
        run_in: level ground ahead of the start before the hills are full [m].
    """

    name: str
    seeded: ClassVar[bool] = True
    endless: ClassVar[bool] = False
    kind: Literal["uneven"]
    friction: Friction
    height: Annotated[NonNegative, Field(le=1)]
    wavelength: Annotated[Positive, Field(ge=0.8, le=20)]  # some cells, and some to a field
    bumps: Annotated[int, Strict(), Field(ge=0, le=5000)]
    bump_height: Annotated[NonNegative, Field(le=0.3)]
    run_in: Annotated[NonNegative, Field(le=50)]  # within the first field
    description: str = ""

    def __post_init__(self) -> None:
        if (self.bumps > 0) != (self.bump_height > 0):
            raise ValueError("bumps and bump_height must both be 0, or neither")

    def make(self, generator: np.random.Generator, reach: float) -> "Heightfield":
        """The ground of one run that comes `reach` [m] ahead, drawn from `generator`."""
        x = np.linspace(-BEHIND, LENGTH - BEHIND, COLUMNS)
        y = np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, ROWS)
        heights = _hills(x, y, self.wavelength, generator) * self.height
        for _ in range(self.bumps):
            self._raise_bump(heights, x, y, generator)
        heights[:, -1] = heights[:, 0]  # but for rounding they are the same
        ramp = np.clip(x / max(self.run_in, CELL), 0.0, 1.0)
        fields = max(1, ceil((reach + BEHIND) / LENGTH))
        return Heightfield(self.friction, heights * ramp, heights, fields)

    def _raise_bump(
        self, heights: Array, x: Array, y: Array, generator: np.random.Generator
    ) -> None:
        """Raise `heights` (rows y, columns x) [m] to a smooth bump, 0.3 to 0.9 m in radius."""
        centre = generator.uniform((x[0], y[0]), (x[-1], y[-1]))
        radius = generator.uniform(0.3, 0.9)
        top = self.bump_height * generator.uniform(0.3, 1.0)
        along = np.mod(x - centre[0] + 0.5 * LENGTH, LENGTH) - 0.5 * LENGTH
        across = y - centre[1]
        near = np.ix_(np.abs(across) < radius, np.abs(along) < radius)
        distance = np.hypot(along[near[1]], across[near[0]]) / radius
        bump = top * np.cos(0.5 * np.pi * np.minimum(distance, 1.0)) ** 2
        heights[near] = np.maximum(heights[near], bump)


@dataclass(frozen=True)
class Heightfield:
    """Fields of heights (ROWS of y, COLUMNS of x) [m], flat within each triangle of a cell.

    Attributes:
        first: the field with the start in it.
        other: every other one.
        fields: how many there are.
    """

    friction: float
    first: Array
    other: Array
    fields: int
    slope: float = 0.0

    @cached_property
    def extent(self) -> Extent:
        """See `Ground`."""
        return Extent(-BEHIND, self.fields * LENGTH - BEHIND, 0.5 * WIDTH)

    def height(self, x: float, y: float) -> float:
        """See `Ground`."""
        return self._plane(x, y)[0]

    def normal(self, x: float, y: float) -> Array:
        """See `Ground`."""
        _, along, across = self._plane(x, y)
        normal = np.array([-along, -across, 1.0])
        return np.asarray(normal / np.sqrt((normal**2).sum()))

    def _plane(self, x: float, y: float) -> tuple[float, float, float]:
        """Height [m] at a point, and the rises along x and y of the triangle it lies in."""
        u = min(max((x + BEHIND) / CELL, 0.0), self.fields * (COLUMNS - 1) - 1e-6)
        v = min(max((y + 0.5 * WIDTH) / CELL, 0.0), ROWS - 1 - 1e-6)
        field, column = divmod(int(u), COLUMNS - 1)
        row, a, b = int(v), u - int(u), v - int(v)
        heights = self.other if field else self.first
        (h00, h01), (h10, h11) = heights[row : row + 2, column : column + 2].tolist()
        # MuJoCo cuts a cell from its corner at least x and y to the one opposite.
        along, across = (h01 - h00, h11 - h01) if a > b else (h11 - h10, h10 - h00)
        return h00 + a * along + b * across, along / CELL, across / CELL

    def add(self, spec: mujoco.MjSpec) -> None:
        """See `Ground`."""
        for i in range(self.fields):
            heights = self.other if i else self.first
            low, high = float(heights.min()), float(heights.max())
            asset = "hills" if i else "first_hills"
            if i < 2:
                span = max(high - low, 1e-6)
                spec.add_hfield(
                    name=asset,
                    nrow=ROWS,
                    ncol=COLUMNS,
                    size=[0.5 * LENGTH, 0.5 * WIDTH, span, FLOOR_DEPTH],
                    userdata=((heights - low) / span).ravel(),
                )
            add_geom(
                spec,
                f"ground_{i}",
                self.friction,
                type=mujoco.mjtGeom.mjGEOM_HFIELD,
                hfieldname=asset,
                pos=[(i + 0.5) * LENGTH - BEHIND, 0.0, low],
            )


def _hills(x: Array, y: Array, wavelength: float, generator: np.random.Generator) -> Array:
    """Sum of plane waves about that long, scaled to run from 0 to 1 (rows y, columns x).

    Along x each has a whole number of waves in a field.
    """
    number = 2.0 * np.pi / wavelength * generator.uniform(0.7, 1.3, WAVES)
    direction = generator.uniform(0.0, 2.0 * np.pi, WAVES)
    shift = generator.uniform(0.0, 2.0 * np.pi, WAVES)
    whole = 2.0 * np.pi / LENGTH
    total = np.zeros((len(y), len(x)))
    for k, angle, phase in zip(number, direction, shift, strict=True):
        along = whole * np.round(k * np.cos(angle) / whole)
        total += np.cos(along * x[None, :] + k * np.sin(angle) * y[:, None] + phase)
    return np.asarray((total - total.min()) / np.ptp(total))
