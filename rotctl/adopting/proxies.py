"""Which shapes of a foreign model touch, where a user names them: by name, class or group."""

from fnmatch import fnmatchcase
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

from rotctl.engine import quiet
from rotctl.errors import InputError

_NAMED = 30  # of the valid ones, in a complaint


def only_these_touch(
    path: Path, root: ElementTree.Element, mj: mujoco.MjModel, wanted: tuple[str, ...]
) -> list[str]:
    """Have the named shapes of a model touch and the others of their bodies not.

    A body of which none is named keeps what it has.

    Args:
        root: of the text that `mj` was made of.
        wanted: names, `class:NAME` or `group:N`, in which `*` stands for anything.

    Returns:
        What that made of the model, one line each.

    Raises:
        InputError: one of them is no shape's; it names those that are.
    """
    titles = _titles(root, mj)
    every = sorted({title for names in titles for title in names})
    for pattern in wanted:
        if not any(fnmatchcase(title, pattern) for title in every):
            valid = ", ".join(every[:_NAMED]) + ", ..." * (len(every) > _NAMED)
            raise InputError(f"{path}: --proxies {pattern}: no such shape; its shapes: {valid}")
    chosen = [any(fnmatchcase(t, p) for t in names for p in wanted) for names in titles]
    bodies = np.unique(mj.geom_bodyid[chosen])
    for geom in np.flatnonzero(np.isin(mj.geom_bodyid, bodies)).tolist():
        mj.geom_contype[geom] = mj.geom_conaffinity[geom] = chosen[geom]
    rest = [
        mj.body(body).name
        for body in range(1, mj.nbody)
        if body not in bodies and mj.geom_contype[mj.geom_bodyid == body].any()
    ]
    one = sum(chosen) == 1
    touch = "1 shape that is named touches" if one else f"{sum(chosen)} shapes that are named touch"
    return [touch + (f"; as in the file: {', '.join(rest)}" if rest else "")]


def _titles(root: ElementTree.Element, mj: mujoco.MjModel) -> list[list[str]]:
    """By what a user may call each shape."""
    found: list[list[str]] = [[] for _ in range(mj.ngeom)]
    with quiet():
        spec = mujoco.MjSpec.from_string(ElementTree.tostring(root, encoding="unicode"))
        spec.compile()
    for geom in spec.geoms:
        name = [geom.name] if geom.name else []
        found[geom.id] = [*name, f"class:{geom.classname.name}", f"group:{geom.group}"]
    return found
