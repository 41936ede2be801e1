"""Models from others (MJCF): the text as plain data, and the skeleton in it.

Nothing but the named file is read: no includes, no plugins, no document types; meshes and
pictures are left out, so that a skeleton needs none. A geom that is no mesh stays: it tells where
a body without children ends.
"""

from pathlib import Path
from xml.etree import ElementTree

import mujoco

from rotctl import files
from rotctl.engine import quiet
from rotctl.errors import InputError

MAX_BYTES = 4_000_000
MAX_ELEMENTS = 20_000
MAX_DEPTH = 100
# A humanoid with both hands of every finger has some 70 hinges, one with every joint of a body
# model 153; of shapes the finest have a few hundred.
MOST = {"body": 300, "joint": 200, "geom": 2000}
_RUNS = ("include", "plugin", "extension", "replicate", "composite", "flexcomp", "attach", "frame")
BONES = ("body", "joint", "freejoint", "geom", "default", "worldbody", "mujoco", "compiler")
_FILES = ("mesh", "material", "hfield", "fitscale")  # of a geom, what needs more than this file
_MEASURES = ("angle", "eulerseq", "autolimits", "coordinate")
_MASS = {"pos": "0 0 0", "mass": "1", "diaginertia": "1 1 1"}


def read_mjcf(path: Path) -> ElementTree.Element:
    """The elements of a model.

    Raises:
        InputError: one line that names the file and what it may not have.
    """
    text = files.text(path, MAX_BYTES, linked=True)
    if text.count("<") > 3 * MAX_ELEMENTS:
        raise InputError(f"{path}: has more than {MAX_ELEMENTS} elements")
    if "<!" in text.replace("<!--", ""):
        raise InputError(f"{path}: has a document type; a model needs none")
    try:
        root = ElementTree.fromstring(text)
    except (ElementTree.ParseError, ValueError, RecursionError) as error:
        raise InputError(f"{path}: is not XML: {str(error):.200}") from None
    if root.tag != "mujoco":
        what = "a URDF; save it as MJCF" if root.tag == "robot" else f"<{root.tag:.40}>"
        raise InputError(f"{path}: must be MJCF, <mujoco>; it is {what}")
    waiting = [(root, 1)]
    while waiting:
        element, depth = waiting.pop()
        if depth > MAX_DEPTH:
            raise InputError(f"{path}: is nested more than {MAX_DEPTH} deep")
        if element.tag in _RUNS:
            raise InputError(
                f"{path}: has <{element.tag}>; save the model whole, with MjSpec.to_xml()"
            )
        waiting.extend((child, depth + 1) for child in element)
    for tag, most in MOST.items():
        count = sum(1 for part in root.iter("worldbody") for _ in part.iter(tag))
        if count > most:
            raise InputError(f"{path}: has {count} <{tag}>; at most {most} can be used")
    return root


def skeleton(path: Path) -> mujoco.MjModel:
    """Bodies and joints alone, each body of some mass: for where they are, not how they move.

    Raises:
        InputError: it is no model with hinges on a free root.
    """
    root = read_mjcf(path)
    _keep_bones(root)
    return compiled(path, root)


def compiled(path: Path, root: ElementTree.Element) -> mujoco.MjModel:
    """The model of what is left of a file.

    Raises:
        InputError: it does not compile, or is no tree of hinges on a free root.
    """
    try:
        with quiet():
            model = mujoco.MjModel.from_xml_string(ElementTree.tostring(root, encoding="unicode"))
    except (ValueError, mujoco.FatalError) as error:
        reason = " ".join(str(error).split())
        raise InputError(f"{path}: does not compile: {reason:.200}") from None
    require_hinges(path, model)
    return model


def require_hinges(path: Path, model: mujoco.MjModel) -> None:
    """Check that one tree of hinges hangs on a free root.

    Raises:
        InputError: `<path>: <reason>`.
    """
    free, hinge = int(mujoco.mjtJoint.mjJNT_FREE), int(mujoco.mjtJoint.mjJNT_HINGE)
    if model.njnt < 2 or model.jnt_type[0] != free:
        raise InputError(
            f"{path}: its first joint must be the root's freejoint: a body in the worldbody with "
            "<freejoint/>"
        )
    for j in range(1, model.njnt):
        if model.jnt_type[j] != hinge:
            kind = mujoco.mjtJoint(int(model.jnt_type[j])).name.removeprefix("mjJNT_").lower()
            raise InputError(
                f"{path}: joint {model.joint(j).name!r} is a {kind} joint; only hinges can be used"
            )
        if model.body_rootid[model.jnt_bodyid[j]] != model.jnt_bodyid[0]:
            raise InputError(f"{path}: joint {model.joint(j).name!r} is not of the first tree")


def _keep_bones(root: ElementTree.Element) -> None:
    """Leave out all that says nothing on where bodies are."""
    for part in [part for part in root if part.tag == "default"]:
        forget_meshes(part)
    waiting = [root]
    while waiting:
        element = waiting.pop()
        for child in list(element):
            if child.tag not in BONES or (child.tag == "geom" and is_mesh(child)):
                element.remove(child)
        for name in _FILES if element.tag == "geom" else ():
            element.attrib.pop(name, None)
        if element.tag == "compiler":
            element.attrib = {k: v for k, v in element.attrib.items() if k in _MEASURES}
        if element.tag == "body":
            ElementTree.SubElement(element, "inertial", _MASS)
        waiting.extend(element)


def forget_meshes(defaults: ElementTree.Element) -> None:
    """Have shapes no meshes by default."""
    for geom in defaults.iter("geom"):
        if geom.get("type") in ("mesh", "hfield", "sdf"):
            del geom.attrib["type"]


def is_mesh(geom: ElementTree.Element) -> bool:
    """Whether a shape is one that needs a file."""
    return "mesh" in geom.attrib or geom.get("type") in ("mesh", "hfield", "sdf")
