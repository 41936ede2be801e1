"""Bodies of a compiled model: which are the character's, their ids, how high they reach."""

from collections.abc import Iterable
from functools import lru_cache

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.errors import InputError
from rotctl.mechanics.hulls import hulls, places
from rotctl.suggestion import meant

ROOT_BODY = 1  # MuJoCo's id: the character is the first tree
SIDES = ("_l", "_r")  # how names of limbs end


def is_character(mj: mujoco.MjModel) -> NDArray[np.bool_]:
    """(nbody,) which bodies are the character's: those of the first tree."""
    return np.asarray(mj.body_rootid == ROOT_BODY)


def lowest_and_highest(
    mj: mujoco.MjModel, data: mujoco.MjData, chosen: NDArray[np.bool_]
) -> tuple[float, float]:
    """Lowest and highest world z [m] over the chosen spheres, capsules and hulls."""
    along = np.where(
        mj.geom_type == mujoco.mjtGeom.mjGEOM_CAPSULE,
        np.abs(data.geom_xmat[:, 8]) * mj.geom_size[:, 1],
        0.0,
    )
    reach = along + mj.geom_size[:, 0]
    z = data.geom_xpos[:, 2]
    low, high = z - reach, z + reach
    for geom in hulls(mj):
        heights = places(mj, data, geom)[:, 2]
        low[geom], high[geom] = heights.min(), heights.max()
    return float(low[chosen].min()), float(high[chosen].max())


def body_ids(mj: mujoco.MjModel, names: Iterable[str], key: str = "") -> list[int]:
    """MuJoCo's ids of bodies; a name without a side stands for both sides.

    Raises:
        InputError: there is none of a name; `key` says where it stands, and is needed where the
            names have not been looked up before.
    """
    return list(_body_ids(mj, tuple(names), key))


@lru_cache(maxsize=64)  # behaviours ask at every control step
def _body_ids(mj: mujoco.MjModel, names: tuple[str, ...], key: str) -> tuple[int, ...]:
    found: list[int] = []
    for name in names:
        both = [mujoco.mj_name2id(mj, mujoco.mjtObj.mjOBJ_BODY, name + side) for side in SIDES]
        found += both if min(both) >= 1 else [body_id(mj, name, key)]
    return tuple(found)


def body_id(mj: mujoco.MjModel, name: str, key: str = "") -> int:
    """MuJoCo's id of a body of the character.

    Raises:
        InputError: there is none of that name; `key` as for `body_ids`.
    """
    number = mujoco.mj_name2id(mj, mujoco.mjtObj.mjOBJ_BODY, name)
    character = is_character(mj)  # and neither the world nor a loose box
    if number < 0 or not character[number]:
        bodies = [mj.body(int(i)).name for i in np.flatnonzero(character)]
        near = meant(name, bodies)
        names = ", ".join(bodies)
        raise InputError(f"{key} names the unknown body {name!r}; {near}bodies: {names}")
    return int(number)
