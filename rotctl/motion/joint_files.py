"""A robot's joints over time (.csv, .npz) on a model that the user names.

Rows hold the root's place and orientation and the angles of the model's hinges. Files differ in
the order of the hinges: the joints' names decide, or the bodies' places, where the file has them,
and else the model's order is taken. A quaternion begins with w where the root is a body among
others (qpos, body_quat_w) or a column's name says so, and ends with it else.
"""

import csv
from collections.abc import Sequence
from pathlib import Path

import mujoco
import numpy as np

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics.foreign import skeleton
from rotctl.motion.capture import MAX_FRAMES, Capture, bounded
from rotctl.motion.robot import body_name, captured, depth, hinges_of
from rotctl.motion.smpl import rate_of
from rotctl.motion.untrusted import Arrays, arrays_of, numbers, text_of

CSV_RATE = 30.0  # [Hz] of the LAFAN1 motions on robots; the files do not say
FITS = 0.05  # [m] between bodies where the file and where the joints have them
LOOKED_AT = 8  # frames
MOST_TURNED = 4 * np.pi  # [rad] no hinge of a body winds itself up so far
_ROOT = 7  # numbers of the root


def read_joints(path: Path, model: Path | None, rate: float | None = None) -> Capture:
    """Read joint angles.

    Args:
        model: MJCF file of the robot.
        rate: [Hz] of a .csv.

    Raises:
        InputError: one line that names the file and what is wrong with it.
    """
    if model is None:
        raise InputError(f"{path}: holds angles of a robot's joints; name it: --model robot.xml")
    mj = skeleton(model)
    if path.suffix.lower() == ".csv":
        positions, period = _from_csv(path, mj), 1.0 / (rate or CSV_RATE)
    else:
        arrays = arrays_of(path)
        positions, period = _from_npz(arrays, mj), 1.0 / (rate or rate_of(arrays))
    n = len(positions)
    if not 2 <= n <= MAX_FRAMES:
        raise InputError(f"{path}: {n} frames, valid: 2 to {MAX_FRAMES}")
    bounded(path, mj.nbody, n)
    for name, most in zip(hinges_of(mj), np.abs(positions[:, _ROOT:]).max(axis=0), strict=True):
        if most > MOST_TURNED:
            raise InputError(f"{path}: {name} is at {most:.0f} rad; are its angles degrees?")
    return captured(mj, positions, period * np.arange(n, dtype=np.float64))


def _from_csv(path: Path, mj: mujoco.MjModel) -> Array:
    """Generalised positions (n, nq) of a table."""
    lines = [line for line in text_of(path).splitlines() if line.strip()]
    rows = [[word.strip() for word in row] for row in csv.reader(lines)]
    head = rows.pop(0) if rows and not _is_number(rows[0][-1]) else []
    columns = _ROOT + mj.njnt - 1
    width = len(rows[0]) if rows else 0
    if width not in (columns, columns + 1):
        raise InputError(
            f"{path}: {width} columns, {columns} expected: 7 of the root and one for each of the "
            f"model's {mj.njnt - 1} hinges"
        )
    start = 2 if head else 1
    table = np.array([numbers(f"{path}:{i}", row, width) for i, row in enumerate(rows, start)])
    table, head = table[:, width - columns :], head[width - columns :]  # a time, or a number
    w_first = len(head) > _ROOT and head[3].lower().endswith("w")
    root = table[:, 3:7] if w_first else np.roll(table[:, 3:7], 1, axis=1)
    return _positions(path, mj, table[:, :3], _quaternions(path, root), table[:, 7:], head[7:])


def _from_npz(arrays: Arrays, mj: mujoco.MjModel) -> Array:
    """Generalised positions (n, nq) of arrays."""
    hinges = mj.njnt - 1
    if "qpos" in arrays:  # LocoMuJoCo
        table = arrays.numbers("qpos", None, _ROOT + hinges)
        names = arrays.texts("joint_names") if "joint_names" in arrays else []
        return _positions(
            arrays.path,
            mj,
            table[:, :3],
            _quaternions(arrays.path, table[:, 3:7]),
            table[:, 7:],
            names[-hinges:],
        )
    if "joint_pos" in arrays and "body_pos_w" in arrays:  # BeyondMimic
        angles = arrays.numbers("joint_pos", None, hinges)
        places = arrays.numbers("body_pos_w", len(angles), None, 3)
        turned = arrays.numbers("body_quat_w", len(angles), places.shape[1], 4)
        root = _quaternions(arrays.path, turned[:, 0])
        if "joint_names" in arrays:
            names = arrays.texts("joint_names")
            return _positions(arrays.path, mj, places[:, 0], root, angles, names)
        return _by_places(arrays.path, mj, places, root, angles)
    if "dof_pos" in arrays:
        angles = arrays.numbers("dof_pos", None, hinges)
        root = np.roll(arrays.numbers("root_rot", len(angles), 4), 1, axis=1)
        place = arrays.numbers("root_pos", len(angles), 3)
        return _positions(arrays.path, mj, place, _quaternions(arrays.path, root), angles, [])
    raise InputError(
        f"{arrays.path}: no joints that are known (qpos; joint_pos, body_pos_w, body_quat_w; or "
        f"root_pos, root_rot, dof_pos); it has: {arrays.names}"
    )


def _positions(
    path: Path, mj: mujoco.MjModel, place: Array, root: Array, angles: Array, names: Sequence[str]
) -> Array:
    """Generalised positions; angles in the order of names, or of the model if it has none of them.

    Raises:
        InputError: it has some.
    """
    hinges = hinges_of(mj)
    other = [name for name in names if name not in hinges]
    if len(other) < len(names) and sorted(names) != sorted(hinges):
        why = f"{other[0]!r:.60} is none of them" if other else "one is missing or comes twice"
        raise InputError(
            f"{path}: names of joints that are only in part the model's: {why}; "
            f"its joints: {', '.join(hinges):.300}"
        )
    if sorted(names) == sorted(hinges):
        angles = angles[:, [list(names).index(name) for name in hinges]]
    return np.hstack([place, root, angles])


def _by_places(path: Path, mj: mujoco.MjModel, places: Array, root: Array, angles: Array) -> Array:
    """Whichever order puts the bodies where the file has them: the model's, or level by level."""
    if places.shape[1] != mj.nbody - 1:
        return _positions(path, mj, places[:, 0], root, angles, [])
    hinges, found = hinges_of(mj), []
    chosen = np.unique(np.linspace(0, len(angles) - 1, LOOKED_AT).astype(int))
    deep = list(range(1, mj.nbody))
    levels = sorted(deep, key=lambda b: depth(mj, b))
    for bodies in (deep, levels):
        order = [
            mj.joint(j).name for b in bodies for j in range(1, mj.njnt) if mj.jnt_bodyid[j] == b
        ]
        positions = _positions(path, mj, places[:, 0], root, angles, order)
        there = captured(mj, positions[chosen], np.arange(len(chosen), dtype=float))
        at = np.stack([there.joints[body_name(mj, b)].position for b in bodies], axis=1)
        found.append((float(np.abs(at - places[chosen]).max()), positions))
    apart, positions = min(found, key=lambda pair: pair[0])
    if apart > FITS:
        raise InputError(
            f"{path}: its bodies are {apart:.2f} m from where its {len(hinges)} joints put those "
            "of the model; is it the right --model?"
        )
    return positions


def _quaternions(path: Path, quaternions: Array) -> Array:
    if not (np.linalg.norm(quaternions, axis=1) > 0.5).all():
        raise InputError(f"{path}: the root has no unit quaternions")
    return _unit(quaternions)


def _unit(quaternions: Array) -> Array:
    length = np.maximum(np.linalg.norm(quaternions, axis=1, keepdims=True), 1e-9)
    return np.asarray(quaternions / length)


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
