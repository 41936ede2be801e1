"""The solid shapes of a foreign humanoid as capsules and spheres."""

from typing import Any

import mujoco
import numpy as np

from rotctl.adopting.tree import Segment
from rotctl.rotations import Array

_BOXES = (mujoco.mjtGeom.mjGEOM_BOX, mujoco.mjtGeom.mjGEOM_MESH)


def pieces(mj: mujoco.MjModel, data: mujoco.MjData, body: int) -> list[tuple[Array, Array, float]]:
    """The solid shapes of a body as capsules from start to end with a radius; world axes."""
    geoms = np.flatnonzero(mj.geom_bodyid == body).tolist()
    geoms = [g for g in geoms if mj.geom_contype[g] or mj.geom_conaffinity[g]] or geoms
    found = []
    for g in geoms:
        centre, axes = data.geom_xpos[g].copy(), data.geom_xmat[g].reshape(3, 3).T
        size, kind = mj.geom_size[g], mujoco.mjtGeom(int(mj.geom_type[g]))
        if kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
            found.append((centre - size[1] * axes[2], centre + size[1] * axes[2], float(size[0])))
        elif kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
            half, radius = max(float(size[1] - size[0]), 0.0), float(min(size[0], size[1]))
            found.append((centre - half * axes[2], centre + half * axes[2], radius))
        elif kind in (*_BOXES, mujoco.mjtGeom.mjGEOM_ELLIPSOID):
            if kind == mujoco.mjtGeom.mjGEOM_MESH:  # of which there are the corners of a box
                centre, size = centre + axes.T @ mj.geom_aabb[g, :3], mj.geom_aabb[g, 3:]
            thin, middle, long = np.argsort(size)
            radius = float(size[thin])
            half = (size[long] - radius) * axes[long]
            beside = max(float(size[middle]) - radius, 0.0) * axes[middle]
            wide = kind in _BOXES and size[middle] > 1.3 * radius
            for side in (-1.0, 1.0) if wide else (0.0,):  # a plate has two edges
                place = centre + side * beside
                found.append((place - half, place + half, radius))
        elif kind == mujoco.mjtGeom.mjGEOM_SPHERE:
            found.append((centre, centre, float(size[0])))
    return found


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
    """The solid shapes of a body, with their shares of the whole mass by volume."""
    solid, mass = pieces(mj, data, segment.body), float(mj.body_mass[segment.body])
    if not solid:  # it weighs all the same
        place = data.xipos[segment.body]
        solid = [(place, place, 0.02)]
    volume = [
        np.pi * radius**2 * (float(np.linalg.norm(end - start)) + 4.0 / 3.0 * radius)
        for start, end, radius in solid
    ]
    found = []
    for k, (start, end, radius) in enumerate(solid):
        shape: dict[str, Any] = {"name": f"{segment.name}_{k + 1}", "size": round(radius, 5)}
        shape["start"] = numbers(start - segment.origin)
        if np.linalg.norm(end - start) > 1e-6:
            shape["end"] = numbers(end - segment.origin)
        share = max(mass, 1e-4 * total) / total * volume[k] / sum(volume)
        found.append({**shape, "mass": round(share, 7)})
    return found


def numbers(values: Any) -> list[float]:
    """Plain numbers of five decimals."""
    return [round(float(x), 5) + 0.0 for x in values]
