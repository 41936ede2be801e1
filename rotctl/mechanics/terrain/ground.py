"""What every ground can be asked, and how it looks."""

from typing import Protocol

import mujoco

from rotctl.rotations import Array

CHARACTER_CONTACT = 1  # contype of the character's geoms
GROUND_CONTACT = 2  # contype of the ground's geoms
FLOOR_DEPTH = 1.0  # [m] thickness of boxes; deep enough that nothing falls through


class Ground(Protocol):
    """The ground of one run."""

    @property
    def slope(self) -> float:
        """Climb of the line of travel [rad]; 0 where it only goes up and down."""
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
    """Add one solid piece of ground to the world; tiled, unless `shape` says otherwise."""
    spec.worldbody.add_geom(
        name=name,
        contype=GROUND_CONTACT,
        conaffinity=CHARACTER_CONTACT,
        friction=[friction, 0.0, 0.0],
        **({"material": "tiles"} | shape),
    )
