"""Biovision files (.bvh): a skeleton of offsets, then one line of channels a frame.

Angles are in degrees; a joint's rotation is the product in the order of its channels, which
differs from file to file. The length unit is nowhere written. y is up and the rest pose
faces +z. A root with position channels is where they say: its offset does not count.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.errors import InputError
from rotctl.motion.capture import (
    MAX_FRAMES,
    MAX_JOINTS,
    Y_UP_FACING_Z,
    Capture,
    assembled,
    bounded,
)
from rotctl.motion.untrusted import numbers, text_of
from rotctl.rotations import Array

_CHANNELS = tuple(f"{axis}{kind}" for kind in ("position", "rotation") for axis in "XYZ")

Words = Iterator[tuple[int, str]]  # (line, word)


@dataclass
class _Joint:
    name: str
    parent: str
    offset: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    channels: list[str] = field(default_factory=list)


def read_bvh(path: Path) -> Capture:
    """Read a BVH file.

    Raises:
        InputError: one line that names the file and the line in it.
    """
    lines = text_of(path).splitlines()
    start = next((i for i, line in enumerate(lines) if line.strip() == "MOTION"), len(lines))
    joints = _skeleton(path, lines[:start])
    time, values = _frames(path, lines, start, sum(len(joint.channels) for joint in joints))
    bounded(path, len(joints), len(time))
    root, local, column = np.zeros((len(time), 3)), {}, 0
    for joint in joints:
        rotation = Rotation.identity(len(time))
        for channel in joint.channels:
            if channel.endswith("rotation"):
                turn = Rotation.from_euler(channel[0].lower(), values[:, [column]], degrees=True)
                rotation = rotation * turn
            elif not joint.parent:  # elsewhere it would stretch a bone
                root[:, "XYZ".index(channel[0])] = values[:, column]
            column += 1
        local[joint.name] = rotation
    return assembled(
        time,
        {joint.name: joint.parent for joint in joints},
        {joint.name: np.array(joint.offset) for joint in joints},
        local,
        root,
        Y_UP_FACING_Z,
    )


def _skeleton(path: Path, lines: list[str]) -> list[_Joint]:
    words = ((i, word) for i, line in enumerate(lines, 1) for word in line.split())
    joints: dict[str, _Joint] = {}
    open_joints: list[_Joint] = []  # an end site has no name, and is not among the joints
    waiting: _Joint | None = None  # for its brace
    line = 0
    for line, word in words:
        where = f"{path}:{line}"
        if waiting is not None:
            if word != "{":
                raise InputError(f"{where}: expected {{, found {word!r:.40}")
            open_joints.append(waiting)
            waiting = None
        elif word in ("ROOT", "JOINT", "End"):
            _, name = next(words, (line, ""))
            if (word == "ROOT") == bool(joints):
                raise InputError(
                    f"{where}: {word} {name:.40}: there must be one ROOT, first of all"
                )
            if word != "ROOT" and not (open_joints and open_joints[-1].name):
                raise InputError(f"{where}: {word} {name:.40} is not in the braces of a joint")
            parent = open_joints[-1].name if open_joints else ""
            if word == "End":
                waiting = _Joint("", parent)
            elif name in joints or len(joints) == MAX_JOINTS:
                raise InputError(
                    f"{where}: {name:.40}: a joint needs a name of its own, and {MAX_JOINTS} are "
                    "the most"
                )
            else:
                waiting = joints[name] = _Joint(name, parent)
        elif word == "}" and open_joints:
            open_joints.pop()
        elif word == "OFFSET" and open_joints:
            open_joints[-1].offset = numbers(where, [w for _, w in _take(words, 3)], 3)
        elif word == "CHANNELS" and open_joints:
            open_joints[-1].channels = _channels(where, words)
        elif word != "HIERARCHY" or joints:
            raise InputError(f"{where}: {word!r:.40} makes no sense here")
    if waiting is not None or open_joints or not joints:
        raise InputError(f"{path}:{line}: the skeleton ends early")
    return list(joints.values())


def _channels(where: str, words: Words) -> list[str]:
    count = "".join(word for _, word in _take(words, 1))
    if count not in ("0", "1", "2", "3", "4", "5", "6"):
        raise InputError(f"{where}: CHANNELS {count:.40}, valid: 0 to 6")
    found = [word for _, word in _take(words, int(count))]
    for channel in found:
        if channel not in _CHANNELS:
            raise InputError(
                f"{where}: unknown channel {channel!r:.40}; valid: {', '.join(_CHANNELS)}"
            )
    return found


def _take(words: Words, count: int) -> list[tuple[int, str]]:
    return [pair for _, pair in zip(range(count), words, strict=False)]


def _frames(path: Path, lines: list[str], start: int, channels: int) -> tuple[Array, Array]:
    """Times (n,) [s] and channel values (n, channels)."""
    if start == len(lines):
        raise InputError(f"{path}:{len(lines)}: no MOTION")
    head = [line.split() for line in lines[start + 1 : start + 3]]
    if len(head) < 2 or head[0][:1] != ["Frames:"] or head[1][:2] != ["Frame", "Time:"]:
        raise InputError(f"{path}:{start + 2}: MOTION must go on with Frames: and Frame Time:")
    (declared,) = numbers(f"{path}:{start + 2}", head[0][1:], 1)
    (period,) = numbers(f"{path}:{start + 3}", head[1][2:], 1)
    if not 1e-4 <= period <= 1.0:
        raise InputError(f"{path}:{start + 3}: Frame Time: {period:g}, valid: 0.0001 to 1 s")
    rows = [(i, line) for i, line in enumerate(lines[start + 3 :], start + 4) if line.strip()]
    if len(rows) != declared or not 2 <= len(rows) <= MAX_FRAMES:
        raise InputError(
            f"{path}:{start + 2}: Frames: {declared:g}, found {len(rows)}; valid: 2 to {MAX_FRAMES}"
        )
    values = [numbers(f"{path}:{i}", line.split(), channels) for i, line in rows]
    return np.arange(len(rows), dtype=np.float64) * np.float64(period), np.array(values)
