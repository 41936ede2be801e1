"""Our names for a foreign humanoid's bodies and joints, and our signs.

A joint bears the name of its group and the letter of our axis that its own is nearest to. What
bends bends when its angle grows.
"""

from collections.abc import Mapping

import numpy as np

from rotctl.adopting.tree import Hinge, Segment

LETTERS = "xyz"
ALIKE = 0.5  # cosine of a hinge's axis with ours, from which it bears its letter
# Signs of our joints' axes, of a left limb: bending is positive.
_AXES = {
    "waist": (1, 1, 1), "chest": (1, 1, 1), "neck": (1, 1, 1), "hip": (1, -1, 1),
    "knee": (1, 1, 1), "ankle": (1, -1, 1), "shoulder": (1, -1, 1), "elbow": (1, -1, 1),
    "wrist": (1, -1, 1), "more": (1, 1, 1),
}  # fmt: skip
_SINGLE = ("knee", "elbow")  # of one hinge, whose name has no letter
OUR_BODIES = {  # roles, from the joint at the upper end of a segment, to our bodies
    "hips": "pelvis", "chest": "chest", "head": "head",
    "left_shoulder": "upper_arm", "left_elbow": "forearm",
    "left_hip": "thigh", "left_knee": "shin", "left_ankle": "foot",
}  # fmt: skip
_SIDED = [
    pair.split()
    for pair in ("left right", "Left Right", "_l _r", "_L _R", ".l .r", ".L .R", "l r", "L R")
]


def give_names(segments: dict[int, Segment], bodies: Mapping[str, int], names: list[str]) -> None:
    """Name segments and hinges as ours.

    Args:
        segments: by body, parents first.
        bodies: role to body.
        names: of the bodies in the file.
    """
    trunk = _chain(segments, bodies["chest"])
    groups = {body: "waist" for body in trunk[1:] if segments[body].hinges}
    ours = {bodies[role]: OUR_BODIES[role] for role in ("hips", "chest", "head") if role in bodies}
    if "head" in bodies:
        groups |= {b: "neck" for b in _chain(segments, bodies["head"]) if b not in trunk}
    alike: list[tuple[int, int]] = []
    for parts in (("shoulder", "elbow", "wrist"), ("hip", "knee", "ankle")):
        limbs = []
        for side in ("left", "right"):
            joints = {
                part: bodies[f"{side}_{part}"] for part in parts if f"{side}_{part}" in bodies
            }
            limbs.append(_name_limb(segments, trunk, joints, groups, ours))
        alike += zip(*limbs, strict=False)
    groups |= {b: "more" for b, s in segments.items() if b not in groups and s.hinges}
    if len(trunk) > 2:
        ours[trunk[-2]] = "waist"
    _pair_up(segments, names)
    for left, right in alike:  # in the same place, whatever they are called
        if not segments[left].side and not segments[right].side:
            segments[left].side, segments[right].side = "left", "right"
            segments[left].name = segments[right].name = _bare(names[left])
    for body, segment in segments.items():
        plain = segment.name or _bare(names[body])
        segment.name = ours.get(body) or plain + "_link" * (plain in ours.values())
    _joint_names(segments, groups)


def _chain(segments: Mapping[int, Segment], body: int) -> list[int]:
    """The bodies from the pelvis to one."""
    found = []
    while body >= 0:
        found.append(body)
        body = segments[body].parent
    return found[::-1]


def _name_limb(
    segments: Mapping[int, Segment],
    trunk: list[int],
    joints: Mapping[str, int],
    groups: dict[int, str],
    ours: dict[int, str],
) -> list[int]:
    """Add a limb's bodies: to which joint's group each belongs, and which is a segment of ours.

    Args:
        joints: hip, knee, ankle or shoulder, elbow, wrist, to the body that each moves first.

    Returns:
        They, from the trunk on.
    """
    last = list(joints.values())[-1]
    members = [body for body in _chain(segments, last) if body not in trunk]
    starts = {members.index(body): part for part, body in joints.items()}
    part = starts[min(starts)]
    for k, body in enumerate(members):
        part = starts.get(k, part)
        groups[body] = part if k >= min(starts) else "more"
        last_of_it = k + 1 == len(members) or k + 1 in starts  # before the next joint
        if last_of_it and k >= min(starts):  # a collar bone is before the first
            ours[body] = OUR_BODIES.get(f"left_{part}", "")
    below = [b for b in segments if b not in members and last in _chain(segments, b)]
    groups |= dict.fromkeys(below, part)
    if part == "ankle" and below:  # the sole is below the last of the ankle's hinges
        ours[below[-1]] = ours.pop(members[-1])
    return members + below


def _pair_up(segments: Mapping[int, Segment], names: list[str]) -> None:
    """Tell left and right bodies, and give both of a pair one name."""
    for body, segment in segments.items():
        pair = _pair(names[body], names)
        if pair and names.index(pair[0]) in segments:
            other = segments[names.index(pair[0])]
            segment.side, other.side = "left", "right"
            segment.name = other.name = pair[1]


def _joint_names(segments: dict[int, Segment], groups: Mapping[int, str]) -> None:
    """A letter to each hinge of a group, the clearest first; no letter twice."""
    by_group: dict[tuple[str, str], list[Hinge]] = {}
    for b, group in groups.items():
        by_group.setdefault((group, segments[b].side), []).extend(segments[b].hinges)
    for (group, _), hinges in by_group.items():
        free, left = set(range(3)), list(hinges)
        if group == "waist" and len(left) > 3:
            _along_the_spine(left)
            continue
        if group in _SINGLE and left:
            left.sort(key=lambda h: -abs(h.axis[1]))
            _called(left.pop(0), group, 1, group)
            free.discard(1)
        while left and free:
            hinge, k = max(
                ((h, k) for h in left for k in free), key=lambda pair: abs(pair[0].axis[pair[1]])
            )
            if abs(hinge.axis[k]) < ALIKE:  # toes that bend as the ankle does
                break
            _called(hinge, f"{group}_{LETTERS[k]}", k, group)
            left.remove(hinge)
            free.discard(k)
        for n, hinge in enumerate(left):
            _called(hinge, f"{group}_more_{n + 1}", int(np.argmax(np.abs(hinge.axis))), group)


def _along_the_spine(hinges: list[Hinge]) -> None:
    """A spine of more than three hinges has a waist and a chest, and what is more is stiff."""
    used: set[str] = set()
    for n, hinge in enumerate(hinges):
        k = int(np.argmax(np.abs(hinge.axis)))
        names = [f"{group}_{LETTERS[k]}" for group in ("waist", "chest")]
        name = next((name for name in names if name not in used), f"spine_{n + 1}_{LETTERS[k]}")
        used.add(name)
        _called(hinge, name, k, "waist")


def _called(hinge: Hinge, name: str, letter: int, group: str) -> None:
    """Name a hinge, and turn it so that it bends as ours does."""
    hinge.name = name
    if hinge.axis[letter] * _AXES[group][letter] < 0.0:
        hinge.axis, hinge.low, hinge.high = -hinge.axis, -hinge.high, -hinge.low
        hinge.rest = -hinge.rest


def _pair(name: str, names: list[str]) -> tuple[str, str] | None:
    """The right body of a left one, and what both are called without a side."""
    for left, right in _SIDED:
        at = name.find(left) if len(left) > 1 else 0 if name.startswith(left) else -1
        if at >= 0:
            before, after = name[:at], name[at + len(left) :]
            if before + right + after in names:
                return before + right + after, _bare(before + after)
    return None


def _bare(name: str) -> str:
    """A name as ours are."""
    kept = "".join(c if c.isalnum() else "_" for c in name.lower())
    return "_".join(filter(None, kept.split("_"))) or "body"
