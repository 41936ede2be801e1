"""Points of a human in a capture: joints by their roles, and where head and feet point.

A head and a foot without toes point where their rotation says, from the rest pose on. In most
files that is a standing pose, and its own geometry gives up and left. In others all bones lie
along x: there a head is taken to point, on average, where neck and chest do.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.motion.capture import Capture, Joint
from rotctl.motion.naming import SIDES, find_roles

BALL = (0.87, 0.0, -0.49)  # of the foot, from the ankle, in the foot's frame
PART_OF_SPINE = 0.02  # [legs] a joint nearer to the hips says nothing on where they point
PART_OF_CHEST = 0.15  # [legs] a joint nearer to the neck is a part of the neck
STANDS = 0.9  # cosine between spine and legs, from which a rest pose stands
ALONG_AXIS = 0.94  # cosine of 20 deg: a rest pose's legs spread, but alike


@dataclass(frozen=True)
class Landmarks:
    """Points of the actor's body over time, x forward, y left, z up.

    Attributes:
        points: (n, 3) by name, in the file's unit of length.
        leg: from hip to knee to ankle, in that unit.
        roles: which joint was taken for what.
        rest: (3, 3) forward, left and up of the rest pose, as rows; None if it does not stand.
    """

    points: dict[str, Array]
    leg: float
    roles: dict[str, str]
    rest: Array | None


def find_landmarks(
    path: Path, capture: Capture, given: Mapping[str, str] | None = None
) -> Landmarks:
    """Name the points of a capture.

    Args:
        path: of the capture, for messages.
        given: roles of joints that the user has named, see `find_roles`.

    Raises:
        InputError: a joint that is needed is not found.
    """
    roles = find_roles(path, {name: j.parent for name, j in capture.joints.items()}, given)
    joints = {role: capture.joints[name] for role, name in roles.items()}
    points = {
        f"{part}_{side}": joints[f"{word}_{part}"].position
        for side, word in SIDES.items()
        for part in ("hip", "knee", "ankle", "shoulder", "elbow", "wrist")
    }
    leg = float(np.mean([_length(points, side) for side in SIDES]))
    if not leg > 1e-6:
        raise InputError(f"{path}: its legs have no length")
    if "neck" not in joints:
        joints["neck"] = joints["head"] = _between_the_shoulders(joints)
    head, neck, hips = joints["head"], joints["neck"], joints["hips"]
    low, high = _spine(capture, joints, leg)
    points |= {"hips": hips.position, "neck": neck.position, "head": head.position}
    points |= {"spine": low.position, "chest": high.position}
    rest = _rest(joints)
    crown, nose = _head(points, head, rest)
    points |= {"crown": points["head"] + leg * crown, "nose": points["head"] + leg * nose}
    for side, word in SIDES.items():
        ball = joints.get(f"{word}_ball")
        points[f"ball_{side}"] = (
            points[f"ankle_{side}"] + _foot(points, joints[f"{word}_ankle"], side, rest)
            if ball is None
            else ball.position
        )
    return Landmarks(points, leg, roles, rest)


def frames(up: Array, left: Array) -> Rotation:
    """Orientations whose z is up (n, 3) and whose y is as near to left (n, 3) as can be."""
    z = _unit(up)
    y = _unit(left - (left * z).sum(axis=1, keepdims=True) * z)
    return Rotation.from_matrix(np.stack([np.cross(y, z), y, z], axis=2))


def _rest(joints: Mapping[str, Joint]) -> Array | None:
    """Forward, left and up of the rest pose, if it stands."""
    left = joints["left_hip"].rest - joints["right_hip"].rest
    legs = [joints[f"{word}_ankle"].rest - joints[f"{word}_hip"].rest for word in SIDES.values()]
    up, spine = -np.sum(legs, axis=0), joints["neck"].rest - joints["hips"].rest
    if min(np.linalg.norm(v) for v in (left, up, spine)) < 1e-9:
        return None
    up, left, spine = (_along_axis(v / np.linalg.norm(v)) for v in (up, left, spine))
    if up @ spine < STANDS or abs(up @ left) > 1.0 - STANDS:
        return None
    return np.asarray(frames(up[None], left[None]).as_matrix()[0].T)


def _along_axis(direction: Array) -> Array:
    """The nearest of the file's axes, if one is near."""
    axis = int(np.argmax(np.abs(direction)))
    if abs(direction[axis]) < ALONG_AXIS:
        return direction
    return np.asarray(np.eye(3)[axis] * np.sign(direction[axis]))


def _head(points: dict[str, Array], head: Joint, rest: Array | None) -> tuple[Array, Array]:
    """Where the crown and the nose point (n, 3)."""
    if rest is not None:
        return head.rotation.apply(rest[2]), head.rotation.apply(rest[0])
    chest_up = points["neck"] - points["chest"]
    if not _long(chest_up).all():
        chest_up = points["neck"] - points["hips"]
    chest = frames(chest_up, points["shoulder_l"] - points["shoulder_r"])
    up = points["head"] - points["neck"]
    up = up if _long(up).all() else chest_up
    own = head.rotation.inv()
    on_average = frames(
        own.apply(_unit(up)).mean(axis=0)[None],
        own.apply(chest.apply([0.0, 1.0, 0.0])).mean(axis=0)[None],
    )[0]
    whole = head.rotation * on_average
    return whole.apply([0.0, 0.0, 1.0]), whole.apply([1.0, 0.0, 0.0])


def _foot(points: dict[str, Array], ankle: Joint, side: str, rest: Array | None) -> Array:
    """From the ankle to where the ball of the foot must be (n, 3), of any length."""
    if rest is not None:
        return ankle.rotation.apply(np.array(BALL) @ rest)
    shin = frames(
        points[f"knee_{side}"] - points[f"ankle_{side}"], points["hip_l"] - points["hip_r"]
    )
    on_average = ankle.rotation.inv().apply(shin.apply(BALL)).mean(axis=0)
    return ankle.rotation.apply(on_average)


def _length(points: dict[str, Array], side: str) -> float:
    hip, knee, ankle = (points[f"{part}_{side}"] for part in ("hip", "knee", "ankle"))
    whole = np.linalg.norm(hip - knee, axis=1) + np.linalg.norm(knee - ankle, axis=1)
    return float(np.median(whole))


def _between_the_shoulders(joints: Mapping[str, Joint]) -> Joint:
    """The neck and head of a body without: they go with the chest."""
    left, right = joints["left_shoulder"], joints["right_shoulder"]
    return Joint(
        parent=left.parent,
        position=0.5 * (left.position + right.position),
        rotation=joints["chest"].rotation,
        rest=0.5 * (left.rest + right.rest),
    )


def _spine(capture: Capture, joints: Mapping[str, Joint], leg: float) -> tuple[Joint, Joint]:
    """The lowest joint of the spine that is apart from the hips, the highest from the neck."""
    neck, hips = joints["neck"], joints["hips"]
    chain, joint = [], neck
    while joint is not hips and joint.parent:
        joint = capture.joints[joint.parent]
        chain.append(joint)
    if not chain:
        return neck, neck

    def apart(joint: Joint, other: Joint, least: float) -> bool:
        return bool(
            np.median(np.linalg.norm(joint.position - other.position, axis=1)) > least * leg
        )

    low = next((joint for joint in chain[::-1] if apart(joint, hips, PART_OF_SPINE)), neck)
    high = next((joint for joint in chain if apart(joint, neck, PART_OF_CHEST)), hips)
    return low, high


def _long(vectors: Array) -> Array:
    return np.asarray(np.linalg.norm(vectors, axis=1) > 1e-6)


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-12))
