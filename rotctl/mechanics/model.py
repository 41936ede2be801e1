"""Character, ground and physics options compiled into one model, with the indices control needs.

The character's bodies and degrees of freedom come first. After them come those of loose
things on the ground, if there are any. MuJoCo's arrays are of the whole world; its mass matrix
is block diagonal in the two, so that control can work on full vectors and leave the rest at 0.
"""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import mujoco
import numpy as np
from numpy.typing import NDArray

from rotctl.errors import InputError
from rotctl.maths.rotations import Array
from rotctl.mechanics import pair_limit
from rotctl.mechanics.assembly import add_character
from rotctl.mechanics.bodies import (
    ROOT_BODY,
    SIDES,
    body_id,
    is_character,
    lowest_and_highest,
)
from rotctl.mechanics.character import Character
from rotctl.mechanics.flesh import add_flesh
from rotctl.mechanics.physics import Physics
from rotctl.mechanics.stature import grown
from rotctl.mechanics.terrain import Ground, Terrain, add_tiles
from rotctl.suggestion import instead

ROOT_DOFS = 6
TERRAIN_STREAM = 1  # the start is drawn from the seed alone, the terrain from this beside it


@dataclass(frozen=True)
class Model:
    """A compiled model and the numbers around it that do not change during a run.

    Attributes:
        mj: the MuJoCo model.
        mjcf: the self-contained text that it was compiled from.
        joint_names: actuated joints in motor order.
        joints: the actuated joints' degrees of freedom, in motor order.
        angles: their entries in `qpos`.
        joint_range: (nu, 2) [rad].
        torque_limit: (nu,) [N m].
        armature: (nu,) of the motors, and what the physics adds for damping [kg m2].
        diagonal: (nv,) addresses of the mass matrix's diagonal in `data.M`.
        mass: of the character [kg].
        gravity: (3,) [m/s2].
        trunk: body ids whose axes, averaged, are compared with the rolling axis.
        trunk_weights: (len(trunk), 1) their shares of the trunk's mass.
        excluded: (nbody,) True where a body's contacts are held out of control.
        touch: control sees the contacts whose gap is below this [m],
        look_ahead: and those that would close within this time [s]; 0 where it does not look.
        ground: what it stands on.
        absent: joints that this character has not, and poses may name all the same.
    """

    mj: mujoco.MjModel
    mjcf: str
    joint_names: tuple[str, ...]
    joints: slice
    angles: slice
    joint_range: Array
    torque_limit: Array
    armature: Array
    diagonal: NDArray[np.int64]
    mass: float
    gravity: Array
    trunk: NDArray[np.int64]
    trunk_weights: Array
    excluded: NDArray[np.bool_]
    touch: float
    look_ahead: float
    ground: Ground
    absent: tuple[str, ...] = ()

    def hinges(self, body: int) -> tuple[int, int]:
        """First motor of a body's own joints, and how many it has; none of the root."""
        return self._hinges[body]

    @cached_property
    def _hinges(self) -> list[tuple[int, int]]:
        """Of all bodies."""
        firsts = (self.mj.body_dofadr - self.joints.start).tolist()
        found = list(zip(firsts, self.mj.body_dofnum.tolist(), strict=True))
        return [(0, 0)] * (ROOT_BODY + 1) + found[ROOT_BODY + 1 :]

    def motors(self, joint: str, key: str) -> list[int]:
        """Motors of a joint's name; one without a side stands for both.

        Raises:
            InputError: there is no such joint; `key` says where it stands.
        """
        named = (joint, *(joint + side for side in SIDES))
        motors = [i for i, name in enumerate(self.joint_names) if name in named]
        if not motors and _bare(joint) in self.absent:
            return []
        if not motors:
            left, right = SIDES
            bases = sorted(set(map(_bare, self.joint_names)))
            raise InputError(
                f"{key} names the unknown joint {joint!r}; {instead(joint, bases)}, "
                f"limb joints also with {left} or {right}"
            )
        return motors

    def posed(self, angles: Mapping[str, float | Sequence[float]], key: str, rows: int) -> Array:
        """Angles by joint name as rows (rows, nu) in motor order; joints not named are at 0.

        What a chest would bend that this character has not, its waist bends beside its own.

        Raises:
            InputError: there is no such joint; `key` says where it stands.
        """
        found = np.zeros((rows, len(self.joint_names)))
        absent = [name for name in angles if not self.motors(name, key)]
        for name in angles:
            found[:, self.motors(name, key)] = np.asarray(angles[name]).reshape(-1, 1)
        for name in absent:
            group, _, axis = name.partition("_")
            stands_in = f"waist_{axis}"
            if group == "chest" and stands_in in self.joint_names:
                motor = self.joint_names.index(stands_in)
                found[:, motor] += np.asarray(angles[name])
        return found


def _bare(joint: str) -> str:
    """A joint's name without its side."""
    return joint.removesuffix(SIDES[0]).removesuffix(SIDES[1])


def build(
    character: Character,
    terrain: Terrain,
    physics: Physics,
    control_rate: float,
    seed: int = 0,
    reach: float = 60.0,
    vary: Callable[[mujoco.MjSpec], None] = lambda spec: None,
) -> Model:
    """Compile a model.

    Args:
        control_rate: [Hz]; the physics step is 1 / (control_rate * substeps).
        seed: of a terrain that is drawn at random.
        reach: how far ahead of the start there is ground at least [m].
        vary: changes the character before there is a ground.

    Raises:
        InputError: the numbers do not make a model, the model does not stand as tall as it
            says, or a body could touch more of the ground than the engine sees.
    """
    character = grown(character)
    spec = mujoco.MjSpec()
    spec.modelname = character.name
    spec.compiler.degree = False
    physics.set_options(spec, control_rate)
    spec.visual.global_.offwidth = 1920
    spec.visual.global_.offheight = 1080
    ground = terrain.make(np.random.default_rng([seed, TERRAIN_STREAM]), reach)
    add_tiles(spec)
    try:
        add_character(spec, character)
        if character.flesh:
            add_flesh(spec, character.flesh)
        for joint in spec.joints:
            joint.armature += physics.implicit_damping(joint.damping[0], spec.option.timestep)
        for geom in spec.geoms:  # the ground's too, whatever a program makes of two
            geom.friction = [terrain.friction, 0.0, 0.0]
        vary(spec)
        ground.add(spec)
        mj, mjcf = _compiled(spec)
    except ValueError as error:
        reason = str(error).strip().splitlines()[0]
        raise InputError(
            f"character {character.name!r} on terrain {terrain.name!r} does not compile: {reason}"
        ) from None
    _check(mj, character)
    pair_limit.check(mj, character.name, terrain.name)
    trunk = np.array([body_id(mj, name, "character.trunk") for name in character.trunk])
    excluded = np.zeros(mj.nbody, dtype=bool)
    for name in character.exclude_from_control:
        excluded[body_id(mj, name, "character.exclude_from_control")] = True
    hinges = mj.actuator_trnid[:, 0]
    joints = slice(ROOT_DOFS, ROOT_DOFS + mj.nu)
    return Model(
        mj=mj,
        mjcf=mjcf,
        joint_names=tuple(mj.joint(int(j)).name for j in hinges),
        joints=joints,
        angles=slice(joints.start + 1, joints.stop + 1),  # the root's quaternion has one more
        joint_range=mj.jnt_range[hinges].copy(),
        torque_limit=mj.actuator_ctrlrange[:, 1].copy(),
        armature=mj.dof_armature[joints].copy(),
        diagonal=(mj.M_rowadr + mj.M_rownnz - 1).astype(np.int64),
        mass=float(mj.body_subtreemass[ROOT_BODY]),
        gravity=mj.opt.gravity.copy(),
        trunk=trunk,
        trunk_weights=(mj.body_mass[trunk] / mj.body_mass[trunk].sum())[:, None],
        excluded=excluded,
        touch=physics.touch,
        look_ahead=1.0 / control_rate if physics.closing else 0.0,
        ground=ground,
        absent=character.absent,
    )


def _compiled(spec: mujoco.MjSpec) -> tuple[mujoco.MjModel, str]:
    """The model, and the text that says all of it.

    MuJoCo writes six digits a number. So the model is the one that the text describes, and not
    the other way round. The step alone is written in full, as 1/240 s has no six digits.
    """
    spec.compile()
    step = f'timestep="{float(spec.option.timestep)!r}"'  # left out if it is MuJoCo's own
    text = re.sub(r'timestep="[^"]*"', step, spec.to_xml(), count=1)
    return acting(text), text


def acting(mjcf: str) -> mujoco.MjModel:
    """The model of a text without what is only looked at.

    That touches nothing and weighs nothing: the motion has the same bits, and a physics step
    costs a twentieth less.
    """
    spec = mujoco.MjSpec.from_string(mjcf)
    for geom in [geom for geom in spec.geoms if not (geom.contype or geom.conaffinity)]:
        spec.delete(geom)
    return spec.compile()


def _check(mj: mujoco.MjModel, character: Character) -> None:
    hinges = int(is_character(mj)[mj.dof_bodyid].sum()) - ROOT_DOFS
    if mj.nu != hinges:
        raise InputError(
            f"character {character.name!r} has {mj.nu} motors for {hinges} hinges; "
            "every joint but the root needs one"
        )
    data = mujoco.MjData(mj)
    mujoco.mj_forward(mj, data)
    bodies = is_character(mj)[mj.geom_bodyid]
    height = lowest_and_highest(mj, data, bodies)
    if abs(height[1] - height[0] - character.height) > 0.02:
        raise InputError(
            f"character.height is {character.height:g} m, but the bodies stand "
            f"{height[1] - height[0]:.3f} m tall"
        )
    if abs(height[0]) > 0.02:
        raise InputError(
            f"character.root_height={character.root_height:g}: then the soles are at "
            f"{height[0]:.3f} m, they must stand at 0"
        )
