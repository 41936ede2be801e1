"""A run as a Biovision file: y up, facing +z, centimetres, angles in degrees about z, x, y.

The rest pose is the model's zero pose. A joint at the hand ends the forearm, as programs ask for
one; it turns with it.
"""

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.export.movement import ROOT, Movement
from rotctl.maths.rotations import Array

CENTIMETRES = 100.0
ORDER = "ZXY"
# Rows are the file's x (left), y (up) and z (forward) in our axes.
_TO_FILE = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
_HANDS = {"forearm": "hand"}  # body without children to the joint at its end
_PLACE = "Xposition Yposition Zposition"
_ANGLES = " ".join(f"{axis}rotation" for axis in ORDER)


def bvh(run: Movement) -> bytes:
    """The file's content."""
    rest, upright = run.rest()
    turned = [
        Rotation.from_quat(run.turned[:, b], scalar_first=True) * upright[b].inv()
        for b in range(run.model.nbody)
    ]
    basis = Rotation.from_matrix(_TO_FILE)
    lines, columns = ["HIERARCHY"], []

    def offset(at: Array) -> str:
        return "OFFSET " + " ".join(f"{x:.6f}" for x in CENTIMETRES * _TO_FILE @ at)

    def add(body: int, depth: int) -> None:
        pad, root = "  " * depth, body == ROOT
        parent = int(run.model.body_parentid[body])
        lines.extend([f"{pad}{'ROOT' if root else 'JOINT'} {run.name(body)}", f"{pad}{{"])
        lines.append(f"{pad}  {offset(np.zeros(3) if root else rest[body] - rest[parent])}")
        channels = f"6 {_PLACE} {_ANGLES}" if root else f"3 {_ANGLES}"
        lines.append(f"{pad}  CHANNELS {channels}")
        if root:
            columns.append(CENTIMETRES * run.place[:, body] @ _TO_FILE.T)
        local = turned[body] if root else turned[parent].inv() * turned[body]
        columns.append(_euler(basis * local * basis.inv()))
        children = [b for b in run.character if run.model.body_parentid[b] == body and b != body]
        for child in children:
            add(child, depth + 1)
        if not children:
            _end(body, depth + 1)
        lines.append(f"{pad}}}")

    def _end(body: int, depth: int) -> None:
        pad, at = "  " * depth, upright[body].apply(run.end(body))
        stem, _, side = run.name(body).rpartition("_")
        if stem in _HANDS:
            lines.extend([f"{pad}JOINT {_HANDS[stem]}_{side}", f"{pad}{{", f"{pad}  {offset(at)}"])
            lines.append(f"{pad}  CHANNELS 3 {_ANGLES}")
            lines.extend([f"{pad}  End Site", f"{pad}  {{", f"{pad}    {offset(0.3 * at)}"])
            lines.extend([f"{pad}  }}", f"{pad}}}"])
            columns.append(np.zeros((len(run.time), 3)))
        else:
            lines.extend([f"{pad}End Site", f"{pad}{{", f"{pad}  {offset(at)}", f"{pad}}}"])

    add(ROOT, 0)
    lines += ["MOTION", f"Frames: {len(run.time)}", f"Frame Time: {run.period:.9f}"]
    lines += [" ".join(f"{x:.6f}" for x in row) for row in np.hstack(columns)]
    return ("\n".join(lines) + "\n").encode()


def _euler(rotation: Rotation) -> Array:
    """Angles (n, 3) [deg] in `ORDER`, each within half a turn of the row before."""
    angles = rotation.as_euler(ORDER, degrees=True, suppress_warnings=True)
    return np.asarray(np.unwrap(angles, period=360.0, axis=0))
