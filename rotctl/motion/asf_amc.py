"""Acclaim files: a skeleton (.asf) and a motion of it (.amc).

A bone's rotation is C M C^-1: C from its `axis`, in world axes, and M from those of rx, ry
and rz that its `dof` names, both about x first and z last. A bone starts where its parent
ends; its direction is in world axes. y is up and the rest pose faces +z. Neither file says
the frame rate.
"""

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

RATE = 120.0  # [Hz] what CMU's files are usually taken with
ROOT = "root"
_ROOT_ORDER = ["TX", "TY", "TZ", "RX", "RY", "RZ"]
_DOF = ("rx", "ry", "rz")


@dataclass
class _Bone:
    offset: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])  # from start to end
    axis: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])  # [deg]
    dof: list[str] = field(default_factory=list)


def read_amc(path: Path, skeleton: Path, rate: float = RATE) -> Capture:
    """Read a motion and its skeleton.

    Args:
        rate: [Hz]; the file does not say.

    Raises:
        InputError: one line that names the file and the line in it.
    """
    bones, parents = _skeleton(skeleton)
    values = _frames(path, bones)
    root = values[ROOT]
    n = len(root)
    bounded(path, len(bones), n)
    local = {ROOT: Rotation.from_euler("xyz", root[:, 3:], degrees=True)}
    for name, bone in bones.items():
        angles = np.zeros((n, 3))
        if bone.dof:
            angles[:, [_DOF.index(dof) for dof in bone.dof]] = values[name]
        frame = Rotation.from_euler("xyz", bone.axis, degrees=True)
        local[name] = frame * Rotation.from_euler("xyz", angles, degrees=True) * frame.inv()
    starts = {
        name: np.array(bones[parent].offset) for name, parent in parents.items() if parent in bones
    }
    origin = np.zeros(3)
    return assembled(
        np.arange(n) / rate,
        {ROOT: "", **parents},
        {name: starts.get(name, origin) for name in parents},
        local,
        {ROOT: root[:, :3]},
        Y_UP_FACING_Z,
    )


def skeleton_of(path: Path) -> Path:
    """The .asf of an .amc: of its own name, or as CMU ships them, 01.asf for all 01_*.amc.

    Raises:
        InputError: there is neither.
    """
    own = path.with_suffix(".asf")
    subject = path.with_name(f"{path.stem.partition('_')[0]}.asf")
    found = next((each for each in (own, subject) if each.is_file()), None)
    if found is None:
        other = f" or {subject.name}" if subject != own else ""
        raise InputError(f"{path}: no {own.name}{other} beside it; give --skeleton FILE.asf")
    return found


def _skeleton(path: Path) -> tuple[dict[str, _Bone], dict[str, str]]:
    """Bones by name, and each bone's parent, parents first."""
    bones: dict[str, _Bone] = {}
    parents: dict[str, str] = {}
    section, bone, name, length = "", _Bone(), "", 0.0
    for i, line in enumerate(text_of(path).splitlines(), 1):
        where = f"{path}:{i}"
        words = line.partition("#")[0].split()
        if not words:
            continue
        key, rest = words[0], words[1:]
        if key.startswith(":"):
            section = key
        elif section == ":root" and key == "order" and [w.upper() for w in rest] != _ROOT_ORDER:
            raise InputError(f"{where}: the root's order must be {' '.join(_ROOT_ORDER)}")
        elif section == ":root" and key == "orientation" and any(numbers(where, rest, 3)):
            raise InputError(f"{where}: the root's orientation must be 0 0 0")
        elif section == ":units" and key == "angle" and rest != ["deg"]:
            raise InputError(f"{where}: angles must be in deg")
        elif section == ":bonedata":
            if key == "begin":
                bone, name, length = _Bone(), "", 1.0
            elif key == "name":
                name = " ".join(rest)
            elif key == "direction":
                bone.offset = numbers(where, rest, 3)
            elif key == "length":
                (length,) = numbers(where, rest, 1)
            elif key == "axis":
                if [w.upper() for w in rest[3:]] != ["XYZ"]:
                    raise InputError(f"{where}: the axis must end with its order, XYZ")
                bone.axis = numbers(where, rest[:3], 3)
            elif key == "dof":
                bone.dof = [dof for dof in map(str.lower, rest) if dof != "l"]
                if not set(bone.dof) <= set(_DOF):
                    raise InputError(f"{where}: dof {' '.join(rest):.40}, valid: rx ry rz")
            elif key == "end":
                if not name or name in bones or name == ROOT or len(bones) >= MAX_JOINTS:
                    raise InputError(
                        f"{where}: a bone needs a name of its own, and {MAX_JOINTS} are the most"
                    )
                bone.offset = [length * x for x in bone.offset]
                bones[name] = bone
        elif section == ":hierarchy" and key not in ("begin", "end"):
            for child in rest:
                if child not in bones or child in parents or key not in (ROOT, *parents):
                    raise InputError(
                        f"{where}: {child!r:.40} under {key!r:.40}: each bone must hang once, "
                        "on the root or a bone before it"
                    )
                parents[child] = key
    loose = sorted(set(bones) - set(parents))
    if not bones or loose:
        raise InputError(f"{path}: no hierarchy for: {', '.join(loose) or 'no bones'}")
    return bones, parents


def _frames(path: Path, bones: dict[str, _Bone]) -> dict[str, np.ndarray]:
    """Bone to values (n, its degrees of freedom)."""
    wanted = {ROOT: 6, **{name: len(bone.dof) for name, bone in bones.items() if bone.dof}}
    frames: list[dict[str, list[float]]] = []
    began = 0
    for i, line in enumerate(text_of(path).splitlines(), 1):
        words = line.split()
        if not words or words[0][0] in "#:":
            continue
        if len(words) == 1 and words[0].isdecimal():
            _whole(path, began, frames, wanted)
            if len(frames) == MAX_FRAMES:
                raise InputError(f"{path}:{i}: more than {MAX_FRAMES} frames")
            frames.append({})
            began = i
        elif not frames:
            raise InputError(f"{path}:{i}: {words[0]!r:.40} before the first frame's number")
        elif words[0] not in wanted:
            raise InputError(f"{path}:{i}: the skeleton has no moving bone {words[0]!r:.40}")
        else:
            name = words[0]
            frames[-1][name] = numbers(f"{path}:{i}", words[1:], wanted[name])
    _whole(path, began, frames, wanted)
    if len(frames) < 2:
        raise InputError(f"{path}: {len(frames)} frames, at least 2 expected")
    return {name: np.array([frame[name] for frame in frames]) for name in wanted}


def _whole(
    path: Path, line: int, frames: list[dict[str, list[float]]], wanted: dict[str, int]
) -> None:
    missing = [name for name in wanted if frames and name not in frames[-1]]
    if missing:
        raise InputError(f"{path}:{line}: the frame lacks {', '.join(missing):.60}")
