"""Somebody else's humanoid (MJCF) as a character of ours: plain data, to be changed by hand.

Poses, clips and behaviours name joints by what they do (`hip_y` bends the hip), and are of a body
that hangs straight at zero angles. So the roles of the bodies are found, by their names or as
told; the limbs are straightened; every body's frame is put along the world's axes there, its
origin into its first joint; and joints get our names and signs. The tree is hung on the pelvis,
whatever it hung on. Masses and joints stay what they are; inertia is that of the shapes.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from rotctl.adopting.names import give_names
from rotctl.adopting.shapes import numbers, shapes, stature
from rotctl.adopting.sides import unlike
from rotctl.adopting.solid import solid
from rotctl.adopting.straight import face_forward, straighten
from rotctl.adopting.tree import Segment, hung
from rotctl.errors import InputError
from rotctl.maths.rotations import length
from rotctl.motion.naming import find_roles
from rotctl.motion.told_roles import need_trunk

_ADULT = {
    "waist": 200.0, "chest": 200.0, "spine": 200.0, "neck": 50.0, "hip": 250.0, "knee": 250.0,
    "ankle": 100.0, "shoulder": 120.0, "elbow": 80.0, "wrist": 20.0, "more": 20.0,
}  # fmt: skip
ADULT_HEIGHT, ADULT_MASS = 1.75, 70.0  # whose strength that is [N m], and whose gains there are
END = " end"  # after a body's name, its far end
SAME_PLACE = 0.01  # [m] hinges of one body that are farther apart are told
JOINTS = [
    *(f"{group}_{letter}" for group in ("waist", "chest", "neck", "shoulder") for letter in "yxz"),
    *("elbow", "hip_y", "hip_x", "hip_z", "knee", "ankle_y", "ankle_x"),
]
TOUCHES = (
    ("thigh", "chest"), ("thigh", "waist"), ("forearm", "thigh"), ("forearm", "shin"),
    ("forearm", "chest"), ("forearm", "pelvis"), ("upper_arm", "thigh"), ("thigh", "thigh"),
    ("shin", "shin"), ("foot", "foot"), ("shin", "pelvis"), ("head", "thigh"), ("head", "shin"),
)  # fmt: skip


@dataclass(frozen=True)
class Adopted:
    """A foreign humanoid as ours.

    Attributes:
        character: plain data as of `conf/character/*.yaml`.
        roles: role to the file's body.
        joints: our joint to the file's, of the left side and the middle.
        notes: what was made up or lost, one line each.
    """

    character: dict[str, Any]
    roles: Mapping[str, str]
    joints: Mapping[str, str]
    notes: list[str]


def adopt(
    path: Path,
    name: str,
    given: Mapping[str, str] | None = None,
    *,
    meshes: bool = True,
    hulls: bool = False,
    proxies: tuple[str, ...] = (),
) -> Adopted:
    """Read a humanoid of hinges.

    Args:
        name: of the character.
        given: roles that the user has named, see `rotctl.motion.naming.find_roles`.
        meshes: whether capsules stand for them; without, they are left out.
        hulls: whether those that touch do so by their convex hulls, and not by capsules.
        proxies: which of the file's shapes touch, by `rotctl.adopting.proxies`; none are named by
            default, and all do that collide in the file.

    Raises:
        InputError: it is none.
    """
    mj, notes = solid(path, meshes=meshes, hulls=hulls, proxies=proxies)
    names = [mj.body(b).name or f"body_{b}" for b in range(mj.nbody)]
    parents = {names[b]: names[mj.body_parentid[b]] if mj.body_parentid[b] else ""
               for b in range(1, mj.nbody)}  # fmt: skip
    ends = _with_ends(parents)
    roles = find_roles(path, ends, given, "body")
    for role, body in roles.items():
        above = names.index(body.removesuffix(END))
        if mj.body_rootid[above] != mj.jnt_bodyid[0]:
            raise InputError(f"{path}: {role} is {body!r}, which hangs on no freejoint")
    need_trunk(path, ends, given or {}, roles)
    if "hips" not in (given or {}):  # that of the legs alone: a tree may hang on the chest
        roles["hips"] = _common(parents, roles["left_hip"], roles["right_hip"])
    if roles["hips"] == roles["chest"]:
        raise InputError(
            f"{path}: legs and arms hang on one body, {roles['hips']}; no waist to bend"
        )
    if roles.get("head", "").removesuffix(END) in [names[b] for b in mj.jnt_bodyid]:
        roles["head"] = roles["head"].removesuffix(END)  # the last body that a hinge moves
    bodies = {role: names.index(body) for role, body in roles.items() if body in names}
    data = mujoco.MjData(mj)
    straighten(mj, data, bodies)
    face_forward(data, bodies)
    segments = hung(mj, data, bodies["hips"])
    give_names(segments, bodies, names)
    notes += [*_hang_joints(segments), *unlike(mj, segments)]
    total = float(mj.body_mass[list(segments)].sum())  # what stands beside it weighs nothing of it
    reach = stature(mj, data, segments, hulls=hulls)
    shaped = {b: shapes(mj, data, segment, total, hulls=hulls) for b, segment in segments.items()}
    made = _character(segments, shaped, name, total, reach, notes)
    known = {h.name: h.source for s in segments.values() if s.side != "right" for h in s.hinges}
    return Adopted(made, roles, known, notes)


def _with_ends(parents: Mapping[str, str]) -> dict[str, str]:
    """Bodies without children get one, as many a robot has no hand that is a body."""
    leaves = set(parents) - set(parents.values())
    return {**parents, **{f"{leaf}{END}": leaf for leaf in parents if leaf in leaves}}


def _common(parents: Mapping[str, str], one: str, other: str) -> str:
    """The nearest body that both hang on."""
    above = []
    while one:
        above.append(one)
        one = parents[one]
    while other not in above:
        other = parents[other]
    return other


def _hang_joints(segments: dict[int, Segment]) -> list[str]:
    """Notes on hinges that are put into the place of the first of their body."""
    found = []
    for segment in segments.values():
        for hinge in segment.hinges[1:]:
            apart = length(hinge.anchor - segment.origin)
            if apart > SAME_PLACE:
                found.append(
                    f"{hinge.source} is moved {100 * apart:.0f} cm, to {segment.hinges[0].source}"
                )
    return found


def _character(
    segments: dict[int, Segment],
    shaped: Mapping[int, list[dict[str, Any]]],
    name: str,
    total: float,
    reach: tuple[float, float],
    notes: list[str],
) -> dict[str, Any]:
    height = float(reach[1] - reach[0])
    share = total / ADULT_MASS * height / ADULT_HEIGHT
    bodies, made_up = [], set()
    hinges = [h for s in segments.values() for h in s.hinges]
    damping = float(np.median([h.damping for h in hinges]))
    damping = round(damping or share * (height / ADULT_HEIGHT) ** 0.5, 5)
    armature = float(np.median([h.armature for h in hinges]))
    armature = round(armature or 0.01 * share * height / ADULT_HEIGHT, 6)
    damped, heavy = (any(getattr(h, it) for h in hinges) for it in ("damping", "armature"))
    for segment in segments.values():
        if segment.side == "right":
            continue
        parent = segments.get(segment.parent)
        body: dict[str, Any] = {"name": segment.name, "colour": [0.55, 0.6, 0.66]}
        if parent is not None:
            body |= {"parent": parent.name, "position": numbers(segment.origin - parent.origin)}
        if segment.side:
            body["mirror"] = True
        joints = []
        for hinge in segment.hinges:
            group = hinge.name.partition("_")[0]
            if hinge.torque is None:
                made_up.add(hinge.name)
            joint = {
                "name": hinge.name,
                "axis": numbers(hinge.axis),
                "range": numbers([min(hinge.low, -1e-3), max(hinge.high, 1e-3)]),
                "torque": round(float(hinge.torque or share * _ADULT[group]), 2),
            }
            if damped and round(hinge.damping, 5) != damping:
                joint["damping"] = round(hinge.damping, 5)
            if heavy and round(hinge.armature, 6) != armature:
                joint["armature"] = round(hinge.armature, 6)
            if hinge.stiffness:
                joint["spring"] = numbers([hinge.stiffness, hinge.rest])
            joints.append(joint)
        body |= {"joints": joints} if joints else {}
        body["geoms"] = shaped[segment.body]
        bodies.append(body)
    if made_up:
        notes.append(
            f"no torque limit in the file for {', '.join(sorted(made_up))}: as strong as the adult "
            "for its mass and height"
        )
    if not damped:
        notes.append(f"no joint damping in the file: {damping:.3g} N m s/rad, as the adult's")
    there = {body["name"] for body in bodies}
    has = {hinge.name for hinge in hinges}
    absent = [joint for joint in JOINTS if joint not in has]
    trunk, b = [], next(b for b, s in segments.items() if s.name == "chest")
    while b >= 0:
        trunk.append(segments[b].name)
        b = segments[b].parent
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
        "trunk": trunk[::-1],
        "exclude_from_control": [],
        "absent": absent,
        "bodies": bodies,
        "self_collision": [list(pair) for pair in TOUCHES if set(pair) <= there],
    }
