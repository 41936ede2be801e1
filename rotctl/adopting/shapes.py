"""The solid shapes of a foreign humanoid as capsules and spheres."""

from typing import Any

import mujoco
import numpy as np

from rotctl.adopting.tree import Segment
from rotctl.linear import product
from rotctl.rotations import Array, length

LEAST_SEEN = 0.003  # [m] radius, below which a shape is not even looked at
_BOXES = (mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_MESH)


Piece = tuple[Array, Array, float]  # a capsule from start to end with a radius; world axes


def pieces(mj: mujoco.MjModel, data: mujoco.MjData, body: int) -> list[Piece]:
    """The solid shapes of a body; where it has none, those that are only looked at."""
    solid, seen = _solid_and_seen(mj, body)
    return [piece for g in solid or seen for piece in _pieces(mj, data, g)]


def _solid_and_seen(mj: mujoco.MjModel, body: int) -> tuple[list[int], list[int]]:
    geoms = np.flatnonzero(mj.geom_bodyid == body).tolist()
    solid = [g for g in geoms if mj.geom_contype[g] or mj.geom_conaffinity[g]]
    return solid, [g for g in geoms if g not in solid]


def _pieces(mj: mujoco.MjModel, data: mujoco.MjData, g: int) -> list[Piece]:
    """A geom as capsules."""
    centre, axes = data.geom_xpos[g].copy(), data.geom_xmat[g].reshape(3, 3).T
    size, kind = mj.geom_size[g], mujoco.mjtGeom(int(mj.geom_type[g]))
    if kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        return [(centre, centre, float(size[0]))]
    if kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        return [(centre - size[1] * axes[2], centre + size[1] * axes[2], float(size[0]))]
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        half, radius = max(float(size[1] - size[0]), 0.0), float(min(size[0], size[1]))
        return [(centre - half * axes[2], centre + half * axes[2], radius)]
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
    return [(place - half, place + half, radius) for place in middles]  # a plate has two edges


def stature(mj: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, float]:
    """Lowest and highest z of the shapes [m]."""
    all_of_it = [piece for b in range(1, mj.nbody) for piece in pieces(mj, data, b)]
    if not all_of_it:  # meshes alone: as far as its bodies reach
        return float(data.xpos[1:, 2].min()), float(data.xpos[1:, 2].max())
    low = min(min(start[2], end[2]) - radius for start, end, radius in all_of_it)
    return low, max(max(start[2], end[2]) + radius for start, end, radius in all_of_it)


def shapes(
    mj: mujoco.MjModel, data: mujoco.MjData, segment: Segment, total: float
) -> list[dict[str, Any]]:
    """The shapes of a body: solid ones with their shares of the whole mass by volume, and others.

    What is only looked at has no mass.
    """
    solid, mass = pieces(mj, data, segment.body), float(mj.body_mass[segment.body])
    if not solid:  # it weighs all the same
        place = data.xipos[segment.body]
        solid = [(place, place, 0.02)]
    volume = [
        np.pi * radius**2 * (length(end - start) + 4.0 / 3.0 * radius)
        for start, end, radius in solid
    ]
    shares = [max(mass, 1e-4 * total) / total * part / sum(volume) for part in volume]
    found = [
        _shape(f"{segment.name}_{k + 1}", piece, segment) | {"mass": round(share, 7)}
        for k, (piece, share) in enumerate(zip(solid, shares, strict=True))
    ]
    touching, seen = _solid_and_seen(mj, segment.body)
    looks = [piece for g in seen for piece in _pieces(mj, data, g)] if touching else []
    return found + [
        _shape(f"{segment.name}_seen_{k + 1}", piece, segment) | {"mass": 0.0}
        for k, piece in enumerate(looks)
        if piece[2] > LEAST_SEEN
    ]


def _shape(name: str, piece: Piece, segment: Segment) -> dict[str, Any]:
    start, end, radius = piece
    shape: dict[str, Any] = {"name": name, "size": round(radius, 5)}
    shape["start"] = numbers(start - segment.origin)
    if length(end - start) > 1e-6:
        shape["end"] = numbers(end - segment.origin)
    return shape


def numbers(values: Any) -> list[float]:
    """Plain numbers of five decimals."""
    return [round(float(x), 5) + 0.0 for x in values]
