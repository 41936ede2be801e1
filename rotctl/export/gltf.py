"""A run as binary glTF 2.0 (.glb): every body a node with its shapes, moved by one animation.

glTF has y up: the topmost node turns our z there. Lengths are in metres, colours are the vertices'.
"""

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from rotctl import __version__
from rotctl.export.meshes import mesh_of
from rotctl.export.movement import Movement
from rotctl.maths.rotations import Array

_FLOAT, _INDEX = 5126, 5125
_VERTICES, _CORNERS = 34962, 34963
_KINDS = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
_Z_TO_Y = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]  # x, y, z, w


class _Buffer:
    """The binary part: arrays one after the other, and what glTF says of each."""

    def __init__(self) -> None:
        self.content = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def add(self, array: NDArray[Any], target: int | None = None, bounds: bool = False) -> int:
        """Store an array (n,) or (n, k); returns its number."""
        whole = target == _CORNERS
        packed = np.ascontiguousarray(array, dtype="<u4" if whole else "<f4")
        view = {"buffer": 0, "byteOffset": len(self.content), "byteLength": packed.nbytes}
        self.views.append(view | ({"target": target} if target else {}))
        accessor = {
            "bufferView": len(self.views) - 1,
            "componentType": _INDEX if whole else _FLOAT,
            "count": packed.size if whole else len(packed),
            "type": _KINDS[1 if whole or packed.ndim == 1 else packed.shape[1]],
        }
        if bounds:
            least, most = packed.min(axis=0), packed.max(axis=0)
            accessor |= {"min": least.reshape(-1).tolist(), "max": most.reshape(-1).tolist()}
        self.accessors.append(accessor)
        self.content += packed.tobytes()
        return len(self.accessors) - 1


def glb(run: Movement) -> bytes:
    """The file's content."""
    model, buffer = run.model, _Buffer()
    time = buffer.add(run.time - run.time[0], bounds=True)
    meshes: list[dict[str, Any]] = []
    samplers: list[dict[str, int]] = []
    channels: list[dict[str, Any]] = []
    nodes: list[dict[str, Any]] = []
    turned = [Rotation.from_quat(run.turned[:, b], scalar_first=True) for b in range(model.nbody)]
    for body in range(model.nbody):
        node: dict[str, Any] = {"name": run.name(body) if body else "world"}
        children = [b for b in range(1, model.nbody) if model.body_parentid[b] == body]
        node |= {"children": children} if children else {}
        shapes = _shapes(run, body, buffer)
        if shapes:
            node["mesh"] = len(meshes)
            meshes.append({"name": node["name"], "primitives": [shapes]})
        if not body:
            node["rotation"] = _Z_TO_Y
        else:
            parent = int(model.body_parentid[body])
            local = turned[parent].inv() * turned[body]
            place = turned[parent].inv().apply(run.place[:, body] - run.place[:, parent])
            quaternions = _steady(local.as_quat())
            node |= {"translation": place[0].tolist(), "rotation": quaternions[0].tolist()}
            tracks = {"rotation": quaternions}
            if np.ptp(place, axis=0).max() > 1e-6:
                tracks["translation"] = place
            for path, values in tracks.items():
                target = {"node": body, "path": path}
                channels.append({"sampler": len(samplers), "target": target})
                samplers.append({"input": time, "output": buffer.add(values)})
        nodes.append(node)
    return _packed(
        buffer,
        {
            "asset": {"version": "2.0", "generator": f"rotctl {__version__}"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": nodes,
            "meshes": meshes,
            "materials": [
                {"pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.8}}
            ],
            "animations": [{"name": "run", "samplers": samplers, "channels": channels}],
        },
    )


def _shapes(run: Movement, body: int, buffer: _Buffer) -> dict[str, Any]:
    """All visible shapes of a body as one; empty if there are none."""
    model, parts, colours = run.model, [], []
    for geom in np.flatnonzero((model.geom_bodyid == body) & (model.geom_rgba[:, 3] > 0)).tolist():
        mesh = mesh_of(model, geom)
        if mesh is not None:
            parts.append(mesh)
            colours.append(np.tile(model.geom_rgba[geom, :3], (len(mesh.vertices), 1)))
    if not parts:
        return {}
    first = np.cumsum([0, *(len(part.vertices) for part in parts)])
    corners = [part.corners + start for part, start in zip(parts, first, strict=False)]
    vertices = np.concatenate([part.vertices for part in parts])
    normals = np.concatenate([part.normals for part in parts])
    return {
        "attributes": {
            "POSITION": buffer.add(vertices, _VERTICES, bounds=True),
            "NORMAL": buffer.add(normals, _VERTICES),
            "COLOR_0": buffer.add(np.concatenate(colours), _VERTICES),
        },
        "indices": buffer.add(np.concatenate(corners).reshape(-1), _CORNERS),
        "material": 0,
    }


def _steady(quaternions: Array) -> Array:
    """Each of the two that mean the same on the side of the one before."""
    same = np.sign((quaternions[1:] * quaternions[:-1]).sum(axis=1))
    signs = np.cumprod(np.append(1.0, np.where(same == 0.0, 1.0, same)))
    return np.asarray(quaternions * signs[:, None])


def _packed(buffer: _Buffer, tree: dict[str, Any]) -> bytes:
    content = bytes(buffer.content)
    tree |= {
        "buffers": [{"byteLength": len(content)}],
        "bufferViews": buffer.views,
        "accessors": buffer.accessors,
    }
    text = json.dumps(tree, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(content), b"BIN\0") + content
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
