"""Character, ground and physics options compiled into one model."""

import re
from collections.abc import Callable

import mujoco
import numpy as np

from rotctl.errors import InputError
from rotctl.mechanics import pair_limit
from rotctl.mechanics.assembly import add_character
from rotctl.mechanics.bodies import ROOT_BODY, body_id, is_character, lowest_and_highest
from rotctl.mechanics.character import Character
from rotctl.mechanics.flesh import add_flesh
from rotctl.mechanics.model import ROOT_DOFS, Model
from rotctl.mechanics.physics import Physics
from rotctl.mechanics.stature import grown
from rotctl.mechanics.terrain import Terrain, add_tiles

TERRAIN_STREAM = 1  # the start is drawn from the seed alone, the terrain from this beside it


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
