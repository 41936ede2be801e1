"""The model in a log, which may come from a stranger, to a MuJoCo model that is safe to draw."""

from math import prod
from typing import TYPE_CHECKING
from xml.etree import ElementTree

from rotctl.engine import quiet
from rotctl.errors import LogError
from rotctl.log import RunLog
from rotctl.log.schema import MODEL_PATH

if TYPE_CHECKING:
    import mujoco

# What rotctl writes, and no more. Everything that reads a file (include, mesh, skin), runs
# foreign code (plugin, extension), multiplies itself (replicate, composite, flexcomp) or
# reserves memory (size) is left out. A mesh is one of corners that are in the text.
TAGS = frozenset(
    [
        "mujoco",
        "compiler",
        "option",
        "flag",
        "visual",
        "global",
        "headlight",
        "map",
        "quality",
        "rgba",
        "scale",
        "statistic",
        "default",
        "asset",
        "texture",
        "material",
        "layer",
        "hfield",
        "mesh",
        "worldbody",
        "body",
        "inertial",
        "joint",
        "freejoint",
        "geom",
        "site",
        "light",
        "camera",
        "contact",
        "pair",
        "exclude",
        "actuator",
        "general",
        "motor",
    ]
)
_OF_MESH = ("name", "vertex", "inertia")
_FILES = ("file", "meshdir", "texturedir", "assetdir", "plugin")
_SIZES = ("width", "height", "nrow", "ncol")  # of textures and height fields
MAX_SIZE = 1024
MAX_ATTRIBUTES = 50
MAX_DEPTH = 100
MOST = {
    "elements": 20_000,
    "bodies": 2000,
    "degrees of freedom": 1000,  # MuJoCo compiles with a mass matrix of this squared
    "heights and pixels": 2**20,  # of each, OpenGL keeps some 400 bytes
    "numbers of corners": 100_000,
}
MAX_BYTES = 2**30  # of the model and its data


def load(log: RunLog) -> "mujoco.MjModel":
    """Compile the model of a log.

    Raises:
        LogError: the model names files or anything else that a log has no use for, does not
            compile, or does not fit the trajectory.
    """
    import mujoco

    where = f"{log.path}: {MODEL_PATH}"
    try:
        text = checked(log.model_xml)
        with quiet() as heard:
            model = mujoco.MjModel.from_xml_string(text)
        if heard:  # of numbers that are none: rotctl writes no such model
            raise LogError(f"does not compile cleanly: {' '.join(heard[0].split()):.200}")
    except LogError as error:
        raise LogError(f"{where} {error}") from None
    except (ValueError, mujoco.FatalError) as error:
        reason = " ".join(str(error).split())
        raise LogError(f"{where} does not compile: {reason:.200}") from None
    for size, there in (("nq", model.nq), ("nv", model.nv)):
        if there != log.sizes[size]:
            raise LogError(f"{where} has {size} = {there}, the trajectory {log.sizes[size]}")
    if model.nbuffer + model.narena > MAX_BYTES:
        raise LogError(f"{where} takes more than {MAX_BYTES} bytes of memory")
    if not (model.geom_bodyid > 0).any():
        raise LogError(f"{where} has nothing that moves")
    return model


def checked(text: str) -> str:
    """The same MJCF, written anew from what was checked, so that no parser sees more.

    Raises:
        LogError: see `load`.
    """
    if text.count("<") > 3 * MOST["elements"]:  # before each takes 40 times its text in memory
        raise LogError(f"has more than {MOST['elements']} elements")
    if "<!" in text.replace("<!--", ""):
        raise LogError("has a document type; a log's model needs none")
    try:
        root = ElementTree.fromstring(text)
        _check(root)
        return ElementTree.tostring(root, encoding="unicode")
    except (ElementTree.ParseError, ValueError, RecursionError) as error:
        raise LogError(f"is not XML: {str(error) or 'nested too deeply':.200}") from None


def _check(root: ElementTree.Element) -> None:
    """Walk all elements; no recursion, since the depth is a stranger's choice too."""
    waiting = [(root, 1)]
    found = dict.fromkeys(MOST, 0)
    while waiting:
        element, depth = waiting.pop()
        if depth > MAX_DEPTH:
            raise LogError(f"is nested more than {MAX_DEPTH} deep")
        if len(element.attrib) > MAX_ATTRIBUTES:
            raise LogError(f"has more than {MAX_ATTRIBUTES} attributes in <{element.tag:.40}>")
        if element.tag not in TAGS:
            raise LogError(f"has <{element.tag:.40}>, which a log's model may not have")
        for name, value in element.attrib.items():
            if name.startswith(_FILES):
                raise LogError(
                    f"has {name:.40}={value!r:.80} in <{element.tag}>; a log's model stands alone"
                )
            if name in _SIZES and not (value.isascii() and value.isdigit() and _fits(value)):
                raise LogError(
                    f"has {name}={value!r:.40} in <{element.tag}>, valid: 0 to {MAX_SIZE}"
                )
        if element.tag == "mesh" and not {*element.attrib} <= {*_OF_MESH}:
            raise LogError("has a <mesh> of more than its corners")
        found["numbers of corners"] += len(element.get("vertex", "").split())
        found["elements"] += 1
        found["bodies"] += element.tag == "body"
        found["degrees of freedom"] += _freedom(element)
        found["heights and pixels"] += _cells(element)
        for name, most in MOST.items():
            if found[name] > most:
                raise LogError(f"has more than {most} {name}")
        waiting.extend((child, depth + 1) for child in element)


def _freedom(element: ElementTree.Element) -> int:
    """Degrees of freedom that an element may add."""
    if element.tag == "freejoint":
        return 6
    return {"free": 6, "ball": 3}.get(element.get("type", ""), 1) * (element.tag == "joint")


def _cells(element: ElementTree.Element) -> int:
    """Heights of a field, or pixels of a texture, of which a cube has six faces."""
    names = {"texture": ("width", "height"), "hfield": ("nrow", "ncol")}.get(element.tag, ())
    sides = [int(element.get(name, 0)) for name in names]
    cube = element.tag == "texture" and element.get("type") != "2d"
    return max(prod(sides), 6 * sides[0] ** 2 if cube else 0) if sides else 0


def _fits(digits: str) -> bool:
    return len(digits) <= 5 and int(digits) <= MAX_SIZE
