"""How far a character is above the ground."""

import mujoco
import numpy as np

from rotctl.mechanics.bodies import is_character
from rotctl.mechanics.hulls import hulls, places
from rotctl.mechanics.model import Model


def clearance(model: Model, data: mujoco.MjData) -> float:
    """How far the character can be lowered before it touches the ground [m]; after kinematics."""
    mj, ground = model.mj, model.ground
    solid = is_character(mj)[mj.geom_bodyid] & (mj.geom_contype > 0)
    geoms = np.flatnonzero(solid & (mj.geom_type != mujoco.mjtGeom.mjGEOM_MESH))
    length = mj.geom_size[geoms, 1] * (mj.geom_type[geoms] == mujoco.mjtGeom.mjGEOM_CAPSULE)
    half = length[:, None] * data.geom_xmat[geoms, 2::3]
    ends = np.stack((data.geom_xpos[geoms] + half, data.geom_xpos[geoms] - half), axis=1)
    least = np.inf
    for radius, both in zip(mj.geom_size[geoms, 0].tolist(), ends.tolist(), strict=True):
        for x, y, z in both:
            # A sphere on the plane that touches the ground below its centre.
            upright = float(ground.normal(x, y)[2])
            least = min(least, z - ground.height(x, y) - radius / upright)
    for geom in hulls(mj):
        for x, y, z in places(mj, data, geom).tolist():
            least = min(least, z - ground.height(x, y))
    return float(least)
