"""Geoms that are convex hulls: where their corners are."""

import mujoco
import numpy as np

from rotctl.caching import kept
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array


@kept(most=8)
def hulls(mj: mujoco.MjModel) -> dict[int, Array]:
    """Geoms that are hulls, with their corners (k, 3) in the geom's frame [m]."""
    every = np.flatnonzero(mj.geom_type == mujoco.mjtGeom.mjGEOM_MESH).tolist()
    return {geom: corners(mj, geom) for geom in every}


def corners(mj: mujoco.MjModel, geom: int) -> Array:
    """Corners (k, 3) of a geom that is a mesh, in the geom's frame [m]."""
    mesh = int(mj.geom_dataid[geom])
    first = int(mj.mesh_vertadr[mesh])
    return np.asarray(mj.mesh_vert[first : first + int(mj.mesh_vertnum[mesh])].astype(float))


def places(mj: mujoco.MjModel, data: mujoco.MjData, geom: int) -> Array:
    """Where a hull's corners (k, 3) are in the world [m]."""
    turned = product(hulls(mj)[geom], data.geom_xmat[geom].reshape(3, 3).T)
    return np.asarray(data.geom_xpos[geom] + turned)
