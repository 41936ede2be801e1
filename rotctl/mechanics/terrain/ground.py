"""What every ground can be asked, and how it looks."""

from dataclasses import dataclass
from math import inf
from typing import Annotated, Protocol

import mujoco
from pydantic import Field

from rotctl.maths.rotations import Array
from rotctl.settings.fields import Positive

LEAST_FRICTION = float(mujoco.mjMINMU)  # [-] for which MuJoCo takes whatever is less
MOST_FRICTION = 10.0  # [-]
Friction = Annotated[Positive, Field(le=MOST_FRICTION)]  # sliding, of ground and character [-]

CHARACTER_CONTACT = 1  # contype of the character's geoms
GROUND_CONTACT = 2  # contype of the ground's geoms
FLOOR_DEPTH = 1.0  # [m] thickness of boxes; deep enough that nothing falls through
FASTEST = 3.0  # [m/s] ground is made as far ahead as a run comes at it; rolls average at most 2.3
BEHIND = 6.0  # [m] of it behind the start
WIDTH = 12.0  # [m] across the way: a metre more to either side than any criterion lets one drift


@dataclass(frozen=True)
class Extent:
    """Where there is ground: x from `begin` to `end`, `aside` to either side of y = 0 [m]."""

    begin: float = -inf
    end: float = inf
    aside: float = inf

    def has(self, x: float, y: float) -> bool:
        """Whether world (x, y) [m] is on it; no number that is not finite is."""
        return self.begin <= x <= self.end and abs(y) <= self.aside

    def __str__(self) -> str:
        return (
            f"from x = {self.begin:.4g} to {self.end:.6g} m and {self.aside:.4g} m to either side"
        )


EVERYWHERE = Extent()


class Ground(Protocol):
    """The ground of one run."""

    @property
    def slope(self) -> float:
        """Climb of the line of travel [rad]; 0 where it only goes up and down."""
        ...

    @property
    def extent(self) -> Extent:
        """Where it is; a run ends where the character leaves it."""
        ...

    def height(self, x: float, y: float) -> float:
        """Height of the ground [m] at world (x, y) [m]."""
        ...

    def normal(self, x: float, y: float) -> Array:
        """Upward unit normal (3,) of the ground at world (x, y) [m]."""
        ...

    def add(self, spec: mujoco.MjSpec) -> None:
        """Add the ground to a model in which the character is already."""
        ...


def add_tiles(spec: mujoco.MjSpec) -> None:
    """The material of all grounds: a grid of 1 m tiles, so that travel can be seen."""
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


def add_geom(spec: mujoco.MjSpec, name: str, friction: float, **shape: object) -> None:
    """Add one solid piece of ground to the world; tiled, unless `shape` says otherwise.

    A contact is as soft as the character (solmix), whose friction is the ground's.
    """
    spec.worldbody.add_geom(
        name=name,
        contype=GROUND_CONTACT,
        conaffinity=CHARACTER_CONTACT,
        solmix=0.0,
        friction=[friction, 0.0, 0.0],
        **({"material": "tiles"} | shape),
    )
