"""Where the parts of a human are in a capture: joints by their many names to our points."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rotctl.errors import InputError
from rotctl.motion.capture import Capture, Joint
from rotctl.rotations import Array

SIDES = {"l": "left", "r": "right"}
BALL = (0.87, 0.0, -0.49)  # of the foot, from the ankle, in the foot's frame

# What files call the joint at the upper end of a segment; the first that is there is taken.
# LeftShoulder, say, is the collar bone where there is a LeftArm, and else the shoulder.
_LIMBS = {
    "hip": ("upleg", "upperleg", "thigh", "femur", "hip"),
    "knee": ("leg", "lowleg", "lowerleg", "shin", "calf", "tibia", "knee"),
    "ankle": ("foot", "ankle"),
    "shoulder": ("arm", "uparm", "upperarm", "shldr", "humerus", "shoulder"),
    "elbow": ("forearm", "lowarm", "lowerarm", "radius", "elbow"),
    "wrist": ("wrist", "hand"),
}
_BALL = ("toebase", "toes", "toe", "ball")
_NECK = ("neck", "neck1", "lowerneck", "head")
_HEAD = ("head", "neck")
PART_OF_SPINE = 0.02  # [legs] a joint nearer to the root says nothing on where it points
PART_OF_CHEST = 0.15  # [legs] a joint nearer to the neck is a part of the neck


@dataclass(frozen=True)
class Landmarks:
    """Points of the actor's body over time, x forward, y left, z up.

    Attributes:
        points: (n, 3) by name, in the file's unit of length.
        leg: from hip to knee to ankle, in that unit.
    """

    points: dict[str, Array]
    leg: float


def find_landmarks(path: Path, capture: Capture) -> Landmarks:
    """Name the points of a capture.

    Args:
        path: of the capture, for messages.

    Raises:
        InputError: a joint that is needed has none of the names we know.
    """
    named: dict[str, Joint] = {}
    for joint_name, joint in capture.joints.items():
        # mixamorig:LeftArm, Character1_LeftArm, left_arm, LArm: all of them are known.
        bare = joint_name.rpartition(":")[2]
        for spelling in (bare, bare.partition("_")[2]):
            named.setdefault(re.sub(r"[^a-z0-9]", "", spelling.lower()), joint)
    points: dict[str, Array] = {}

    def find(names: tuple[str, ...], what: str) -> Joint:
        found = next((named[name] for name in names if name in named), None)
        if found is None:
            raise InputError(
                f"{path}: no joint for the {what}, such as {names[0]}; "
                f"its joints: {', '.join(capture.joints):.300}"
            )
        return found

    for side, word in SIDES.items():
        for part, stems in _LIMBS.items():
            points[f"{part}_{side}"] = find(_sided(stems, side), f"{word} {part}").position
        ankle = find(_sided(_LIMBS["ankle"], side), f"{word} ankle")
        ball = next((named[name] for name in _sided(_BALL, side) if name in named), None)
        points[f"ball_{side}"] = (
            ankle.position + ankle.rotation.apply(BALL) if ball is None else ball.position
        )
    leg = np.mean([_length(points, side) for side in SIDES])
    if not leg > 1e-6:
        raise InputError(f"{path}: its legs have no length")
    head = find(_HEAD, "head")
    neck = find(_NECK, "neck")
    low, high = _spine(capture, neck, float(leg))
    points |= {
        "hips": next(iter(capture.joints.values())).position,
        "neck": neck.position,
        "spine": low.position,
        "chest": high.position,
        "head": head.position,
        "crown": head.position + leg * head.rotation.apply([0.0, 0.0, 1.0]),
        "nose": head.position + leg * head.rotation.apply([1.0, 0.0, 0.0]),
    }
    return Landmarks(points, float(leg))


def _sided(stems: tuple[str, ...], side: str) -> tuple[str, ...]:
    word = SIDES[side]
    return tuple(
        name for stem in stems for name in (word + stem, side + stem, stem + word, stem + side)
    )


def _length(points: dict[str, Array], side: str) -> float:
    hip, knee, ankle = (points[f"{part}_{side}"] for part in ("hip", "knee", "ankle"))
    whole = np.linalg.norm(hip - knee, axis=1) + np.linalg.norm(knee - ankle, axis=1)
    return float(np.median(whole))


def _spine(capture: Capture, neck: Joint, leg: float) -> tuple[Joint, Joint]:
    """The lowest joint of the spine that is apart from the root, the highest from the neck."""
    chain, joint = [], neck
    while joint.parent:
        joint = capture.joints[joint.parent]
        chain.append(joint)
    if not chain:
        return neck, neck

    def apart(joint: Joint, other: Joint, least: float) -> bool:
        return bool(
            np.median(np.linalg.norm(joint.position - other.position, axis=1)) > least * leg
        )

    root = chain[-1]
    low = next((joint for joint in chain[::-1] if apart(joint, root, PART_OF_SPINE)), neck)
    high = next((joint for joint in chain if apart(joint, neck, PART_OF_CHEST)), root)
    return low, high
