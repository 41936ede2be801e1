"""Biovision files (.bvh): a skeleton of offsets, then one line of channels a frame.

Angles are in degrees; a joint's rotation is the product in the order of its channels, which
differs from file to file. Neither the unit of length nor which axis is up is written: y is, in
most files. A joint with position channels is where they say, its offset does not count; of
the joints below the hips they are left out, as they would stretch bones.
"""

import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.motion.capture import (
    MAX_FRAMES,
    MAX_JOINTS,
    Y_UP_FACING_Z,
    Capture,
    assembled,
    bounded,
)
from rotctl.motion.naming import find_roles
from rotctl.motion.untrusted import numbers, text_of

_CHANNELS = tuple(f"{axis}{kind}" for kind in ("position", "rotation") for axis in "XYZ")

# A name goes to its brace or the end of the line, and may have blanks: Bip01 L Thigh.
_WORDS = re.compile(r"(?:(?<=ROOT)|(?<=JOINT)|(?<=End))\s+[^{}]*[^{}\s]|[{}]|[^\s{}]+")
_COUNT = re.compile(r"Frames\s*:\s*(.*)")
_PERIOD = re.compile(r"Frame\s+Time\s*:\s*(.*)")

Words = Iterator[tuple[int, str]]  # (line, word)


@dataclass
class _Joint:
    name: str
    parent: str
    offset: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])
    channels: list[str] = field(default_factory=list)


def read_bvh(path: Path, given: Mapping[str, str] | None = None) -> Capture:
    """Read a BVH file; its y is taken for up.

    Args:
        given: roles of joints that the user has named, see `find_roles`.

    Raises:
        InputError: one line that names the file and the line in it.
    """
    lines = text_of(path).splitlines()
    start = next((i for i, line in enumerate(lines) if line.strip() == "MOTION"), len(lines))
    joints = _skeleton(path, lines[:start])
    time, values = _frames(path, lines, start, sum(len(joint.channels) for joint in joints))
    bounded(path, len(joints), len(time))
    parents = {joint.name: joint.parent for joint in joints}
    free = _down_to_the_hips(path, parents, given)
    moves, local, column = {}, {}, 0
    for joint in joints:
        rotation, place = Rotation.identity(len(time)), np.zeros((len(time), 3))
        for channel in joint.channels:
            if channel.endswith("rotation"):
                turn = Rotation.from_euler(channel[0].lower(), values[:, [column]], degrees=True)
                rotation = rotation * turn
            else:
                place[:, "XYZ".index(channel[0])] = values[:, column]
                if joint.name in free:
                    moves[joint.name] = place
            column += 1
        local[joint.name] = rotation
    moves.setdefault(joints[0].name, np.zeros((len(time), 3)))
    offsets = {joint.name: np.array(joint.offset) for joint in joints}
    capture = assembled(time, parents, offsets, local, moves, Y_UP_FACING_Z)
    return replace(capture, upright=False)


def _down_to_the_hips(
    path: Path, parents: Mapping[str, str], given: Mapping[str, str] | None
) -> set[str]:
    """The joints that may move against their parents."""
    free, joint = {next(iter(parents))}, ""
    with suppress(InputError):  # where landmarks are looked for, it is told
        joint = find_roles(path, parents, given)["hips"]
    while joint:
        free.add(joint)
        joint = parents[joint]
    return free


def _skeleton(path: Path, lines: list[str]) -> list[_Joint]:
    words = ((i, word.strip()) for i, line in enumerate(lines, 1) for word in _WORDS.findall(line))
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
    said = [(i, line.strip()) for i, line in enumerate(lines[start:], start + 1) if line.strip()]
    (count_at, count), (period_at, length) = (*said[1:3], (start + 2, ""), (start + 2, ""))[:2]
    has_count, has_length = _COUNT.match(count), _PERIOD.match(length)
    if not (has_count and has_length):
        raise InputError(f"{path}:{count_at}: MOTION must go on with Frames: and Frame Time:")
    (declared,) = numbers(f"{path}:{count_at}", has_count[1].split(), 1)
    (period,) = numbers(f"{path}:{period_at}", has_length[1].split(), 1)
    if not 1e-4 <= period <= 1.0:
        raise InputError(f"{path}:{period_at}: Frame Time: {period:g}, valid: 0.0001 to 1 s")
    rows = said[3:]
    if len(rows) != declared or not 2 <= len(rows) <= MAX_FRAMES:
        raise InputError(
            f"{path}:{count_at}: Frames: {declared:g}, found {len(rows)}; valid: 2 to {MAX_FRAMES}"
        )
    values = [numbers(f"{path}:{i}", line.split(), channels) for i, line in rows]
    return np.arange(len(rows), dtype=np.float64) * np.float64(period), np.array(values)
