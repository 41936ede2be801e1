"""The bodies, joints, capsules and motors of a character as MuJoCo's."""

from typing import Any

import mujoco
import numpy as np

from rotctl.errors import InputError
from rotctl.mechanics.bodies import SIDES
from rotctl.mechanics.character import Body, Character, Geom, Joint
from rotctl.mechanics.terrain import CHARACTER_CONTACT, GROUND_CONTACT
from rotctl.settings.fields import Vector


def add_character(spec: mujoco.MjSpec, character: Character) -> None:
    """Add the character's tree, motors and self-collision pairs to `spec`.

    Motors are in the order of the degrees of freedom, so that dof 6 + i belongs to motor i.

    Raises:
        InputError: a body names an unknown parent, the root has a position, or a collision pair
            an unknown body.
    """
    built: dict[str, mujoco.MjsBody] = {}
    geoms: dict[str, list[tuple[str, str]]] = {}
    torque: dict[str, float] = {}
    for body in character.bodies:
        for side in SIDES if body.mirror else ("",):
            made = _add_body(spec, character, body, side, built)
            for joint in body.joints:
                _add_joint(made, character, joint, side)
                torque[joint.name + side] = joint.torque
            for geom in body.geoms:
                _add_geom(spec, made, character, body, geom, side)
                if geom.mass > 0:
                    geoms.setdefault(body.name, []).append((side, geom.name + side))
    for name in _joints_in_dof_order(spec):
        motor = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        motor.set_to_motor()
        motor.ctrlrange = [-torque[name], torque[name]]
        motor.ctrllimited = True
    for first, second in character.self_collision:
        for name in (first, second):
            if name not in geoms:
                raise InputError(
                    f"character.self_collision names the unknown body {name!r}; "
                    f"bodies: {', '.join(geoms)}"
                )
        for side_a, geom_a in geoms[first]:
            for side_b, geom_b in geoms[second]:
                if first != second or (side_a, side_b) == SIDES:
                    spec.add_pair(geomname1=geom_a, geomname2=geom_b, condim=1)


def _add_body(
    spec: mujoco.MjSpec,
    character: Character,
    body: Body,
    side: str,
    built: dict[str, mujoco.MjsBody],
) -> mujoco.MjsBody:
    if body.parent is None:
        if any(body.position):
            raise InputError(
                f"character body {body.name!r} has no parent, so that its place is "
                "character.root_height: leave out its position"
            )
        made = spec.worldbody.add_body(name=body.name, pos=[0.0, 0.0, character.root_height])
        made.add_freejoint(name="root")
    else:
        parent = built.get(body.parent + side) or built.get(body.parent)
        if parent is None:
            raise InputError(
                f"character body {body.name!r} hangs on the unknown parent {body.parent!r}; "
                f"bodies before it: {', '.join(built)}"
            )
        made = parent.add_body(name=body.name + side, pos=_mirrored(body.position, side))
    built[body.name + side] = made
    return made


def _add_joint(made: mujoco.MjsBody, character: Character, joint: Joint, side: str) -> None:
    # An axis is a pseudo-vector: its in-plane part changes sign in a mirror.
    x, y, z = joint.axis
    stiffness, rest = joint.spring or (0.0, 0.0)
    made.add_joint(
        name=joint.name + side,
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=[-x, y, -z] if side == "_r" else [x, y, z],
        range=joint.range,
        limited=True,
        damping=character.joint_damping if joint.damping is None else joint.damping,
        armature=character.joint_armature if joint.armature is None else joint.armature,
        stiffness=stiffness,
        springref=rest,
        solref_limit=character.limit_solref,
    )


def _add_geom(
    spec: mujoco.MjSpec,
    made: mujoco.MjsBody,
    character: Character,
    body: Body,
    geom: Geom,
    side: str,
) -> None:
    solid = geom.mass > 0
    shape: dict[str, Any]
    if geom.hull is not None:
        places = [x for corner in geom.hull for x in _mirrored(corner, side)]
        spec.add_mesh(name=geom.name + side, uservert=places)
        shape = {"type": mujoco.mjtGeom.mjGEOM_MESH, "meshname": geom.name + side}
    elif geom.end is None:
        shape = {"type": mujoco.mjtGeom.mjGEOM_SPHERE, "pos": _mirrored(geom.start, side)}
    else:
        ends = np.r_[_mirrored(geom.start, side), _mirrored(geom.end, side)]
        shape = {"type": mujoco.mjtGeom.mjGEOM_CAPSULE, "fromto": ends}
    made.add_geom(
        name=geom.name + side,
        size=[geom.size, 0.0, 0.0],
        mass=geom.mass * character.mass,
        contype=CHARACTER_CONTACT if solid else 0,
        conaffinity=GROUND_CONTACT if solid else 0,
        condim=3,
        rgba=[*(geom.colour or body.colour), 1.0],
        **shape,
    )


def _mirrored(position: Vector, side: str) -> list[float]:
    x, y, z = position
    return [x, -y if side == "_r" else y, z]


def _joints_in_dof_order(spec: mujoco.MjSpec) -> list[str]:
    try:
        model = spec.compile()
    except ValueError as error:  # corners of a hull may lie in a plane
        reason = " ".join(str(error).split())
        raise InputError(f"character: does not compile: {reason:.200}") from None
    hinges = np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE)
    return [model.joint(int(j)).name for j in hinges]
