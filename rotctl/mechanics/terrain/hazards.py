"""Level ground with hazards to roll over: fixed low bars across the way, and loose boxes."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import ceil, cos, hypot, sin
from typing import Annotated, ClassVar, Literal

import mujoco
import numpy as np
from pydantic import Field, Strict
from pydantic.dataclasses import dataclass as validated

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.terrain.ground import (
    BEHIND,
    CHARACTER_CONTACT,
    GROUND_CONTACT,
    WIDTH,
    Extent,
    Friction,
    add_geom,
)
from rotctl.mechanics.terrain.plane import Plane
from rotctl.settings.fields import STRICT, HalfTurn, NonNegative, Positive, Range

FLOOR_PART = 0.05  # [m] of a bar that is below the ground
MOST_THINGS = 18_000  # an hour of one every 60 cm
MOST_BOXES = 30  # each is six more degrees of freedom of every step
BAR_COLOUR = (0.36, 0.42, 0.50, 1.0)
BOX_COLOUR = (0.80, 0.60, 0.36, 1.0)


@validated(frozen=True, config=STRICT)
class Hazards:
    """Bars and boxes, one after the other along the way, as far as the run needs.

    Attributes:
        bars, boxes: how many of either there are in each stretch, in random order.
        bar_height, bar_depth: up and along the way [m]; bars lie right across it.
        bar_turn, box_turn: largest angle against the way, to either side [rad].
        box_edge: edges of a box, each drawn by itself [m].
        box_density: [kg/m3].
        box_aside: how far from the line of travel a box may stand, to either side [m].
        spacing: from one thing to the next, on average [m].
        run_in: from the start to where the first may be [m].
    """

    name: str
    seeded: ClassVar[bool] = True
    endless: ClassVar[bool] = False
    kind: Literal["hazards"]
    friction: Friction
    bars: Annotated[int, Strict(), Field(ge=0, le=200)]
    bar_height: Range
    bar_depth: Range
    bar_turn: HalfTurn
    boxes: Annotated[int, Strict(), Field(ge=0, le=200)]
    box_edge: Range
    box_density: Positive
    box_aside: Annotated[NonNegative, Field(le=0.5 * WIDTH)]
    box_turn: HalfTurn
    spacing: Annotated[Positive, Field(ge=0.1)]
    run_in: NonNegative
    description: str = ""

    def __post_init__(self) -> None:
        if self.bar_height[0] < 0.0:
            low, high = self.bar_height
            raise ValueError(f"bar_height=[{low:g}, {high:g}]: must not be negative")
        for name, there in (("bar_depth", self.bars), ("box_edge", self.boxes)):
            low, high = getattr(self, name)
            if there and low <= 0.0:
                raise ValueError(f"{name}=[{low:g}, {high:g}]: must be more than 0")

    def make(self, generator: np.random.Generator, reach: float) -> "HazardousGround":
        """The ground of one run that comes `reach` [m] ahead, drawn from `generator`.

        Raises:
            InputError: that takes too many bars or boxes.
        """
        count = max(0, ceil((reach - self.run_in) / self.spacing))
        where = f"to x = {reach:g} m, where a run of this duration may come, at most"
        if count > MOST_THINGS:
            raise InputError(
                f"terrain.spacing={self.spacing:g}: {self.name} would be {count} things {where} "
                f"{MOST_THINGS} can be; choose a shorter duration or a larger spacing"
            )
        bars: list[Cuboid] = []
        boxes: list[Cuboid] = []
        for i, is_bar in zip(range(count), self._kinds(generator), strict=False):
            x = self.run_in + self.spacing * (i + generator.uniform(0.25, 0.75))
            if is_bar:
                depth = generator.uniform(*self.bar_depth)
                height = generator.uniform(*self.bar_height)
                turn = generator.uniform(-self.bar_turn, self.bar_turn)
                bars.append(Cuboid((x, 0.0), (depth, WIDTH, height), turn))
            else:
                y = generator.uniform(-self.box_aside, self.box_aside)
                length, width, height = generator.uniform(*self.box_edge, 3)
                turn = generator.uniform(-self.box_turn, self.box_turn)
                boxes.append(Cuboid((x, y), (length, width, height), turn))
        if len(boxes) > MOST_BOXES:
            raise InputError(
                f"terrain.boxes={self.boxes}: {self.name} would have {len(boxes)} loose boxes "
                f"{where} {MOST_BOXES} can be; choose a shorter duration or a larger spacing"
            )
        end = self.run_in + self.spacing * count
        return HazardousGround(self.friction, tuple(bars), tuple(boxes), self.box_density, end)

    def _kinds(self, generator: np.random.Generator) -> Iterator[bool]:
        """Whether each thing is a bar; a stretch is drawn when the one before is used up."""
        while self.bars + self.boxes > 0:
            yield from generator.permutation([True] * self.bars + [False] * self.boxes)


@dataclass(frozen=True)
class Cuboid:
    """A box on level ground: centre (x, y) [m], edges [m], turned by an angle about z [rad]."""

    centre: tuple[float, float]
    edges: tuple[float, float, float]
    turn: float

    def covers(self, x: float, y: float) -> bool:
        """Whether it stands on world (x, y) [m]."""
        c, s = cos(self.turn), sin(self.turn)
        dx, dy = x - self.centre[0], y - self.centre[1]
        along, across = c * dx + s * dy, c * dy - s * dx
        return abs(along) <= 0.5 * self.edges[0] and abs(across) <= 0.5 * self.edges[1]

    @property
    def quaternion(self) -> list[float]:
        """Its orientation (4,)."""
        return [cos(0.5 * self.turn), 0.0, 0.0, sin(0.5 * self.turn)]


@dataclass(frozen=True)
class HazardousGround:
    """A level plane with fixed bars, and with loose boxes that the character may push about.

    What it says of heights is of plane and bars: boxes do not stay where they are.
    """

    friction: float
    bars: tuple[Cuboid, ...]
    boxes: tuple[Cuboid, ...]
    box_density: float
    end: float
    slope: float = 0.0

    @property
    def extent(self) -> Extent:
        """See `Ground`; the plane goes on, but nothing lies on it."""
        return Extent(-BEHIND, self.end, 0.5 * WIDTH)

    @cached_property
    def _places(self) -> list[float]:
        """Where along the way the bars lie [m], in their order."""
        return [bar.centre[0] for bar in self.bars]

    @cached_property
    def _longest(self) -> float:
        """How far from its centre a bar comes at most [m]."""
        return max((0.5 * hypot(*bar.edges[:2]) for bar in self.bars), default=0.0)

    def height(self, x: float, y: float) -> float:
        """See `Ground`."""
        first = bisect_left(self._places, x - self._longest)
        last = bisect_right(self._places, x + self._longest)
        near = self.bars[first:last]
        return max((bar.edges[2] for bar in near if bar.covers(x, y)), default=0.0)

    def normal(self, x: float, y: float) -> Array:
        """See `Ground`; of a bar's top, also at its sides."""
        return np.array([0.0, 0.0, 1.0])

    def add(self, spec: mujoco.MjSpec) -> None:
        """See `Ground`."""
        Plane(self.friction, 0.0).add(spec)
        for i, bar in enumerate(self.bars):
            depth, width, height = bar.edges
            add_geom(
                spec,
                f"bar_{i}",
                self.friction,
                type=mujoco.mjtGeom.mjGEOM_BOX,
                size=[0.5 * depth, 0.5 * width, 0.5 * (height + FLOOR_PART)],
                pos=[*bar.centre, 0.5 * (height - FLOOR_PART)],
                quat=bar.quaternion,
                material="",
                rgba=BAR_COLOUR,
            )
        for i, box in enumerate(self.boxes):
            half = [0.5 * edge for edge in box.edges]
            body = spec.worldbody.add_body(
                name=f"box_{i}", pos=[*box.centre, half[2]], quat=box.quaternion
            )
            body.add_freejoint(name=f"box_{i}")
            body.add_geom(
                name=f"box_{i}",
                type=mujoco.mjtGeom.mjGEOM_BOX,
                size=half,
                density=self.box_density,
                solmix=0.0,
                friction=[self.friction, 0.0, 0.0],
                contype=GROUND_CONTACT,
                conaffinity=CHARACTER_CONTACT | GROUND_CONTACT,
                rgba=BOX_COLOUR,
            )
