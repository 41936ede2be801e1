"""The built character: its mass, size, symmetry and motors, and what is refused."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from rotctl.errors import InputError
from rotctl.mechanics import compilation
from rotctl.mechanics.character import Geom
from rotctl.mechanics.compilation import acting
from rotctl.mechanics.momentum import read_momentum


def rebuilt(world, **changes):
    """The model with changed character settings."""
    config = world.config
    character = replace(config.character, **changes)
    return compilation.build(character, config.terrain, config.physics, config.controller.rate)


def with_body(world, name, **changes):
    """The character's bodies with one of them changed."""
    return tuple(
        replace(body, **changes) if body.name == name else body
        for body in world.config.character.bodies
    )


def joint_values(model, values):
    pose = np.zeros(len(model.joint_names))
    for name, value in values.items():
        pose[model.joint_names.index(name)] = value
    return pose


def mirrored(model, pose):
    """The same posture seen in the mirror plane y = 0: sides swapped, bends reversed."""
    other = np.empty_like(pose)
    for i, name in enumerate(model.joint_names):
        if name.endswith(("_l", "_r")):
            twin = name[:-1] + ("r" if name.endswith("l") else "l")
            other[model.joint_names.index(twin)] = pose[i]
        else:
            other[i] = pose[i] if name.endswith("_y") else -pose[i]
    return other


def momentum_in(model, pose, rates=None):
    data = mujoco.MjData(model.mj)
    data.qpos[:7] = [0, 0, 5, 1, 0, 0, 0]
    data.qpos[7:] = pose
    if rates is not None:
        data.qvel[6:] = rates
    mujoco.mj_step1(model.mj, data)
    return read_momentum(model.mj, data)


def test_mass(world):
    assert world.model.mass == pytest.approx(world.config.character.mass, rel=1e-9)
    assert world.mj.body_mass[1:].sum() == pytest.approx(world.model.mass, rel=1e-12)


def test_mass_shares(world):
    """Every geom weighs its share; a body's inertia is that of its geoms."""
    character = world.config.character
    for body in character.bodies:
        for side in ("_l", "_r") if body.mirror else ("",):
            share = sum(geom.mass for geom in body.geoms)
            found = world.mj.body(body.name + side).mass[0]
            assert found == pytest.approx(share * character.mass, rel=1e-9)


def standing_height(world):
    """Lowest and highest z [m] of the ends of all spheres and capsules."""
    data = mujoco.MjData(world.mj)
    mujoco.mj_forward(world.mj, data)
    z = []
    for geom in range(world.mj.ngeom):
        if world.mj.geom_bodyid[geom] > 0:
            half = data.geom_xmat[geom].reshape(3, 3)[2, 2] * world.mj.geom_size[geom][1]
            ends = data.geom_xpos[geom][2] + np.array([-half, half])
            z += [*(ends - world.mj.geom_size[geom][0]), *(ends + world.mj.geom_size[geom][0])]
    return float(min(z)), float(max(z))


def test_height(world):
    soles, crown = standing_height(world)
    assert crown - soles == pytest.approx(world.config.character.height, abs=0.02)
    assert soles == pytest.approx(0.0, abs=0.02)


def test_a_mirrored_pose_has_mirrored_mechanics(world):
    rng = np.random.default_rng(0)
    low, high = world.model.joint_range.T
    flip = np.diag([1.0, -1.0, 1.0])
    for _ in range(10):
        pose = rng.uniform(low, high)
        rates = rng.normal(size=len(pose))
        here = momentum_in(world.model, pose, rates)
        there = momentum_in(world.model, mirrored(world.model, pose), mirrored(world.model, rates))
        assert there.com == pytest.approx(flip @ here.com, abs=1e-12)
        assert there.linear == pytest.approx(flip @ here.linear, abs=1e-10)
        assert there.angular == pytest.approx(-flip @ here.angular, abs=1e-10)  # pseudo-vector
        assert np.abs(there.inertia - flip @ here.inertia @ flip).max() < 1e-11
        assert abs(here.com[1]) > 1e-4  # the pose was not symmetric itself


def test_left_and_right_have_the_same_limits(world):
    model = world.model
    for i, name in enumerate(model.joint_names):
        if name.endswith("_l"):
            twin = model.joint_names.index(name[:-1] + "r")
            assert model.joint_range[i] == pytest.approx(model.joint_range[twin], abs=0)
            assert model.torque_limit[i] == model.torque_limit[twin]


def test_motor_i_drives_dof_6_plus_i(world):
    """A torque on one motor alone pushes that hinge alone."""
    data = mujoco.MjData(world.mj)
    assert world.mj.nu == world.mj.nv - 6 == len(world.model.joint_names)
    for i, name in enumerate(world.model.joint_names):
        assert world.mj.joint(name).dofadr[0] == 6 + i
        assert world.mj.joint(name).qposadr[0] == 7 + i
        data.ctrl[:] = 0
        data.ctrl[i] = 2.0
        mujoco.mj_forward(world.mj, data)
        assert data.qfrc_actuator.tolist() == [
            *[0.0] * (6 + i),
            2.0,
            *[0.0] * (world.mj.nu - i - 1),
        ]


def test_limits_come_from_the_config(world):
    model, found = world.model, 0
    for body in world.config.character.bodies:
        for joint in body.joints:
            for side in ("_l", "_r") if body.mirror else ("",):
                i = model.joint_names.index(joint.name + side)
                assert model.torque_limit[i] == joint.torque
                assert model.joint_range[i] == pytest.approx(joint.range, abs=0)
                found += 1
    assert found == len(model.joint_names)
    assert world.mj.actuator_ctrlrange[:, 0] == pytest.approx(-model.torque_limit, abs=0)
    assert world.mj.actuator_ctrllimited.all()
    assert world.mj.jnt_limited[1:].all()


def test_flexing_a_knee_brings_the_heel_back(world):
    """Signs of the pose angles: positive hip lifts the leg forward, knee bends backward."""
    model = world.model

    def foot(values):
        data = mujoco.MjData(world.mj)
        data.qpos[7:] = joint_values(model, values)
        mujoco.mj_kinematics(world.mj, data)
        return data.body("foot_l").xpos - data.body("pelvis").xpos

    standing = foot({})
    assert foot({"knee_l": 1.0})[0] < standing[0] - 0.2
    assert foot({"hip_y_l": 1.0})[0] > standing[0] + 0.2
    assert foot({"hip_x_l": 0.5})[1] > standing[1] + 0.1  # outward for a left leg


def test_head_is_excluded_and_nothing_else(world):
    names = {world.mj.body(int(i)).name for i in np.flatnonzero(world.model.excluded)}
    assert names == set(world.config.character.exclude_from_control)


def test_neighbours_and_unlisted_bodies_do_not_collide(world):
    """Only the listed pairs: the character's geoms do not collide by contype."""
    chosen = world.mj.geom_bodyid > 0
    contype, conaffinity = world.mj.geom_contype[chosen], world.mj.geom_conaffinity[chosen]
    assert not (contype[:, None] & conaffinity[None]).any()
    pairs = {
        frozenset(
            world.mj.body(int(world.mj.geom_bodyid[g])).name
            for g in (world.mj.pair_geom1[i], world.mj.pair_geom2[i])
        )
        for i in range(world.mj.npair)
    }
    assert frozenset({"thigh_l", "thigh_r"}) in pairs
    assert frozenset({"thigh_l", "chest"}) in pairs
    assert frozenset({"thigh_l", "shin_l"}) not in pairs
    assert all(len(pair) == 2 for pair in pairs)  # no body with itself


def test_massless_geoms_touch_nothing(world):
    shown = Geom(name="hat", size=0.01, start=(0.0, 0.0, 0.2), mass=0.0)
    (head,) = (body for body in world.config.character.bodies if body.name == "head")
    model = rebuilt(world, bodies=with_body(world, "head", geoms=(*head.geoms, shown)))
    shown = mujoco.MjModel.from_xml_string(model.mjcf)
    hat = shown.geom("hat")
    assert (hat.contype[0], hat.conaffinity[0]) == (0, 0)
    assert hat.id not in {*shown.pair_geom1, *shown.pair_geom2}
    assert "hat" not in {model.mj.geom(i).name for i in range(model.mj.ngeom)}
    assert model.mass == pytest.approx(world.model.mass, rel=1e-12)


def test_model_text_is_the_model(world):
    again = acting(world.model.mjcf)
    for name in ("body_mass", "body_inertia", "jnt_range", "actuator_ctrlrange", "geom_size"):
        assert getattr(again, name) == pytest.approx(getattr(world.mj, name), rel=1e-5, abs=1e-7)
    assert again.opt.timestep == pytest.approx(world.mj.opt.timestep, rel=1e-5)


def test_diagonal_addresses(world):
    data = world.data(*world.in_the_air())
    full = np.zeros((world.mj.nv, world.mj.nv))
    mujoco.mj_fullM(world.mj, data, full)
    assert data.M[world.model.diagonal] == pytest.approx(np.diag(full), abs=0)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"self_collision": (("thigh", "tail"),)},
            "character.self_collision names the unknown body 'tail'; bodies: pelvis, waist, "
            "chest, head, upper_arm, forearm, thigh, shin, foot",
        ),
        (
            {"trunk": ("torso",)},
            "character.trunk names the unknown body 'torso'; bodies: pelvis, waist, chest, head, "
            "upper_arm_l, forearm_l, upper_arm_r, forearm_r, thigh_l, shin_l, foot_l, thigh_r, "
            "shin_r, foot_r",
        ),
        (
            {"exclude_from_control": ("face",)},
            "character.exclude_from_control names the unknown body 'face'; bodies: pelvis, waist, "
            "chest, head, upper_arm_l, forearm_l, upper_arm_r, forearm_r, thigh_l, shin_l, foot_l, "
            "thigh_r, shin_r, foot_r",
        ),
    ],
)
def test_unknown_names(world, changes, message):
    with pytest.raises(InputError) as error:
        rebuilt(world, **changes)
    assert str(error.value) == message


def test_more_than_can_be_simulated_is_refused(world):
    character = world.config.character
    foot = next(body for body in character.bodies if body.name == "foot")
    many = tuple(replace(foot.geoms[0], name=f"g{i}") for i in range(200))
    hinged = replace(foot, joints=foot.joints[:1] * 200)
    for bodies, complaint in (
        ((foot,) * 200, "has 400 bodies; at most 300"),
        ((hinged,), "has 400 joints; at most 200"),
        ((replace(foot, geoms=many * 12),), "has 4800 geoms; at most 4500"),
        ((replace(foot, geoms=many),), "has 40000 pairs of geoms in self_collision; at most 20000"),
    ):
        with pytest.raises(ValueError, match=f"{complaint} can be simulated"):
            replace(character, bodies=bodies)


def test_wrong_height(world):
    soles, crown = standing_height(world)
    with pytest.raises(InputError) as error:
        rebuilt(world, height=1.5, drawn=None)
    assert str(error.value) == (
        f"character.height is 1.5 m, but the bodies stand {crown - soles:.3f} m tall"
    )


def test_unknown_parent(world):
    bodies = with_body(world, "head", parent="neck")
    with pytest.raises(InputError) as error:
        rebuilt(world, bodies=bodies)
    assert str(error.value) == (
        "character body 'head' hangs on the unknown parent 'neck'; "
        "bodies before it: pelvis, waist, chest"
    )


def test_what_mujoco_refuses_is_one_line(world):
    bodies = (*world.config.character.bodies, world.config.character.bodies[-1])
    with pytest.raises(
        InputError, match=r"^character 'adult' on terrain 'flat' does not compile: .*foot"
    ) as error:
        rebuilt(world, bodies=bodies)
    assert "\n" not in str(error.value)


def test_height_within_two_centimetres_passes(world):
    soles, crown = standing_height(world)
    rebuilt(world, height=crown - soles + 0.019, drawn=None)
    with pytest.raises(InputError, match="tall"):
        rebuilt(world, height=crown - soles + 0.021, drawn=None)
