"""One roll, written as other programs write theirs: the same clip each time."""

import re

import mujoco
import numpy as np
import pytest
from captures import adult, bvh_text, in_order
from scipy.spatial.transform import Rotation

from rotctl.cli.clip_wording import import_warnings
from rotctl.cli.main import main
from rotctl.errors import InputError
from rotctl.motion.capture import Y_UP_FACING_Z
from rotctl.motion.glance import turning
from rotctl.motion.importing import import_motion
from rotctl.motion.landmarks import find_landmarks
from rotctl.motion.naming import find_roles
from rotctl.motion.reading import Wishes, read_capture
from rotctl.motion.retarget import retarget
from rotctl.motion.smpl import _SKELETON

CLOSE = 0.02  # [rad]


@pytest.fixture(scope="module")
def roll():
    return in_order("forward_roll", turns=1.0, frames=60)


@pytest.fixture(scope="module")
def plain(roll, tmp_path_factory):
    """The clip of the roll as MotionBuilder would write it."""
    return imported(tmp_path_factory.mktemp("plain") / "a.bvh", bvh_text(roll))


def imported(path, text="", **wishes):
    if text:
        path.write_text(text)
    wishes = Wishes(**wishes)
    return import_motion(adult(), "adult", path, read_capture(path, wishes), wishes=wishes)


def apart(made, other, but=()):
    """The largest difference of two clips' angles [rad]."""
    chosen = [not name.startswith(tuple(but)) if but else True for name in adult().joint_names]
    return np.abs(made.clip.poses(adult()) - other.clip.poses(adult()))[:, chosen].max()


# ---------------------------------------------------------------- the ways of BVH


def below_a_root(text):
    """Bandai-Namco: a node above the hips that stays where it is."""
    skeleton, motion = text.split("MOTION\n")
    skeleton = skeleton.replace("ROOT Actor_Hips", "JOINT Actor_Hips").replace(
        "HIERARCHY\n",
        "HIERARCHY\nROOT World {\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n",
    )
    head, rows = motion.split("\n", 2)[:2], motion.split("\n", 2)[2].splitlines()
    return f"{skeleton}}}\nMOTION\n" + "\n".join([*head, *(f"0 0 0 {row}" for row in rows)])


def z_up(text):
    """Blender: everything about the file's x axis."""
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    text = re.sub(
        r"OFFSET (\S+) (\S+) (\S+)",
        lambda found: "OFFSET {:.6f} {:.6f} {:.6f}".format(
            *(turn @ np.array([float(x) for x in found.groups()]))
        ),
        text,
    )
    # y becomes z, z becomes -y: the order of the axes' names goes along.
    text = re.sub(
        r"CHANNELS .*rotation",
        lambda found: found[0].translate(str.maketrans("YZ", "ZY")),
        text,
    )
    skeleton, motion = text.split("MOTION\n")
    names = re.findall(r"([XYZ])(position|rotation)", skeleton)
    signs = [-1.0 if axis == "Y" else 1.0 for axis, _ in names]
    lines = motion.splitlines()
    rows = [
        " ".join(f"{sign * float(x):.6f}" for sign, x in zip(signs, line.split(), strict=True))
        for line in lines[2:]
    ]
    return f"{skeleton}MOTION\n" + "\n".join([*lines[:2], *rows])


def along_x(text):
    """LAFAN1: every bone lies along its joint's own x, and all angles take that up."""
    skeleton, motion = text.split("MOTION\n")
    opened, parents, offsets = [], [], []
    number = r" ([-\d.]+)"
    words = re.findall(rf"(ROOT|JOINT|End|\}}|OFFSET)(?:{number * 3})?", skeleton)
    for word, *numbers in words:
        if word in ("ROOT", "JOINT"):
            opened.append(len(parents))
            parents.append(opened[-2] if len(opened) > 1 else -1)
        elif word == "End":
            opened.append(-1)
        elif word == "}":
            opened.pop()
        elif opened[-1] >= 0:
            offsets.append([float(x) for x in numbers])
    frames = [Rotation.identity()] * len(parents)  # each joint's new axes, in its old ones
    for j in range(len(parents)):
        children = [k for k, parent in enumerate(parents) if parent == j]
        if children and np.any(offsets[children[0]]):
            frames[j] = Rotation.align_vectors([offsets[children[0]]], [[1.0, 0.0, 0.0]])[0]
    rows = np.array([[float(x) for x in row.split()] for row in motion.splitlines()[2:]])
    column, k = 3, -1
    for j, parent in enumerate(parents):
        above = frames[parent] if parent >= 0 else Rotation.identity()
        offsets[j] = above.inv().apply(offsets[j]) if parent >= 0 else offsets[j]
        if column + 3 > rows.shape[1] or f"hand {j}" in _handless(skeleton):
            continue
        old = Rotation.from_euler("YZX", rows[:, column : column + 3], degrees=True)
        rows[:, column : column + 3] = (above.inv() * old * frames[j]).as_euler(
            "YZX", degrees=True, suppress_warnings=True
        )
        column += 3

    def put(found):
        nonlocal k
        if found[1]:  # of an end
            return found[0]
        k += 1
        return "OFFSET {:.6f} {:.6f} {:.6f}".format(*offsets[k])

    skeleton = re.sub(r"(End Site\s*\{\s*)?OFFSET \S+ \S+ \S+", put, skeleton)
    lines = [" ".join(f"{x:.6f}" for x in row) for row in rows]
    return f"{skeleton}MOTION\n" + "\n".join([*motion.splitlines()[:2], *lines])


def _handless(skeleton):
    """Joints without channels, by number."""
    counts = re.findall(r"CHANNELS (\d)", skeleton)
    return {f"hand {j}" for j, count in enumerate(counts) if count == "0"}


def header_layout(text):
    text = text.replace("MOTION\n", "MOTION\n\n")
    return text.replace("Frames: ", "Frames:").replace("Frame Time: ", "Frame Time:")


def soma(text):
    for side in ("Left", "Right"):
        text = text.replace(f"{side}Leg", f"{side}Shin").replace(f"{side}UpLeg", f"{side}Leg")
    return text


def biped(text):
    names = {"UpLeg": "Thigh", "Leg": "Calf", "ForeArm": "Forearm", "Arm": "UpperArm"}
    for ours, theirs in names.items():
        for side in ("Left", "Right"):
            text = text.replace(f"Actor_{side}{ours}\n", f"Bip01 {side[0]} {theirs}\n")
    return text.replace("Actor_Hips", "Bip01 Pelvis")


def t_pose_first(text):
    head, motion = text.split("Frame Time:")
    rows = motion.splitlines()
    rows[1:1] = [" ".join(["0"] * len(rows[1].split()))]
    count = int(re.search(r"Frames: (\d+)", head)[1])
    head = head.replace(f"Frames: {count}", f"Frames: {count + 1}")
    return f"{head}Frame Time:" + "\n".join(rows)


WAYS = [below_a_root, z_up, along_x, header_layout, soma, biped, t_pose_first]


@pytest.mark.parametrize("way", WAYS)
def test_another_program_wrote_it(roll, plain, tmp_path, way):
    made = imported(tmp_path / "a.bvh", way(bvh_text(roll)))
    assert made.clip.roll_about == "left"
    if way is along_x:  # they do not say where a face points: on average, where the chest does
        assert apart(made, plain, but=("neck", "ankle")) < 0.06  # the phase is the whole body's
    else:
        assert apart(made, plain) < CLOSE
    assert made.speed == pytest.approx(plain.speed, abs=0.01)
    assert made.false_start == (way is t_pose_first)
    assert made.up == ("z" if way is z_up else "y")


def test_up_is_as_told(roll, plain, tmp_path):
    made = imported(tmp_path / "a.bvh", z_up(bvh_text(roll)), up="y")
    assert made.up == "y"
    assert abs(made.speed) < 0.5 < plain.speed


def test_a_cut_is_as_the_whole(tmp_path):
    # Arms over the head, elbows bent: from the zero pose another arm is nearer.
    model, names = adult(), adult().joint_names
    positions = in_order("forward_roll", turns=1.2, frames=90)
    for joint, angle in (("shoulder_y", 2.4), ("shoulder_x", 0.3), ("elbow", 2.1)):
        for side in "lr":
            positions[:, 7 + names.index(f"{joint}_{side}")] = angle
    path = tmp_path / "a.bvh"
    path.write_text(bvh_text(positions))
    for cycle in (None, (0.0, 1.0), (0.35, 1.35)):
        made = import_motion(model, "adult", path, read_capture(path), cycle)
        assert np.degrees(np.median(made.error, axis=0)).max() < 1.0
        assert not import_warnings(made)


def test_no_arm_is_stuck():
    """Arms that the character can take, of which a third were stuck from the zero pose."""
    model, names = adult(), adult().joint_names
    generator = np.random.default_rng(7)
    ranges = {"shoulder_y": (-40, 160), "shoulder_x": (-20, 80), "shoulder_z": (-80, 80)}
    ranges["elbow"] = (5, 140)
    for _ in range(12):
        positions = in_order("forward_roll", turns=0.01, frames=2)
        for joint, bounds in ranges.items():
            for side in "lr":
                positions[:, 7 + names.index(f"{joint}_{side}")] = np.radians(
                    generator.uniform(*bounds)
                )
        assert np.degrees(retarget(model, _marks(positions)).error.max()) < 3.0


def _marks(positions):
    """Landmarks of our own character."""
    from rotctl.motion.landmarks import BALL, Landmarks

    mj = adult().mj
    data, rows = mujoco.MjData(mj), []
    for position in positions:
        data.qpos[:] = position
        mujoco.mj_kinematics(mj, data)

        def point(body, along=(0.0, 0.0, 0.0)):
            return data.body(body).xpos + data.body(body).xmat.reshape(3, 3) @ np.array(along)

        points = {
            "hips": point("pelvis"), "spine": point("pelvis", (0, 0, 0.1)), "chest": point("chest"),
            "neck": point("chest", (0, 0, 0.29)), "head": point("head"),
            "crown": point("head", (0, 0, 1.0)), "nose": point("head", (1.0, 0, 0)),
        }  # fmt: skip
        for s in "lr":
            points |= {
                f"hip_{s}": point(f"thigh_{s}"), f"knee_{s}": point(f"shin_{s}"),
                f"ankle_{s}": point(f"foot_{s}"), f"ball_{s}": point(f"foot_{s}", BALL),
                f"shoulder_{s}": point(f"upper_arm_{s}"), f"elbow_{s}": point(f"forearm_{s}"),
                f"wrist_{s}": point(f"forearm_{s}", (0, 0, -0.25)),
            }  # fmt: skip
        rows.append(points)
    points = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    return Landmarks(points, 0.86, {}, np.eye(3))


def test_a_cartwheel_is_a_kind_of_its_own(tmp_path):
    # The body upright and spread, turned about its own front while it goes sideways.
    names = adult().joint_names
    places = np.linspace(0.0, 1.0, 60)
    positions = np.zeros((60, adult().mj.nq))
    positions[:, 1], positions[:, 2] = 2.0 * places, 1.0
    positions[:, 3:7] = Rotation.from_rotvec(np.outer(-2 * np.pi * places, [1.0, 0, 0])).as_quat(
        scalar_first=True
    )
    for side in "lr":
        positions[:, 7 + names.index(f"shoulder_y_{side}")] = 2.8
    made = imported(tmp_path / "a.bvh", bvh_text(positions))
    assert made.clip.roll_about == "face"
    assert made.doubt < 0.1
    assert made.mirrored != imported(tmp_path / "b.bvh", bvh_text(positions[::-1])).mirrored


def test_a_walk_is_refused_before_it_is_fitted(tmp_path, monkeypatch):
    monkeypatch.setattr("rotctl.motion.importing.retarget", None)
    walk = np.repeat(in_order("forward_roll", turns=1.0, frames=2)[:1], 60, axis=0)
    walk[:, 0] = np.linspace(0.0, 2.0, 60)
    with pytest.raises(InputError, match=r"no roll found: the body turns 0\.00 rev at most; give"):
        imported(tmp_path / "a.bvh", bvh_text(walk))
    spin = Rotation.from_rotvec(np.outer(np.linspace(0, 9, 60), [0, 0, 1.0]))
    quaternions = Rotation.from_quat(walk[:, 3:7], scalar_first=True)
    walk[:, 3:7] = (spin * quaternions).as_quat(scalar_first=True)
    with pytest.raises(InputError, match=r"at most, and 1\.4\d rev about the vertical; give"):
        imported(tmp_path / "b.bvh", bvh_text(walk))


def test_the_points_turn_as_a_rigid_body_does(tmp_path):
    path = tmp_path / "a.bvh"
    positions = np.repeat(in_order("log_roll", turns=0.1, frames=2)[:1], 30, axis=0)
    turn = Rotation.from_rotvec(np.outer(np.linspace(0.0, 3.0, 30), [0.6, 0.8, 0.0]))
    quaternions = turn * Rotation.from_quat(positions[:, 3:7], scalar_first=True)
    positions[:, 3:7] = quaternions.as_quat(scalar_first=True)
    path.write_text(bvh_text(positions))
    turned = turning(find_landmarks(path, read_capture(path)))
    assert turned[-1] == pytest.approx([1.8, 2.4, 0.0], abs=0.02)


# ---------------------------------------------------------------- names


def chain(*names):
    return {name: parent for parent, name in zip(("", *names), names, strict=False)}


LIMBS = [
    "J_Bip_L_UpperLeg J_Bip_L_LowerLeg J_Bip_L_Foot J_Bip_L_UpperArm J_Bip_L_LowerArm J_Bip_L_Hand",
    "m_avg_L_Hip m_avg_L_Knee m_avg_L_Ankle m_avg_L_Shoulder m_avg_L_Elbow m_avg_L_Wrist",
    "upperleg01.L lowerleg01.L foot.L upperarm01.L lowerarm01.L wrist.L",
    "LThigh LShin LFoot LUArm LFArm LHand",
    "lThighBend lShin lFoot lShldrBend lForearmBend lHand",
    "Bip01,L,Thigh Bip01,L,Calf Bip01,L,Foot Bip01,L,UpperArm Bip01,L,Forearm Bip01,L,Hand",
    "left_hip_pitch_link left_knee_link left_ankle_roll_link "
    "left_shoulder_yaw_link left_elbow_link left_wrist_yaw_link",
    "LeftHip b2 b3 LeftShoulder b4 b5",  # by the chain
]


@pytest.mark.parametrize("limbs", LIMBS)
def test_joints_by_name_and_by_chain(tmp_path, limbs):
    names = [name.replace(",", " ") for name in limbs.split()]
    left, arm = names[:3], names[3:]
    parents = {"root": ""}
    for names in (left, arm):
        both = (names, [_other(name) for name in names])
        for side in both:
            parents |= {n: p for p, n in zip(("root", *side), side, strict=False)}
    parents |= chain("root", "neck", "head")
    roles = find_roles(tmp_path, parents)
    assert [roles[f"left_{part}"] for part in ("hip", "knee", "ankle")] == left
    assert [roles[f"left_{part}"] for part in ("shoulder", "elbow", "wrist")] == arm
    assert roles["right_hip"] == _other(left[0])
    assert roles["hips"] == "root"


def _other(name):
    for one in ("Left Right", "left right", "_L_ _R_", ".L .R"):
        if one.split()[0] in name:
            return name.replace(*one.split())
    if " L " in name:
        return name.replace(" L ", " R ")
    if name.startswith("L"):
        return "R" + name[1:]
    return "r" + name[1:]


def test_smpl_has_an_ankle_and_a_foot(tmp_path):
    roles = find_roles(tmp_path, {name: parent for name, (parent, _) in _SKELETON.items()})
    assert (roles["left_ankle"], roles["left_ball"]) == ("left_ankle", "left_foot")


def test_what_is_told_counts(roll, plain, tmp_path, capsys):
    path = tmp_path / "a.bvh"
    path.write_text(bvh_text(roll).replace("Actor_LeftUpLeg", "Bone_7"))
    arguments = ["import-motion", str(path), "--out", str(tmp_path / "a.yaml")]
    assert main([*arguments, "--map", "left_hip=Bone_7"]) == 0
    assert "Bone_7, Actor_LeftLeg" in capsys.readouterr().out
    assert main([*arguments, "--map", "left_hip=Bone_8"]) == 2
    assert "--map left_hip=Bone_8: no such joint; its joints: Actor_Hips" in capsys.readouterr().err
    told = ["--map", "left_hip=Bone_7", "--map", "left_knee=Actor_RightLeg"]
    assert main([*arguments, *told]) == 2
    why = "does not hang on Bone_7, the left_hip"
    assert capsys.readouterr().err == f"rotctl: {path}: --map left_knee=Actor_RightLeg: {why}\n"
    with pytest.raises(SystemExit):
        main([*arguments, "--map", "hip=Bone_7"])
    assert "'hip=Bone_7': valid: ROLE=NAME, of hips, chest" in capsys.readouterr().err


# ---------------------------------------------------------------- other files


def smpl(positions):
    """Our character's motion as rotation vectors of SMPL's joints (n, 22, 3)."""
    mj = adult().mj
    data = mujoco.MjData(mj)
    stands = Rotation.from_matrix(Y_UP_FACING_Z)  # SMPL's axes in ours
    ours = {
        "pelvis": "pelvis", "spine1": "waist", "spine2": "waist", "spine3": "chest",
        "neck": "chest", "head": "head", "left_collar": "chest", "right_collar": "chest",
    }  # fmt: skip
    for side, word in (("l", "left"), ("r", "right")):
        for theirs, body in (
            ("hip", "thigh"), ("knee", "shin"), ("ankle", "foot"), ("foot", "foot"),
            ("shoulder", "upper_arm"), ("elbow", "forearm"), ("wrist", "forearm"),
        ):  # fmt: skip
            ours[f"{word}_{theirs}"] = f"{body}_{side}"
    vectors = np.empty((len(positions), len(_SKELETON), 3))
    for i, position in enumerate(positions):
        data.qpos[:] = position
        mujoco.mj_kinematics(mj, data)
        world = {}
        for k, (name, (parent, _)) in enumerate(_SKELETON.items()):
            turned = Rotation.from_matrix(data.body(ours[name]).xmat.reshape(3, 3)) * stands
            if "shoulder" in name or "elbow" in name or "wrist" in name:
                side = 1.0 if name.startswith("left") else -1.0  # from sideways to hanging
                turned = turned * Rotation.from_rotvec([0.0, 0.0, -side * np.pi / 2])
            world[name] = turned
            vectors[i, k] = (world[parent].inv() * turned if parent else turned).as_rotvec()
    return vectors


@pytest.mark.parametrize("rate", ["mocap_framerate", "mocap_frame_rate", "fps"])
def test_smpl_by_its_rate(roll, plain, tmp_path, rate):
    path = tmp_path / "a.npz"
    vectors = smpl(roll).reshape(len(roll), -1)
    if rate == "fps":  # SMPL-X in parts, as AMASS has it now
        parts = {"root_orient": vectors[:, :3], "pose_body": vectors[:, 3:66]}
    else:  # SMPL-H with its hands
        parts = {"poses": np.hstack([vectors, np.zeros((len(roll), 90))])}
    np.savez(path, trans=roll[:, :3], gender=np.array("female"), **parts, **{rate: 60.0})
    made = imported(path)
    # Its feet point a little lower, its neck and its spine are straight.
    assert apart(made, plain, but=("ankle", "waist", "chest", "neck")) < CLOSE
    assert made.speed == pytest.approx(plain.speed * 0.8595 / 0.81, abs=0.02)  # by the legs
    assert made.clip.rate == pytest.approx(plain.clip.rate, abs=0.01)


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    path = tmp_path_factory.mktemp("robot") / "robot.xml"
    path.write_text(adult().mjcf)
    return path


def table(roll, how):
    root = np.roll(roll[:, 3:7], -1, axis=1)
    columns = np.hstack([roll[:, :3], root, roll[:, 7:]])
    if how == "counted":
        columns = np.hstack([np.arange(len(roll))[:, None], columns])
    lines = [",".join(f"{x:.6f}" for x in row) for row in columns]
    if how == "named":
        names = [adult().mj.joint(j).name for j in range(1, adult().mj.njnt)]
        order = np.random.default_rng(1).permutation(len(names))
        head = ["x", "y", "z", "qw", "qx", "qy", "qz", *(names[k] for k in order)]
        columns = np.hstack([roll[:, :7], roll[:, 7:][:, order]])
        lines = [",".join(head), *(",".join(f"{x:.6f}" for x in row) for row in columns)]
    return "\n".join(lines)


@pytest.mark.parametrize("how", ["plain", "counted", "named"])
def test_a_robots_csv(roll, plain, robot, tmp_path, how):
    made = imported(tmp_path / "a.csv", table(roll, how), model=robot, rate=60.0)
    assert apart(made, plain, but=("ankle", "waist", "chest", "neck")) < CLOSE
    assert made.roles["left_wrist"] == "forearm_l end"


@pytest.mark.parametrize(
    ("column", "called", "why"),
    [
        ("knee_l", "left_knee", "'left_knee' is none of them"),
        ("knee_l", "knee_r", "one is missing or comes twice"),
    ],
)
def test_names_that_are_in_part_the_robots_are_told(roll, robot, tmp_path, column, called, why):
    """The model's order was taken, and joints were others."""
    path = tmp_path / "a.csv"
    with pytest.raises(InputError) as refused:
        imported(path, table(roll, "named").replace(column, called), model=robot)
    told = (
        f"{path}: names of joints that are only in part the model's: {why}; its joints: waist_y, "
    )
    assert str(refused.value).startswith(told)


def test_a_robots_angles_in_degrees_are_told(roll, robot, tmp_path):
    degrees = np.hstack([roll[:, :7], np.degrees(roll[:, 7:])])
    np.savez(tmp_path / "a.npz", qpos=degrees, frequency=60.0)
    with pytest.raises(InputError) as refused:
        imported(tmp_path / "a.npz", model=robot)
    most = np.degrees(np.abs(roll[:, 7]).max())
    told = f"{tmp_path / 'a.npz'}: waist_y is at {most:.0f} rad; are its angles degrees?"
    assert str(refused.value) == told


@pytest.mark.parametrize("how", ["qpos", "by level", "by depth", "dof_pos"])
def test_a_robots_npz(roll, plain, robot, tmp_path, how):
    mj, path = adult().mj, tmp_path / "a.npz"
    if how == "qpos":
        np.savez(path, qpos=roll, frequency=60.0)
    elif how == "dof_pos":
        np.savez(path, root_pos=roll[:, :3], root_rot=np.roll(roll[:, 3:7], -1, axis=1),
                 dof_pos=roll[:, 7:], fps=60)  # fmt: skip
    else:
        depth = [0] * mj.nbody
        for b in range(1, mj.nbody):
            depth[b] = depth[mj.body_parentid[b]] + 1
        bodies = list(range(1, mj.nbody))
        if how == "by level":
            bodies.sort(key=depth.__getitem__)
        order = [j - 1 for b in bodies for j in range(1, mj.njnt) if mj.jnt_bodyid[j] == b]
        data, places, turned = mujoco.MjData(mj), [], []
        for position in roll:
            data.qpos[:] = position
            mujoco.mj_kinematics(mj, data)
            places.append(data.xpos[bodies].copy())
            turned.append(data.xquat[bodies].copy())
        np.savez(path, joint_pos=roll[:, 7:][:, order], body_pos_w=places, body_quat_w=turned,
                 fps=np.array([60]))  # fmt: skip
    made = imported(path, model=robot)
    assert apart(made, plain, but=("ankle", "waist", "chest", "neck")) < CLOSE


def test_a_file_of_another_robot_is_told(roll, robot, tmp_path):
    mj = adult().mj
    places = np.zeros((60, mj.nbody - 1, 3))
    turned = np.tile([1.0, 0, 0, 0], (60, mj.nbody - 1, 1))
    bodies = {"body_pos_w": places, "body_quat_w": turned}
    np.savez(tmp_path / "a.npz", joint_pos=roll[:, 7:], fps=30, **bodies)
    with pytest.raises(InputError, match=r"its bodies are 0\.\d\d m from where its 29 joints put"):
        imported(tmp_path / "a.npz", model=robot)


class Spy:
    def __reduce__(self):
        return (open, ("spied", "w"))


@pytest.mark.parametrize("option", ["skeleton", "model", "up"])
def test_what_is_of_another_kind_of_file_is_refused(tmp_path, capsys, option):
    kind = {"skeleton": "bvh", "model": "bvh", "up": "csv"}[option]
    of = {"skeleton": ".amc; others have their own", "model": ".npz and .csv", "up": ".bvh; other"}
    value = "x" if option == "up" else "nowhere"
    words = ["import-motion", f"a.{kind}", f"--{option}", value, "--out", str(tmp_path / "a.yaml")]
    assert main(words) == 2
    assert capsys.readouterr().err.startswith(f"rotctl: --{option}={value}: is for {of[option]}")


def test_objects_are_never_loaded(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.savez("a.npz", poses=np.array([Spy()], dtype=object), trans=np.zeros((1, 3)), fps=30)
    with pytest.raises(InputError, match=r"^a\.npz: poses is damaged, or holds Python objects$"):
        imported(tmp_path.joinpath("a.npz").relative_to(tmp_path))
    with pytest.raises(InputError, match=r"^a\.pkl: a pickle can run any program when it is read;"):
        imported(tmp_path.joinpath("a.pkl").relative_to(tmp_path))
    assert not (tmp_path / "spied").exists()


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        ({"poses": np.zeros((9, 66))}, "no frame rate (mocap_framerate, mocap_frame_rate, fps"),
        ({"poses": np.zeros((9, 66)), "fps": 0.0}, "fps is 0, valid: 1 to 10000 Hz"),
        ({"poses": np.zeros((9, 60)), "fps": 30}, "poses has 60 columns, three a joint and 66"),
        ({"poses": np.full((9, 66), np.nan), "fps": 30}, "poses holds what is no number"),
        ({"poses": np.zeros((9, 66)), "trans": np.zeros((8, 3)), "fps": 30},
         "trans is (8, 3), expected 9 x 3"),
        ({"qpos": np.zeros((9, 36))}, "has a robot's joints; name it with --model robot.xml"),
        ({"a": np.zeros(3)}, "has neither poses nor root_orient and pose_body; it has: a"),
    ],
)  # fmt: skip
def test_malformed_npz(tmp_path, content, complaint):
    np.savez(tmp_path / "a.npz", **content)
    with pytest.raises(InputError) as error:
        imported(tmp_path / "a.npz")
    assert complaint in str(error.value)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("<robot/>", "must be MJCF, <mujoco>; it is a URDF; save it as MJCF"),
        ("<mujoco><include file='/etc/passwd'/></mujoco>", "has <include>; save the model whole"),
        ("<!DOCTYPE a><mujoco/>", "has a document type; a model needs none"),
        ("<mujoco><worldbody><body><joint/></body></worldbody></mujoco>",
         "its first joint must be the root's freejoint"),
        ("<mujoco><worldbody><body><freejoint/><body><joint name='a' type='ball'/></body></body>"
         "</worldbody></mujoco>", "joint 'a' is a ball joint; only hinges can be used"),
    ],
)  # fmt: skip
def test_a_model_that_is_none(tmp_path, text, complaint):
    robot = tmp_path / "robot.xml"
    robot.write_text(text)
    with pytest.raises(InputError) as error:
        imported(tmp_path / "a.csv", "1,2", model=robot)
    assert f"{robot}: {complaint}" in str(error.value)


def test_cmu_has_one_skeleton_for_all(tmp_path):
    amc = tmp_path / "01_02.amc"
    amc.write_text("x")
    with pytest.raises(InputError) as error:
        read_capture(amc)
    assert str(error.value) == (
        f"{amc}: no 01_02.asf or 01.asf beside it; give --skeleton FILE.asf"
    )
    (tmp_path / "01.asf").write_text("x")
    with pytest.raises(InputError, match=r"01\.asf: no hierarchy for: no bones"):
        read_capture(amc)
