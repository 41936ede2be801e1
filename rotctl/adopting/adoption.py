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

from rotctl.adopting.character import character
from rotctl.adopting.names import give_names
from rotctl.adopting.shapes import shapes, stature
from rotctl.adopting.sides import unlike
from rotctl.adopting.solid import solid
from rotctl.adopting.straight import face_forward, straighten
from rotctl.adopting.tree import Segment, hung
from rotctl.errors import InputError
from rotctl.maths.rotations import length
from rotctl.motion.naming import find_roles
from rotctl.motion.told_roles import need_trunk

END = " end"  # after a body's name, its far end
SAME_PLACE = 0.01  # [m] hinges of one body that are farther apart are told


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
    made = character(segments, shaped, name, total, reach, notes)
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
