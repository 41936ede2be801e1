"""A MuJoCo model and its states as shapes and poses, for a viewer that knows no MuJoCo."""

from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from rotctl.maths.rotations import Array
from rotctl.report import character

LEFT_SHADE = 0.62  # left limbs are darker, so that turns can be told apart
_DOWN = np.array([0.0, 0.0, -1.0])
MOST_HEIGHTS = 129  # along a side of a height field; finer ones are thinned out
_KINDS = {
    int(mujoco.mjtGeom.mjGEOM_PLANE): "plane",
    int(mujoco.mjtGeom.mjGEOM_HFIELD): "hfield",
    int(mujoco.mjtGeom.mjGEOM_SPHERE): "sphere",
    int(mujoco.mjtGeom.mjGEOM_CAPSULE): "capsule",
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID): "ellipsoid",
    int(mujoco.mjtGeom.mjGEOM_CYLINDER): "cylinder",
    int(mujoco.mjtGeom.mjGEOM_BOX): "box",
    int(mujoco.mjtGeom.mjGEOM_MESH): "hull",
}


@dataclass(frozen=True)
class Poses:
    """Where the bodies that move are.

    Attributes:
        positions: (n, bodies, 3) [m].
        quaternions: (n, bodies, 4), x y z w.
        com: (n, 3) centre of mass [m].
        ground: (n,) height of the ground under it [m]; 0 beside it.
    """

    positions: Array
    quaternions: Array
    com: Array
    ground: Array


def left_geoms(model: mujoco.MjModel) -> Array:
    """(ngeom,) whether a geom is on a left limb: ``hand_l`` where there is a ``hand_r``."""
    names = [model.body(i).name for i in range(model.nbody)]
    left = [n.endswith("_l") and n.removesuffix("_l") + "_r" in names for n in names]
    return np.array(left, dtype=bool)[model.geom_bodyid]


def bodies(model: mujoco.MjModel) -> list[list[dict[str, Any]]]:
    """The shapes of every body but the world, with their colours."""
    left = left_geoms(model)
    found: list[list[dict[str, Any]]] = [[] for _ in range(model.nbody - 1)]
    for i in np.flatnonzero((model.geom_bodyid > 0) & (model.geom_rgba[:, 3] > 0)).tolist():
        material = model.geom_matid[i]
        colour = model.mat_rgba[material] if material >= 0 else model.geom_rgba[i]
        shade = LEFT_SHADE if left[i] else 1.0
        colour = [round(float(shade * part), 4) for part in colour[:3].clip(0.0, 1.0)]
        found[model.geom_bodyid[i] - 1].append(_shape(model, i) | {"colour": colour})
    return found


def triangles(model: mujoco.MjModel, geom: int) -> Array:
    """Corners (9 t,) of the triangles around a hull, three by three, in the geom's frame [m]."""
    mesh = int(model.geom_dataid[geom])
    first, sides = int(model.mesh_vertadr[mesh]), int(model.mesh_faceadr[mesh])
    faces = model.mesh_face[sides : sides + int(model.mesh_facenum[mesh])]
    return np.asarray(model.mesh_vert[first + faces].astype(float).ravel())


def world(model: mujoco.MjModel) -> list[dict[str, Any]]:
    """The shapes that do not move."""
    return [_shape(model, i) for i in np.flatnonzero(model.geom_bodyid == 0).tolist()]


def poses(model: mujoco.MjModel, states: Array) -> Poses:
    """Where the bodies are in states (n, nq), by forward kinematics alone."""
    data = mujoco.MjData(model)
    n, count = len(states), model.nbody - 1
    found = Poses(np.empty((n, count, 3)), np.empty((n, count, 4)), np.empty((n, 3)), np.empty(n))
    for i, state in enumerate(states):
        data.qpos[:] = state
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        found.positions[i] = data.xpos[1:]
        found.quaternions[i] = np.roll(data.xquat[1:], -1, axis=1)
        found.com[i] = character.centre_of_mass(data)
        found.ground[i] = height(model, data, *found.com[i, :2])
    return found


def height(model: mujoco.MjModel, data: mujoco.MjData, x: float, y: float) -> float:
    """Height of the ground at world (x, y) [m]; 0 beside it."""
    everything = np.ones(6, dtype=np.uint8)
    point = np.array([x, y, 1000.0])
    hit = np.zeros(1, dtype=np.int32)
    for _ in range(2 * model.ngeom + 1):  # a ray enters and leaves each geom once
        depth = mujoco.mj_ray(model, data, point, _DOWN, everything, 1, -1, hit)
        if depth < 0:
            return 0.0
        point[2] -= depth
        if model.geom_bodyid[hit[0]] == 0:
            return float(point[2])
        point[2] -= 1e-6
    return 0.0


def _shape(model: mujoco.MjModel, geom: int) -> dict[str, Any]:
    kind = _KINDS.get(int(model.geom_type[geom]), "sphere")
    shape = {
        "kind": kind,
        "size": _rounded(triangles(model, geom) if kind == "hull" else model.geom_size[geom]),
        "position": _rounded(model.geom_pos[geom]),
        "quaternion": _rounded(np.roll(model.geom_quat[geom], -1)),
    }
    return shape | _heights(model, model.geom_dataid[geom]) if kind == "hfield" else shape


def _heights(model: mujoco.MjModel, field: int) -> dict[str, Any]:
    rows, columns = int(model.hfield_nrow[field]), int(model.hfield_ncol[field])
    first = int(model.hfield_adr[field])
    heights = model.hfield_data[first : first + rows * columns].reshape(rows, columns)
    along = [np.linspace(0, n - 1, min(n, MOST_HEIGHTS)).round().astype(int) for n in heights.shape]
    size = model.hfield_size[field]
    thinned = heights[np.ix_(*along)] * size[2]
    return {
        "size": _rounded(size),
        "rows": thinned.shape[0],
        "columns": thinned.shape[1],
        "heights": thinned.astype(np.float32),
    }


def _rounded(values: Array) -> list[float]:
    return [round(float(value), 6) for value in values]
