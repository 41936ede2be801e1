"""A foreign model with all that touches and weighs: bodies, joints, motors and shapes."""

from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

from rotctl.adopting.meshes import boxed
from rotctl.adopting.proxies import only_these_touch
from rotctl.errors import InputError
from rotctl.mechanics.foreign import BONES, compiled, forget_meshes, is_mesh, read_mjcf

_MOTORS = ("actuator", "motor", "general", "position", "velocity")
_SHAPES = ("inertial", "asset", "mesh")
_FILES = ("material", "hfield", "fitscale")  # of a geom, what needs more than meshes
_ACTING = {
    "equality": "equality constraints",
    "tendon": "tendons",
    "actuator": "actuators of no joint",
}
_PLACES = (
    *("body_pos", "body_quat", "body_mass", "jnt_pos", "jnt_axis", "jnt_range"),
    *("geom_pos", "geom_size"),
)
_FEATHER = {"pos": "0 0 0", "mass": "0.001", "diaginertia": "1e-6 1e-6 1e-6"}


def solid(
    path: Path, *, meshes: bool, hulls: bool = False, proxies: tuple[str, ...] = ()
) -> tuple[mujoco.MjModel, list[str]]:
    """Bodies, joints, motors and shapes with their masses.

    Args:
        meshes: whether boxes stand for them; without, they are left out.
        hulls: corners of their hulls, in place of boxes.
        proxies: which shapes touch, see `rotctl.adopting.proxies`.

    Returns:
        The model, and notes on what was left out.

    Raises:
        InputError: it is no model with hinges on a free root, or has no such proxies or no meshes.
    """
    root = read_mjcf(path)
    notes = boxed(path, root, hulls=hulls) if meshes else []
    known = {mesh.get("name", "") for mesh in root.iter("mesh") if "vertex" in mesh.attrib}
    if hulls and not (known and meshes):
        raise InputError(f"{path}: --hulls: acts on nothing, as none of its shapes is a mesh here")
    notes += _unheeded(root)
    missing = _keep_shapes(root, known if meshes else set())
    if missing:
        notes.append(f"shapes that are meshes, left out: {missing}")
    mj = compiled(path, root)
    for name in _PLACES:
        if not np.isfinite(getattr(mj, name)).all():
            raise InputError(f"{path}: {name} has NaN or infinity among its numbers")
    if mj.body_gravcomp.any():
        notes.append("gravcomp left out: all of its bodies weigh")
    if proxies:
        notes += only_these_touch(path, root, mj, proxies)
    return mj, notes


def _unheeded(root: ElementTree.Element) -> list[str]:
    """Notes on what acts on its joints in the file and will not on the character's."""
    inside = {part: [child for each in root.findall(part) for child in each] for part in _ACTING}
    inside["actuator"] = [child for child in inside["actuator"] if "joint" not in child.attrib]
    counts = {what: len(inside[part]) for part, what in _ACTING.items()}
    return [f"{what} left out: {count}" for what, count in counts.items() if count]


def _keep_shapes(root: ElementTree.Element, known: set[str]) -> int:
    """Leave out all but bodies, shapes and motors; how many meshes that were.

    Args:
        known: meshes that stay.
    """
    kept = (*BONES, *_MOTORS, *(_SHAPES if known else _SHAPES[:1]))
    waiting, meshes = [root], 0
    while waiting:
        element = waiting.pop()
        for child in list(element):
            mesh = child.tag == "geom" and is_mesh(child) and child.get("mesh") not in known
            mesh = mesh and element.tag != "default"
            meshes += mesh
            elsewhere = element.tag == "actuator" and "joint" not in child.attrib
            if child.tag not in kept or mesh or elsewhere:
                element.remove(child)
        for name in _FILES if element.tag == "geom" else ():
            element.attrib.pop(name, None)
        if element.tag == "compiler":
            element.attrib = {k: v for k, v in element.attrib.items() if not k.endswith("dir")}
        if element.tag == "body" and not any(c.tag in ("geom", "inertial") for c in element):
            ElementTree.SubElement(element, "inertial", _FEATHER)
        waiting.extend(element)
    for part in [part for part in root if part.tag == "default" and not known]:
        forget_meshes(part)
    return meshes
