"""The solid shapes of a foreign humanoid as capsules and spheres, and meshes as hulls."""

from collections.abc import Collection
from typing import Any, NamedTuple

import mujoco
import numpy as np

from rotctl.adopting.tree import Segment
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array, length
from rotctl.mechanics.hulls import corners

LEAST_SEEN = 0.003  # [m] radius, below which a shape is not even looked at
POINT = 0.02  # [m] radius of the ball that stands for a body without a shape, thinner than limbs
LEAST_MASS = 1e-4  # [-] of all of it: MuJoCo takes no body that moves and has no mass
_BOXES = (mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_MESH)


class Piece(NamedTuple):
    """A capsule from start to end with a radius, or a hull with its corners (k, 3); world axes."""

    start: Array
    end: Array
    radius: float
    corners: Array | None = None


def pieces(mj: mujoco.MjModel, data: mujoco.MjData, body: int, *, hulls: bool) -> list[Piece]:
    """The solid shapes of a body; where it has none, those that are only looked at."""
    solid, seen = _solid_and_seen(mj, body)
    return [piece for g in solid or seen for piece in _pieces(mj, data, g, hulls)]


def _solid_and_seen(mj: mujoco.MjModel, body: int) -> tuple[list[int], list[int]]:
    geoms = np.flatnonzero(mj.geom_bodyid == body).tolist()
    solid = [g for g in geoms if mj.geom_contype[g] or mj.geom_conaffinity[g]]
    return solid, [g for g in geoms if g not in solid]


def _pieces(mj: mujoco.MjModel, data: mujoco.MjData, g: int, hulls: bool) -> list[Piece]:
    """A geom as capsules, or a mesh as its hull."""
    centre, axes = data.geom_xpos[g].copy(), data.geom_xmat[g].reshape(3, 3).T
    size, kind = mj.geom_size[g], mujoco.mjtGeom(int(mj.geom_type[g]))
    if kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        return [Piece(centre, centre, float(size[0]))]
    if kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        half = size[1] * axes[2]
        return [Piece(centre - half, centre + half, float(size[0]))]
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        half, radius = max(float(size[1] - size[0]), 0.0) * axes[2], float(min(size[0], size[1]))
        return [Piece(centre - half, centre + half, radius)]
    if kind == mujoco.mjtGeom.mjGEOM_MESH and hulls:
        return [_hull(centre + product(corners(mj, g), axes))]
    if kind not in (*_BOXES, mujoco.mjtGeom.mjGEOM_ELLIPSOID):
        return []
    if kind == mujoco.mjtGeom.mjGEOM_MESH:  # of which there are the corners of a box
        centre, size = centre + product(axes.T, mj.geom_aabb[g, :3]), mj.geom_aabb[g, 3:]
    thin, middle, long = np.argsort(size)
    radius = float(size[thin])
    half = (size[long] - radius) * axes[long]
    beside = max(float(size[middle]) - radius, 0.0) * axes[middle]
    wide = kind in _BOXES and size[middle] > 1.3 * radius
    middles = [centre + side * beside for side in ((-1.0, 1.0) if wide else (0.0,))]
    return [Piece(place - half, place + half, radius) for place in middles]  # a plate's two edges


def _hull(corners: Array) -> Piece:
    """With the ball around it."""
    centre = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
    return Piece(centre, centre, max(length(corner - centre) for corner in corners), corners)


def stature(
    mj: mujoco.MjModel, data: mujoco.MjData, bodies: Collection[int], *, hulls: bool
) -> tuple[float, float]:
    """Lowest and highest z of the shapes of these bodies [m]."""
    found = {b: pieces(mj, data, b, hulls=hulls) for b in bodies}
    if not any(found.values()):  # meshes alone: as far as its bodies reach
        heights = data.xpos[list(bodies), 2]
        return float(heights.min()), float(heights.max())
    all_of_it = [piece for b, some in found.items() for piece in some or [_point_mass(data, b)]]
    reaches = [_reach(piece) for piece in all_of_it]
    return min(low for low, _ in reaches), max(high for _, high in reaches)


def _reach(piece: Piece) -> tuple[float, float]:
    if piece.corners is not None:
        return float(piece.corners[:, 2].min()), float(piece.corners[:, 2].max())
    low, high = sorted((piece.start[2], piece.end[2]))
    return low - piece.radius, high + piece.radius


def _point_mass(data: mujoco.MjData, body: int) -> Piece:
    """A body without a shape, which weighs all the same."""
    place = data.xipos[body]
    return Piece(place, place, POINT)


def shapes(
    mj: mujoco.MjModel, data: mujoco.MjData, segment: Segment, total: float, *, hulls: bool
) -> list[dict[str, Any]]:
    """The shapes of a body: solid ones with their shares of the whole mass by volume, and others.

    What is only looked at has no mass. Beside hulls it is left out: they are what it looks like.
    """
    mass = float(mj.body_mass[segment.body])
    solid = pieces(mj, data, segment.body, hulls=hulls)
    solid = solid or [_point_mass(data, segment.body)]
    volume = [_volume(piece) for piece in solid]
    shares = [max(mass, LEAST_MASS * total) / total * part / sum(volume) for part in volume]
    found = [
        _shape(f"{segment.name}_{k + 1}", piece, segment) | {"mass": round(share, 7)}
        for k, (piece, share) in enumerate(zip(solid, shares, strict=True))
    ]
    touching, seen = _solid_and_seen(mj, segment.body)
    looks = (
        [piece for g in seen for piece in _pieces(mj, data, g, False)]
        if touching and not hulls
        else []
    )
    return found + [
        _shape(f"{segment.name}_seen_{k + 1}", piece, segment) | {"mass": 0.0}
        for k, piece in enumerate(looks)
        if piece.radius > LEAST_SEEN
    ]


def _volume(piece: Piece) -> float:
    if piece.corners is not None:  # of what fills half of its box
        return float(0.5 * np.ptp(piece.corners, axis=0).prod())
    round_ = length(piece.end - piece.start) + 4.0 / 3.0 * piece.radius
    return np.pi * piece.radius**2 * round_


def _shape(name: str, piece: Piece, segment: Segment) -> dict[str, Any]:
    shape: dict[str, Any] = {"name": name, "size": round(piece.radius, 5)}
    shape["start"] = numbers(piece.start - segment.origin)
    if length(piece.end - piece.start) > 1e-6:
        shape["end"] = numbers(piece.end - segment.origin)
    if piece.corners is not None:
        shape["hull"] = [numbers(corner - segment.origin) for corner in piece.corners]
    return shape


def numbers(values: Any) -> list[float]:
    """Plain numbers of five decimals."""
    return [round(float(x), 5) + 0.0 for x in values]
