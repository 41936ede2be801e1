"""MuJoCo's shapes as triangles."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.maths.rotations import Array
from rotctl.report.shapes import triangles

AROUND, DOWN = 20, 10  # segments of round shapes
FLAT = 40.0  # [m] half the side of a plane, which has none
_KIND = mujoco.mjtGeom


@dataclass(frozen=True)
class Mesh:
    """Triangles: (v, 3) vertices and unit normals, (t, 3) corners counterclockwise from outside."""

    vertices: Array
    normals: Array
    corners: NDArray[np.uint32]


def mesh_of(model: mujoco.MjModel, geom: int) -> Mesh | None:
    """The triangles of a geom in its body's frame [m]; None of a kind that is not drawn."""
    kind, size = int(model.geom_type[geom]), model.geom_size[geom]
    if kind == _KIND.mjGEOM_SPHERE:
        made = _round(size[0], 0.0)
    elif kind == _KIND.mjGEOM_CAPSULE:
        made = _round(size[0], size[1])
    elif kind == _KIND.mjGEOM_ELLIPSOID:
        ball = _round(1.0, 0.0)
        made = Mesh(ball.vertices * size, _unit(ball.normals / size), ball.corners)
    elif kind == _KIND.mjGEOM_CYLINDER:
        made = _cylinder(size[0], size[1])
    elif kind == _KIND.mjGEOM_BOX:
        made = _box(size)
    elif kind == _KIND.mjGEOM_PLANE:
        half = np.where(size[:2] > 0, size[:2], FLAT)
        made = _grid(np.zeros((2, 2)), half)
    elif kind == _KIND.mjGEOM_HFIELD:
        made = _field(model, int(model.geom_dataid[geom]))
    elif kind == _KIND.mjGEOM_MESH:
        made = _hull(model, geom)
    else:
        return None
    flat = np.empty(9)
    mujoco.mju_quat2Mat(flat, model.geom_quat[geom])
    turn = flat.reshape(3, 3)
    return Mesh(made.vertices @ turn.T + model.geom_pos[geom], made.normals @ turn.T, made.corners)


def _hull(model: mujoco.MjModel, geom: int) -> Mesh:
    """A convex hull, flat from edge to edge."""
    corners = triangles(model, geom).reshape(-1, 3)
    sides = corners.reshape(-1, 3, 3)
    normals = _unit(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]))
    order = np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)
    return Mesh(corners, np.repeat(normals, 3, axis=0), order)


def _round(radius: float, half: float) -> Mesh:
    """A sphere, or a capsule along z: rings from the top to the bottom."""
    tilt = np.linspace(0.0, np.pi, DOWN + 1)
    if half:  # the widest ring is there twice
        tilt = np.insert(tilt, DOWN // 2, np.pi / 2)
    lift = np.where(np.arange(len(tilt)) < len(tilt) / 2, half, -half) if half else 0.0 * tilt
    normals = _rings(np.sin(tilt), np.cos(tilt))
    vertices = radius * normals
    vertices[:, 2] += np.repeat(lift, AROUND + 1)
    return Mesh(vertices, normals, _strips(len(tilt), AROUND + 1))


def _cylinder(radius: float, half: float) -> Mesh:
    """Along z: a lid, the side, a lid."""
    rings = np.array([0.0, radius, radius, radius, radius, 0.0])
    height = np.array([half, half, half, -half, -half, -half])
    vertices = _rings(rings, height)
    out = _rings(np.array([0.0, 0.0, 1.0, 1.0, 0.0, 0.0]), np.array([1.0, 1.0, 0, 0, -1.0, -1.0]))
    return Mesh(vertices, out, _strips(6, AROUND + 1))


def _rings(radii: Array, heights: Array) -> Array:
    angle = np.linspace(0.0, 2.0 * np.pi, AROUND + 1)
    around = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)
    up = np.array([0.0, 0.0, 1.0])
    return np.concatenate([r * around + h * up for r, h in zip(radii, heights, strict=True)])


def _strips(rows: int, columns: int) -> NDArray[np.uint32]:
    """Triangles between the rows of a grid of vertices, the first row on top."""
    k = np.arange(rows * columns, dtype=np.uint32).reshape(rows, columns)
    a, b, c, d = k[:-1, :-1].ravel(), k[:-1, 1:].ravel(), k[1:, :-1].ravel(), k[1:, 1:].ravel()
    return np.concatenate([np.stack([a, c, d], axis=1), np.stack([a, d, b], axis=1)])


def _box(half: Array) -> Mesh:
    vertices: list[Array] = []
    normals: list[Array] = []
    corners: list[list[list[int]]] = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            u, v, w = np.roll(np.eye(3), -axis, axis=0) * half
            out = sign * np.eye(3)[axis]
            first = 4 * len(corners)
            side = [sign * u + p * v + q * w for p, q in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            vertices += side if sign > 0 else side[::-1]
            normals += [out] * 4
            corners.append([[first, first + 1, first + 2], [first, first + 2, first + 3]])
    return Mesh(
        np.array(vertices), np.array(normals), np.array(corners, dtype=np.uint32).reshape(-1, 3)
    )


def _field(model: mujoco.MjModel, field: int) -> Mesh:
    rows, columns = int(model.hfield_nrow[field]), int(model.hfield_ncol[field])
    first = int(model.hfield_adr[field])
    heights = model.hfield_data[first : first + rows * columns].reshape(rows, columns)
    size = model.hfield_size[field]
    return _grid(heights * size[2], size[:2])


def _grid(heights: Array, half: Array) -> Mesh:
    """A surface over a rectangle: rows along y, columns along x."""
    y, x = (
        np.linspace(side, -side, n) if axis == 0 else np.linspace(-side, side, n)
        for axis, (side, n) in enumerate(zip(half[::-1], heights.shape, strict=True))
    )
    heights = heights[::-1]
    slope_y = np.gradient(heights, y, axis=0)
    slope_x = np.gradient(heights, x, axis=1)
    normals = _unit(np.stack([-slope_x, -slope_y, np.ones_like(heights)], axis=-1).reshape(-1, 3))
    columns, rows = np.meshgrid(x, y)
    vertices = np.stack([columns, rows, heights], axis=-1).reshape(-1, 3)
    return Mesh(vertices, normals, _strips(*heights.shape))


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))
