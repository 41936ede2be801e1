"""Which joint of a skeleton is which part of a human: by its names, by the chain, or as told.

Every program names joints its own way. Where a name is not known, the tree still says: below a
hip come a knee, an ankle and the ball of the foot, below a shoulder an elbow and a wrist.
"""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Literal

from rotctl.errors import InputError
from rotctl.motion.told_roles import need_heeded
from rotctl.suggestion import instead

SIDES = {"l": "left", "r": "right"}
LEG, ARM = ("hip", "knee", "ankle"), ("shoulder", "elbow", "wrist")

# What files call the joint at the upper end of a segment; the first that is there is taken.
# LeftShoulder, say, is the collar bone where there is a LeftArm, and else the shoulder.
_LIMBS = {
    "hip": ("upleg", "upperleg", "thigh", "thighbend", "femur", "hip"),
    "knee": ("lowleg", "lowerleg", "shin", "calf", "tibia", "knee", "leg"),
    "ankle": ("ankle", "foot"),
    "ball": ("toebase", "toes", "toe", "ball", "foot"),
    "shoulder": ("arm", "uparm", "upperarm", "uarm", "shldr", "shldrbend", "humerus", "shoulder"),
    "elbow": ("forearm", "lowarm", "lowerarm", "farm", "forearmbend", "radius", "elbow"),
    "wrist": ("wrist", "hand"),
}
_ROBOTS = ("link", "pitch", "roll", "yaw")  # left_hip_pitch_link
_THIGH = ("leg",)  # SOMA's LeftLeg, with a LeftShin below it
_NECK = ("neck", "neck1", "lowerneck", "neck01", "head")
_HEAD = ("head", "neck")
ROLES = (
    "hips",
    "chest",
    "neck",
    "head",
    *(f"{word}_{part}" for word in SIDES.values() for part in (*LEG, "ball", *ARM)),
)


def find_roles(
    path: Path,
    parents: Mapping[str, str],
    given: Mapping[str, str] | None = None,
    thing: Literal["joint", "body"] = "joint",
) -> dict[str, str]:
    """Which joint is which: role, such as `left_hip`, to joint.

    Args:
        path: of the capture, for messages.
        parents: joint to parent, parents first.
        given: roles that the user has named.
        thing: what the file calls those that are named.

    Raises:
        InputError: a joint that is needed is not found, or is given and is not there or none that
            can be it, or there is no such role.
    """
    tree = _Tree(parents, thing)
    roles = dict(given or {})
    for role, joint in roles.items():
        said = f"{path}: --map {role:.60}={joint:.60}: no such"
        if role not in ROLES:
            raise InputError(f"{said} role; {instead(role, ROLES)}")
        if joint not in parents:
            raise InputError(f"{said} {thing}; {tree.shown}")
    for side, word in SIDES.items():
        for limb in (LEG, ARM):
            _find_limb(path, tree, roles, side, word, limb)
    shoulders = tree.common(roles["left_shoulder"], roles["right_shoulder"])
    neck = roles.get("neck") or tree.named(_NECK) or tree.upward(shoulders, roles)
    head = roles.get("head") or tree.named(_HEAD) or tree.end_of(neck)
    if neck and head:  # many a robot has none
        roles |= {"neck": neck, "head": head}
    if "hips" not in roles:
        legs = tree.common(roles["left_hip"], roles["right_hip"])
        roles["hips"] = tree.common(legs, neck or shoulders)
    roles["chest"] = shoulders
    need_heeded(path, parents, given or {}, roles)
    return {role: roles[role] for role in ROLES if role in roles}


def _find_limb(
    path: Path, tree: "_Tree", roles: dict[str, str], side: str, word: str, limb: tuple[str, ...]
) -> None:
    """Add the three joints of a limb, and the ball of a foot that has one."""
    first, middle, last = (f"{word}_{part}" for part in limb)
    told = first in roles

    def named(part: str, stems: tuple[str, ...] = ()) -> str:
        return tree.named(_sided(stems or _LIMBS[part], side))

    for role, part in zip((first, middle, last), limb, strict=True):
        roles.setdefault(role, named(part))
    thigh = named("hip", _THIGH)
    known = named("hip", _LIMBS["hip"][:-1])  # by more than where it is, as LeftHip
    if limb == LEG and not told and not known and tree.below(roles[middle], thigh):
        roles[first] = thigh
    if not roles[first] and roles[middle]:
        roles[first] = tree.parents[roles[middle]]
    for upper, lower in ((first, middle), (middle, last)):
        if roles[upper] and not tree.below(roles[lower], roles[upper]):
            roles[lower] = tree.onward(roles[upper])
    for role, part in zip((first, middle, last), limb, strict=True):
        if not roles[role]:
            raise _missing(path, role, f"{word} {part}", tree, _sided(_LIMBS[part], side)[0])
    if limb == LEG:
        ball = roles.setdefault(f"{word}_ball", named("ball"))
        if not ball or not tree.below(ball, roles[last]):
            del roles[f"{word}_ball"]


def _missing(path: Path, role: str, what: str, tree: "_Tree", example: str = "") -> InputError:
    example = f", such as {example}" if example else ""
    return InputError(
        f"{path}: no {tree.thing} for the {what}{example}; name it with --map {role}=NAME; "
        f"{tree.shown}"
    )


class _Tree:
    """The joints, their spellings and who hangs on whom."""

    def __init__(self, parents: Mapping[str, str], thing: Literal["joint", "body"]) -> None:
        self.parents = parents
        self.thing = thing
        things = {"joint": "joints", "body": "bodies"}[thing]
        self.shown = f"its {things}: {', '.join(parents):.300}"
        self.children: dict[str, list[str]] = {joint: [] for joint in parents}
        spelled: dict[str, tuple[int, str]] = {}
        for joint, parent in parents.items():
            if parent:
                self.children[parent].append(joint)
            for dropped, spelling in _spellings(joint):  # foot_l rather than ik_foot_l
                if spelling not in spelled or dropped < spelled[spelling][0]:
                    spelled[spelling] = dropped, joint
        self._spelled = spelled
        self._deep: dict[str, int] = {}
        for joint in reversed(list(parents)):
            self._deep[joint] = 1 + max((self._deep[c] for c in self.children[joint]), default=0)

    def named(self, names: tuple[str, ...]) -> str:
        """The joint of the first name that is there; empty if none is."""
        return next((self._spelled[name][1] for name in names if name in self._spelled), "")

    def above(self, joint: str) -> list[str]:
        """The joint and those that it hangs on, the root last."""
        found = []
        while joint:
            found.append(joint)
            joint = self.parents[joint]
        return found

    def below(self, joint: str, other: str) -> bool:
        """Whether a joint hangs on another, and is not it."""
        return bool(joint and other) and joint != other and other in self.above(joint)

    def common(self, one: str, other: str) -> str:
        """The nearest joint that both hang on."""
        above = self.above(other)
        return next((joint for joint in self.above(one) if joint in above), above[-1])

    def onward(self, joint: str) -> str:
        """The next joint of the longest chain below one; empty at its end."""
        return max(self.children[joint], key=self._deep.__getitem__, default="")

    def upward(self, chest: str, roles: Mapping[str, str]) -> str:
        """What hangs on the chest beside the arms."""
        arms = {joint for word in SIDES.values() for joint in self.above(roles[f"{word}_shoulder"])}
        legs = {joint for word in SIDES.values() for joint in self.above(roles[f"{word}_hip"])}
        others = [joint for joint in self.children[chest] if joint not in arms | legs]
        return max(others, key=self._deep.__getitem__, default="")

    def end_of(self, joint: str) -> str:
        """The last joint of the longest chain from one on."""
        while joint and (further := self.onward(joint)):
            joint = further
        return joint


def _spellings(joint: str) -> Iterator[tuple[int, str]]:
    """mixamorig:LeftArm, Character1_LeftArm, left_arm, J_Bip_L_UpperArm, upperarm01.L: as letters.

    Gives how many words in front are left out, and the rest with and without its numbers.
    """
    words = re.split(r"[^A-Za-z0-9]+", joint.rpartition(":")[2].lower())
    words = [word for word in words if word and word not in _ROBOTS]
    for dropped in range(len(words)):
        whole = "".join(words[dropped:])
        yield dropped, whole
        yield dropped, re.sub(r"[0-9]", "", whole)


def _sided(stems: tuple[str, ...], side: str) -> tuple[str, ...]:
    word = SIDES[side]
    return tuple(
        name for stem in stems for name in (word + stem, side + stem, stem + word, stem + side)
    )
