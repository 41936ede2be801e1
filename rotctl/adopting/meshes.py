"""Meshes of a foreign model as boxes or hulls: what of them can touch, by their vertices alone.

Only files below the model's own folder are read, and nothing but numbers out of them: MuJoCo never
sees a stranger's mesh. A box is part of a run's identity, so it is the same on every processor.
"""

import re
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np

from rotctl import files
from rotctl.errors import InputError
from rotctl.maths.linear import product
from rotctl.maths.rotations import Array, length

MAX_MESHES = 500
MAX_BYTES = 30_000_000  # of one file
MAX_WHOLE = 100_000_000  # of all of them
_HEADER, _FACET = 84, 50  # bytes of a binary STL, and of each of its triangles
_NUMBER = rb"([-+]?[0-9.]{1,40}(?:[eE][-+]?[0-9]{1,3})?)"
_VERTEX = re.compile(rb"^[ \t]*v(?:ertex)?[ \t]+" + b"[ \t]+".join([_NUMBER] * 3), re.MULTILINE)
FLAT = 2e-3  # [-] shortest edge of a box to its longest, below which a hull has no inside
CLEARLY = 1.01  # [-] by which moments differ that have axes, and a box is smaller that is taken
_GRID = [-2.0, -1.0, 0.0, 1.0, 2.0]
_DIRECTIONS = np.array(  # to the points of a grid on a cube's faces
    [[x, y, z] for x in _GRID for y in _GRID for z in _GRID if max(abs(x), abs(y), abs(z)) == 2.0]
)
_KEPT = ("name", "class", "scale", "refpos", "refquat", "vertex")


def boxed(path: Path, root: ElementTree.Element, *, hulls: bool = False) -> list[str]:
    """Give each mesh of a model the corners of its box in place of its file.

    Args:
        root: of the model at `path`; its mesh elements are changed, and go where none is read.
        hulls: corners of what is around it more closely, in place of a box.

    Returns:
        Why meshes could not be read, one line each.
    """
    folder, left, found = _folder(path, root), MAX_WHOLE, []
    number = 0
    for assets in root.iter("asset"):
        for mesh in list(assets):
            if mesh.tag != "mesh":
                assets.remove(mesh)
                continue
            number += 1
            file = mesh.get("file")
            try:
                if number > MAX_MESHES:
                    raise InputError(f"{path}: has more than {MAX_MESHES} meshes")
                if file is not None:
                    place = _inside(path.parent, folder / file)
                    content = files.read(place, min(MAX_BYTES, left), linked=False)
                    left -= len(content)
                    mesh.set("name", mesh.get("name") or Path(file).stem)
                    around = outermost if hulls else box
                    mesh.set("vertex", _text(around(vertices(place, content))))
                for name in [name for name in mesh.attrib if name not in _KEPT]:
                    del mesh.attrib[name]
            except InputError as error:
                found.append(f"{error}: left out")
                assets.remove(mesh)
    return found


def vertices(path: Path, content: bytes) -> Array:
    """The vertices (n, 3) of an STL or OBJ file, as it has them.

    Raises:
        InputError: `<path>: <reason>`.
    """
    kind = path.suffix.lower()
    if kind not in (".stl", ".obj"):
        raise InputError(f"{path}: is no .stl or .obj")
    count = int.from_bytes(content[80:84], "little") if len(content) >= _HEADER else -1
    if kind == ".stl" and len(content) == _HEADER + _FACET * count:
        facets = np.frombuffer(content, np.uint8, offset=_HEADER).reshape(-1, _FACET)
        found = facets[:, 12:48].copy().view("<f4").reshape(-1, 3).astype(float)
    else:
        try:
            numbers = (float(x) for vertex in _VERTEX.finditer(content) for x in vertex.groups())
            found = np.fromiter(numbers, float).reshape(-1, 3)
        except ValueError:
            found = np.zeros((0, 3))
    wide = np.ptp(found, axis=0).max() if len(found) else 0.0
    if not 1e-6 < wide < 1e6:  # nor anything that is no number
        raise InputError(f"{path}: has no vertices that make a shape")
    return np.asarray(found)


def box(places: Array) -> Array:
    """The corners (8, 3) of a box along the axes; as the points lie if that is clearly smaller."""
    places = np.unique(places, axis=0)  # of an STL, where many triangles meet in one
    centre = places.mean(axis=0)
    best, least = np.zeros((8, 3)), np.inf
    for axes in (np.eye(3), *_own_axes(places - centre)):
        along = product(places - centre, axes)
        low, high = along.min(axis=0), along.max(axis=0)
        thin = np.maximum(high - low, 1e-3 * max(float((high - low).max()), 1e-9))
        if CLEARLY * thin.prod() < least:
            least = float(thin.prod())
            signs = np.array(np.meshgrid(*[(-0.5, 0.5)] * 3)).reshape(3, -1).T
            best = centre + product(0.5 * (low + high) + signs * thin, axes.T)
    return np.asarray(best)


def outermost(places: Array) -> Array:
    """Of some points (n, 3) those that are farthest along 98 directions (k, 3), k at most 98.

    What is between them is what is between all of them to within a twentieth of its size. Of what
    is flat there are the corners of its box, which is not quite.
    """
    found = places[np.unique(product(places, _DIRECTIONS.T).argmax(axis=0))]
    around = box(found)
    edges = [length(around[k] - around[0]) for k in (1, 2, 4)]
    return np.asarray(around if min(edges) < FLAT * max(edges) else found)


def _own_axes(arms: Array) -> list[Array]:
    """The principal axes of points about their centre, as columns; none of what is as a ball is.

    There any axes are as good, and rounding would choose.
    """
    spread = np.array([[(one * other).sum() for other in arms.T] for one in arms.T])
    moments, axes = np.empty(3), np.empty(9)
    mujoco.mju_eig3(moments, axes, np.empty(4), (spread / spread.trace()).ravel())
    return [axes.reshape(3, 3)] if moments.max() > CLEARLY * moments.min() else []


def _folder(path: Path, root: ElementTree.Element) -> Path:
    """Where the files of meshes are named from."""
    compiler = root.find("compiler")
    named = {} if compiler is None else compiler.attrib
    return path.parent / named.get("meshdir", named.get("assetdir", ""))


def _inside(folder: Path, file: Path) -> Path:
    try:
        inside = file.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError, ValueError):  # links in a circle, names that no file can have
        inside = False
    if not inside:
        raise InputError(f"{file}: is not below the model's folder")
    return file


def _text(corners: Array) -> str:
    return " ".join(f"{x:.9g}" for x in corners.ravel())
