"""Roles that the user has named: each acts, or is told why it cannot."""

from collections.abc import Mapping
from pathlib import Path
from typing import NoReturn

from rotctl.errors import InputError

_ABOVE = {"knee": "hip", "ankle": "knee", "ball": "ankle", "elbow": "shoulder", "wrist": "elbow"}


def need_heeded(
    path: Path, parents: Mapping[str, str], given: Mapping[str, str], roles: Mapping[str, str]
) -> None:
    """See that what was named was taken, and that no limb hangs the wrong way round.

    Args:
        path: of the file, for messages.
        parents: joint or body to parent.
        given: roles that the user has named, all of them there.
        roles: that were found.

    Raises:
        InputError: one was not taken, or is no limb's.
    """
    trunk = {*_above(parents, roles["chest"]), *_above(parents, roles["hips"])}
    for role, name in given.items():
        side, _, part = role.rpartition("_")
        if part == "chest" and name != roles[role]:
            _refuse(path, role, name, f"both arms hang on {roles[role]}, and that is the chest")
        if part in _ABOVE:
            upper = f"{side}_{_ABOVE[part]}"
            if name == roles[upper] or roles[upper] not in _above(parents, name):
                _refuse(path, role, name, f"does not hang on {roles[upper]}, the {upper}")
        if part in ("hip", "shoulder"):
            other = f"{'right' if side == 'left' else 'left'}_{part}"
            if roles[other] in _above(parents, name):
                _refuse(path, role, name, f"is of one limb with {roles[other]}, the {other}")
            if name in trunk:
                _refuse(path, role, name, "is of the trunk")
            if name in _above(parents, roles[other]):
                _refuse(path, role, name, f"{roles[other]}, the {other}, hangs on it, too")


def need_trunk(
    path: Path, parents: Mapping[str, str], given: Mapping[str, str], roles: Mapping[str, str]
) -> None:
    """See that a model's hips lie between legs and arms, and its head beyond.

    Args:
        path, parents, given, roles: as of `need_heeded`.

    Raises:
        InputError: what was named does not.
    """
    arms = _above(parents, roles["chest"])
    legs = _above(parents, roles["left_hip"])
    legs = [name for name in _above(parents, roles["right_hip"]) if name in legs]
    meet = next(name for name in legs if name in arms)
    spine = [*legs[: legs.index(meet) + 1], *reversed(arms[: arms.index(meet)])]
    if "hips" in given and given["hips"] not in spine:
        _refuse(path, "hips", given["hips"], f"is not between legs and arms: {', '.join(spine)}")
    if given.get("head") in spine:
        _refuse(path, "head", given["head"], "is of the trunk")


def _above(parents: Mapping[str, str], name: str) -> list[str]:
    """It and what it hangs on, the root last."""
    found = []
    while name:
        found.append(name)
        name = parents[name]
    return found


def _refuse(path: Path, role: str, name: str, why: str) -> NoReturn:
    raise InputError(f"{path}: --map {role}={name:.60}: {why}")
