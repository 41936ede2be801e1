"""The engine keeps `LIMIT` contacts of two geoms and drops what comes after them without a word.

On a heightfield, where each triangle of the grid makes a contact of its own, that would take the
ground from under one end of a limb. So cells must be large enough that nothing can touch so many.
"""

from math import pi, sqrt

import mujoco
import numpy as np

from rotctl.errors import InputError

LIMIT = int(mujoco.mjMAXCONPAIR)


def triangles(length: float, reach: float, cell: float) -> float:
    """Most triangles of a grid that come within `reach` of a line of that `length`, from above.

    Args:
        length: of a capsule's axis [m]; 0 for a sphere.
        reach: its radius and the margin of contacts [m].
        cell: edge of the grid's squares, each cut into two triangles [m].

    Lines cut a convex region into 1 + (lines that meet it) + (lines through it less 1, summed
    over the crossings in it) parts. Here three lines meet in each crossing; a convex region of
    area A and perimeter P holds at most A + P / 2 + 1 of them, in cells.
    """
    area = 2.0 * reach * length + pi * reach**2
    perimeter = 2.0 * length + 2.0 * pi * reach
    across = 2.0 * sqrt(2.0) * length + (4.0 + 2.0 * sqrt(2.0)) * reach  # at its worst turn
    crossings = area / cell**2 + 0.5 * perimeter / cell + 1.0
    return 1.0 + (across / cell + 3.0) + 2.0 * crossings


def check(mj: mujoco.MjModel, character: str, terrain: str) -> None:
    """See that no capsule, sphere or ball around a hull can touch too much of a heightfield.

    Raises:
        InputError: one can.
    """
    fields = np.flatnonzero(mj.geom_type == mujoco.mjtGeom.mjGEOM_HFIELD)
    solid = np.flatnonzero((mj.geom_bodyid > 0) & (mj.geom_contype > 0))
    for field in fields:
        data = mj.geom_dataid[field]
        width = 2.0 * mj.hfield_size[data, :2]
        cell = float((width / (mj.hfield_ncol[data] - 1, mj.hfield_nrow[data] - 1)).min())
        for geom in solid:
            capsule = mj.geom_type[geom] == mujoco.mjtGeom.mjGEOM_CAPSULE
            length = 2.0 * float(mj.geom_size[geom, 1]) if capsule else 0.0
            hull = mj.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH
            radius = mj.geom_rbound[geom] if hull else mj.geom_size[geom, 0]
            reach = float(radius + mj.geom_margin[geom] + mj.geom_margin[field])
            most = triangles(length, reach, cell)
            if most > LIMIT:
                raise InputError(
                    f"character {character!r} on terrain {terrain!r}: {mj.geom(int(geom)).name} "
                    f"({length:.3g} m long, reach {reach:.3g} m) could make {most:.0f} contacts "
                    f"with cells of {cell:.3g} m, MuJoCo keeps {LIMIT} of a pair; choose another "
                    "terrain, smaller geoms or a smaller physics.margin"
                )


def crowded(mj: mujoco.MjModel, data: mujoco.MjData) -> str:
    """Which geoms have as many contacts as the engine keeps; empty if none have."""
    if data.ncon < LIMIT:
        return ""
    pairs, counts = np.unique(data.contact.geom, axis=0, return_counts=True)
    full = pairs[counts >= LIMIT].tolist()
    named = ", ".join(" with ".join(mj.geom(geom).name for geom in pair) for pair in full)
    return f"{named}: {LIMIT} contacts, all that MuJoCo keeps of a pair" if full else ""
