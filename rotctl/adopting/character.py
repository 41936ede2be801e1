"""A tree of bodies in our names as the plain data of a character, `conf/character/*.yaml`.

What the file does not say of its motors and joints is made up, as the adult has it for such a mass
and height, and noted.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from rotctl.adopting.shapes import numbers
from rotctl.adopting.tree import Hinge, Segment

_ADULT = {
    "waist": 200.0, "chest": 200.0, "spine": 200.0, "neck": 50.0, "hip": 250.0, "knee": 250.0,
    "ankle": 100.0, "shoulder": 120.0, "elbow": 80.0, "wrist": 20.0, "more": 20.0,
}  # fmt: skip
ADULT_HEIGHT, ADULT_MASS = 1.75, 70.0  # whose strength that is [N m], and whose gains there are
JOINTS = [
    *(f"{group}_{letter}" for group in ("waist", "chest", "neck", "shoulder") for letter in "yxz"),
    *("elbow", "hip_y", "hip_x", "hip_z", "knee", "ankle_y", "ankle_x"),
]
TOUCHES = (
    ("thigh", "chest"), ("thigh", "waist"), ("forearm", "thigh"), ("forearm", "shin"),
    ("forearm", "chest"), ("forearm", "pelvis"), ("upper_arm", "thigh"), ("thigh", "thigh"),
    ("shin", "shin"), ("foot", "foot"), ("shin", "pelvis"), ("head", "thigh"), ("head", "shin"),
)  # fmt: skip


class Usual(NamedTuple):
    """What joints have that do not say it, or that are like most.

    Attributes:
        strength: share of the adult's torques [-].
        damping: [N m s/rad]; None where no joint of the file has any.
        armature: [kg m2]; likewise.
    """

    strength: float
    damping: float | None
    armature: float | None


def character(
    segments: dict[int, Segment],
    shaped: Mapping[int, list[dict[str, Any]]],
    name: str,
    total: float,
    reach: tuple[float, float],
    notes: list[str],
) -> dict[str, Any]:
    """The character.

    Args:
        segments: by their bodies, the pelvis first; shaped: their geoms.
        total: mass [kg].
        reach: lowest and highest of it as it stands [m].
        notes: to which is added what was made up.
    """
    height = float(reach[1] - reach[0])
    share = total / ADULT_MASS * height / ADULT_HEIGHT
    hinges = [h for s in segments.values() for h in s.hinges]
    damping = float(np.median([h.damping for h in hinges]))
    damping = round(damping or share * (height / ADULT_HEIGHT) ** 0.5, 5)
    armature = float(np.median([h.armature for h in hinges]))
    armature = round(armature or 0.01 * share * height / ADULT_HEIGHT, 6)
    damped, heavy = (any(getattr(h, it) for h in hinges) for it in ("damping", "armature"))
    usual = Usual(share, damping if damped else None, armature if heavy else None)
    told = [segment for segment in segments.values() if segment.side != "right"]
    bodies = [_body(s, segments.get(s.parent), usual, shaped[s.body]) for s in told]
    made_up = {hinge.name for s in told for hinge in s.hinges if hinge.torque is None}
    if made_up:
        notes.append(
            f"no torque limit in the file for {', '.join(sorted(made_up))}: as strong as the adult "
            "for its mass and height"
        )
    if not damped:
        notes.append(f"no joint damping in the file: {damping:.3g} N m s/rad, as the adult's")
    there = {body["name"] for body in bodies}
    has = {hinge.name for hinge in hinges}
    root = segments[next(iter(segments))]
    return {
        "name": name,
        "height": round(height, 4),
        "mass": round(total, 4),
        "gains_for": {"height": ADULT_HEIGHT, "mass": ADULT_MASS},
        "drawn": {"height": round(height, 4), "mass": round(total, 4)},
        "strength": 1.0,
        "root_height": round(float(root.origin[2] - reach[0]), 5),
        "joint_damping": damping,
        "joint_armature": armature,
        "limit_solref": [0.03, 1.0],
        "trunk": _trunk(segments),
        "exclude_from_control": [],
        "absent": [joint for joint in JOINTS if joint not in has],
        "bodies": bodies,
        "self_collision": [list(pair) for pair in TOUCHES if set(pair) <= there],
    }


def _body(
    segment: Segment, parent: Segment | None, usual: Usual, geoms: list[dict[str, Any]]
) -> dict[str, Any]:
    body: dict[str, Any] = {"name": segment.name, "colour": [0.55, 0.6, 0.66]}
    if parent is not None:
        body |= {"parent": parent.name, "position": numbers(segment.origin - parent.origin)}
    if segment.side:
        body["mirror"] = True
    if segment.hinges:
        body["joints"] = [_joint(hinge, usual) for hinge in segment.hinges]
    return {**body, "geoms": geoms}


def _joint(hinge: Hinge, usual: Usual) -> dict[str, Any]:
    group = hinge.name.partition("_")[0]
    joint = {
        "name": hinge.name,
        "axis": numbers(hinge.axis),
        "range": numbers([min(hinge.low, -1e-3), max(hinge.high, 1e-3)]),
        "torque": round(float(hinge.torque or usual.strength * _ADULT[group]), 2),
    }
    if usual.damping is not None and round(hinge.damping, 5) != usual.damping:
        joint["damping"] = round(hinge.damping, 5)
    if usual.armature is not None and round(hinge.armature, 6) != usual.armature:
        joint["armature"] = round(hinge.armature, 6)
    if hinge.stiffness:
        joint["spring"] = numbers([hinge.stiffness, hinge.rest])
    return joint


def _trunk(segments: Mapping[int, Segment]) -> list[str]:
    """From the pelvis up to the chest."""
    found, b = [], next(b for b, s in segments.items() if s.name == "chest")
    while b >= 0:
        found.append(segments[b].name)
        b = segments[b].parent
    return found[::-1]
