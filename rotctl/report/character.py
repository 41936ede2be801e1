"""The character among the bodies of a log's model: the first tree, as rotctl builds it."""

from typing import TYPE_CHECKING

import numpy as np

from rotctl.maths.rotations import Array

if TYPE_CHECKING:
    import mujoco

FORCE_SCALE = 0.45  # [m] length of an arrow as large as an adult's weight
ADULT_WEIGHT = 686.7  # [N] of 70 kg, at which other sizes of pictures are as written
ROOT_BODY = 1  # MuJoCo's id; 0 is the world


def is_limb(model: "mujoco.MjModel") -> Array:
    """(ngeom,) which geoms are the character's."""
    return np.asarray(model.body_rootid[model.geom_bodyid] == ROOT_BODY)


def centre_of_mass(data: "mujoco.MjData") -> Array:
    """(3,) the character's [m]; positions and centres of mass are up to date in `data`."""
    return np.array(data.subtree_com[ROOT_BODY])


def gravity(model: "mujoco.MjModel") -> Array:
    """(3,) its force on the character [N]."""
    return np.asarray(model.body_subtreemass[ROOT_BODY] * model.opt.gravity)


def weight(model: "mujoco.MjModel") -> float:
    """The character's [N]."""
    return float(np.linalg.norm(gravity(model)))


def size(model: "mujoco.MjModel") -> float:
    """The character's, 1 for an adult's weight [-]: what is drawn beside it keeps pace."""
    return float(np.cbrt(weight(model) / ADULT_WEIGHT)) or 1.0
