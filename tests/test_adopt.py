"""A foreign humanoid as a character: hung on its pelvis, straightened, with our names and signs."""

from itertools import product
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest
import yaml
from captures import adult
from scipy.spatial.transform import Rotation

from rotctl.adopting import adopt
from rotctl.adopting.meshes import box
from rotctl.behaviours.rolling.waiting import Waiting
from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.mechanics.character import Character
from rotctl.mechanics.stature import grown
from rotctl.motion import Clip, ReferenceSettings, make_reference_pair
from rotctl.motion.author import Keys, author
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build
from rotctl.settings.checking import checked
from rotctl.simulation.sampling import draw
from rotctl.simulation.start import Posture, StartSettings

# The tree hangs on the chest, the arms are out to the sides, elbows bent, motors have gears.
LEG = """
<body name="{side}_thigh" pos="0 {y} -0.05">
  <joint name="{side}_hip_x" axis="1 0 0" range="-30 60"/>
  <joint name="{side}_hip_y" axis="0 1 0" range="-120 30"/>
  <geom type="capsule" size="0.06" fromto="0 0 0 0 0 -0.35" mass="5"/>
  <body name="{side}_shin" pos="0 0 -0.4"><joint name="{side}_knee" axis="0 -1 0" range="-150 2"/>
    <geom type="capsule" size="0.05" fromto="0 0 0 0 0 -0.33" mass="3"/>
    <body name="{side}_foot" pos="0 0 -0.4"><joint name="{side}_ankle" axis="0 1 0" range="-40 40"/>
      <geom type="box" size="0.1 0.04 0.03" pos="0.05 0 -0.03" mass="1"/></body></body></body>"""
ARM = """
<body name="{side}_upper_arm" pos="0 {y} 0.15">
  <joint name="{side}_shoulder_1" axis="1 0 0" range="-170 170"/>
  <joint name="{side}_shoulder_2" axis="0 1 0" range="-170 170"/>
  <geom type="capsule" size="0.04" fromto="0 0 0 0 {out} 0" mass="2"/>
  <body name="{side}_lower_arm" pos="0 {out} 0"><joint name="{side}_elbow" axis="0 0 1"
    range="-160 160"/>
    <geom type="capsule" size="0.03" fromto="0 0 0 0.25 0 0" mass="1"/></body></body>"""
MODEL = """<mujoco><compiler angle="degree"/><option timestep="0.002"/><worldbody>
<body name="torso" pos="0 0 1.2"><freejoint/>
  <geom type="capsule" size="0.11" fromto="0 -0.08 0.05 0 0.08 0.05" mass="12"/>
  <body name="head" pos="0 0 0.25"><joint name="nod" axis="0 1 0" range="-40 40"/>
    <geom type="sphere" size="0.1" pos="0 0 0.1" mass="4"/></body>
  <body name="pelvis" pos="0 0 -0.2"><joint name="belly" axis="0 1 0" range="-75 30"
    pos="0 0 0.1"/>
    <geom type="capsule" size="0.1" fromto="0 -0.07 0 0 0.07 0" mass="10"/>{legs}</body>{arms}
</body></worldbody><actuator>{motors}</actuator></mujoco>"""


def text(**changes):
    sides = {"left": 1, "right": -1}
    legs = "".join(LEG.format(side=s, y=0.1 * k) for s, k in sides.items())
    arms = "".join(ARM.format(side=s, y=0.18 * k, out=0.28 * k) for s, k in sides.items())
    joints = ["belly", *(f"{s}_{j}" for s in sides for j in ("hip_x", "hip_y", "knee", "ankle"))]
    motors = "".join(f'<motor joint="{j}" gear="40" ctrlrange="-2 2"/>' for j in joints)
    whole = MODEL.format(legs=legs, arms=arms, motors=motors)
    for old, new in changes.items():
        whole = whole.replace(old, new)
    return whole


@pytest.fixture
def robot(tmp_path):
    path = tmp_path / "robot.xml"
    path.write_text(text())
    return path


def test_it_hangs_on_the_pelvis_with_our_names_and_signs(robot):
    found = adopt(robot, "mine")
    bodies = {body["name"]: body for body in found.character["bodies"]}
    assert list(bodies)[0] == "pelvis"
    assert {name: b.get("parent") for name, b in bodies.items()} == {
        "pelvis": None, "chest": "pelvis", "head": "chest", "thigh": "pelvis", "shin": "thigh",
        "foot": "shin", "upper_arm": "chest", "forearm": "upper_arm",
    }  # fmt: skip
    joints = {j["name"]: j for b in bodies.values() for j in b.get("joints", ())}
    # The belly bends the pelvis back against the chest by 75 deg: the chest forward on the pelvis.
    assert joints["waist_y"]["range"] == pytest.approx(np.radians([-30, 75]), abs=1e-4)
    assert joints["waist_y"]["axis"] == [0, 1, 0]
    assert joints["hip_y"]["range"] == pytest.approx(np.radians([-30, 120]), abs=1e-4)
    assert joints["hip_y"]["axis"] == [0, -1, 0]
    assert joints["knee"]["range"] == pytest.approx(np.radians([-2, 150]), abs=1e-4)
    assert joints["knee"]["torque"] == 80.0
    assert found.joints["elbow"] == "left_elbow"
    # Arms hang: a quarter turn of the shoulder is zero now, and so is one of the elbow.
    arm = np.array(bodies["forearm"]["position"])
    assert arm / np.linalg.norm(arm) == pytest.approx([0, 0, -1], abs=0.03)
    (geom,) = bodies["forearm"]["geoms"]
    far = np.array(max(geom["start"], geom["end"], key=np.linalg.norm))
    assert far == pytest.approx([0, 0, -0.25], abs=0.01)
    assert sum(len(g) for g in (bodies["foot"]["geoms"],)) == 2  # a plate has two edges
    assert "waist_x" in found.character["absent"]
    assert any("no torque limit in the file for elbow, neck_y" in note for note in found.notes)


def test_a_head_of_any_name_is_one(robot, tmp_path):
    """What a hinge moves on the chest beside the arms, with nothing above it."""
    path = tmp_path / "skull.xml"
    path.write_text(text(**{'name="head"': 'name="skull"'}))
    found, usual = adopt(path, "mine"), adopt(robot, "mine")
    assert (found.character, found.joints) == (usual.character, usual.joints)
    assert found.joints["neck_y"] == "nod"
    assert (found.roles["neck"], found.roles["head"]) == ("skull", "skull")
    stiff = {'name="head"': 'name="skull"', '<joint name="nod" axis="0 1 0" range="-40 40"/>': ""}
    path.write_text(text(**stiff))
    assert "skull" in [body["name"] for body in adopt(path, "mine").character["bodies"]]


def test_it_moves_as_the_file_does(robot):
    """Every angle by itself: bodies are where the file's own model has them."""
    found = adopt(robot, "mine")
    ours = build(load_with(found.character)).model.mj
    theirs = mujoco.MjModel.from_xml_path(str(robot))
    names = {"chest": "torso", "head": "head"} | {
        f"{part}_{s}": f"{side}_{body}"
        for s, side in (("l", "left"), ("r", "right"))
        for part, body in (("thigh", "thigh"), ("shin", "shin"), ("foot", "foot"))
    }
    generator = np.random.default_rng(0)
    for joint, source, sign in (
        ("waist_y", "belly", -1.0), ("hip_y_l", "left_hip_y", -1.0), ("knee_r", "right_knee", -1.0),
        ("neck_y", "nod", 1.0), ("hip_x_r", "right_hip_x", -1.0),
    ):  # fmt: skip
        angle = 0.3 * generator.uniform(0.5, 1.0)
        a, b = mujoco.MjData(ours), mujoco.MjData(theirs)
        a.qpos[ours.joint(joint).qposadr], b.qpos[theirs.joint(source).qposadr] = (
            angle,
            sign * angle,
        )
        for model, data in ((ours, a), (theirs, b)):
            mujoco.mj_kinematics(model, data)

        def seen(data, names_of_two):
            hips, other = (data.body(name) for name in names_of_two)
            return hips.xmat.reshape(3, 3).T @ (other.xipos - hips.xipos)

        for mine, its in names.items():
            assert seen(a, ("pelvis", mine)) == pytest.approx(seen(b, ("pelvis", its)), abs=2e-3)


def load_with(character):
    from dataclasses import replace

    return replace(load(["duration=0.2"]), character=checked(Character, character))


def test_our_own_adult_comes_back(tmp_path):
    path = tmp_path / "adult.xml"
    path.write_text(adult().mjcf)
    found = adopt(path, "again")
    model = build(load_with(found.character)).model
    assert sorted(model.joint_names) == sorted(adult().joint_names)
    assert model.mass == pytest.approx(70.0, abs=0.01)
    for name in adult().joint_names:
        i, k = model.joint_names.index(name), adult().joint_names.index(name)
        assert model.joint_range[i] == pytest.approx(adult().joint_range[k], abs=1e-3)
        assert model.torque_limit[i] == pytest.approx(adult().torque_limit[k])
    for body in ("head", "foot_l", "forearm_r", "thigh_l", "shin_r"):
        assert model.mj.body(body).pos == pytest.approx(adult().mj.body(body).pos, abs=1e-4)
        assert model.mj.body(body).mass == pytest.approx(adult().mj.body(body).mass, rel=1e-3)
        assert model.mj.body(body).inertia == pytest.approx(adult().mj.body(body).inertia, rel=0.03)
    assert not found.character["absent"]


def test_one_that_faces_elsewhere_is_turned(tmp_path):
    root = ElementTree.fromstring(text())
    x, y, z, w = Rotation.from_euler("z", 130, degrees=True).as_quat()
    root.find("worldbody/body").set("quat", f"{w} {x} {y} {z}")
    path = tmp_path / "turned.xml"
    path.write_text(ElementTree.tostring(root, encoding="unicode"))
    (tmp_path / "robot.xml").write_text(text())
    turned, straight = (adopt(tmp_path / f"{name}.xml", "a") for name in ("turned", "robot"))
    for one, other in zip(turned.character["bodies"], straight.character["bodies"], strict=True):
        assert one.get("position", [0]) == pytest.approx(other.get("position", [0]), abs=1e-3)


def test_the_command_writes_a_choice(robot, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    usual, out = "conf/character/adult.yaml", "conf/character/mine.yaml"  # whose folder is made
    assert main(["inspect-model", str(robot), "--out", usual]) == 2
    assert capsys.readouterr().err == (
        f"rotctl: {usual}: there is a character of that name that comes with rotctl; give yours "
        "another\n"
    )
    assert not (tmp_path / "conf").exists()
    assert main(["inspect-model", str(robot), "--out", out]) == 0
    said = capsys.readouterr().out
    assert "  left_knee        left_shin\n" in said
    assert "  knee             left_knee; -0.03 to 2.62, 80\n" in said
    assert said.endswith(f"character  {out}\n")
    assert yaml.safe_load((tmp_path / out).read_text())["gains_for"] == {"height": 1.75, "mass": 70}
    assert main(["run", "character=mine", "duration=0.3", "--quiet"]) == 0
    assert main(["inspect-model", str(robot), "--out", "a.xml"]) == 2
    (tmp_path / out).write_text("edited by hand")
    assert main(["inspect-model", str(robot), "--out", out]) == 2
    said = f"rotctl: --out={out}: is there already; give the character another name\n"
    assert capsys.readouterr().err.endswith(said)
    assert (tmp_path / out).read_text() == "edited by hand"
    assert main(["inspect-model", str(robot), "--map", "left_hip=no"]) == 2
    assert "--map left_hip=no: no such body; its bodies: " in capsys.readouterr().err


@pytest.mark.parametrize(
    ("told", "why"),
    [
        ("left_hip=right_thigh", "is of one limb with right_thigh, the right_hip"),
        ("left_hip=pelvis", "right_thigh, the right_hip, hangs on it, too"),
        ("left_hip=torso", "is of the trunk"),
        ("left_knee=right_shin", "does not hang on left_thigh, the left_hip"),
        ("left_wrist=left_upper_arm", "does not hang on left_lower_arm, the left_elbow"),
        ("chest=pelvis", "both arms hang on torso, and that is the chest"),
        ("hips=left_shin", "is not between legs and arms: pelvis, torso"),
        ("head=pelvis", "is of the trunk"),
    ],
)
def test_a_body_that_cannot_be_what_it_is_called_is_told(tmp_path, capsys, told, why):
    """It ended in a traceback, or another body was taken in its place without a word."""
    path = tmp_path / "robot.xml"
    path.write_text(text())
    assert main(["inspect-model", str(path), "--map", told]) == 2
    assert capsys.readouterr().err == f"rotctl: {path}: --map {told}: {why}\n"


def test_what_acts_otherwise_than_by_motors_is_told_and_left_out(tmp_path):
    path = tmp_path / "robot.xml"
    section = (
        '<tendon><fixed name="cord"><joint joint="belly" coef="1"/></fixed></tendon><equality>'
        '<joint joint1="left_knee" joint2="right_knee"/></equality><actuator>'
        '<motor tendon="cord"/>'
    )
    held = {"<actuator>": section, '<body name="head"': '<body name="head" gravcomp="1"'}
    path.write_text(text(**held))
    assert adopt(path, "robot").notes[:4] == [
        "equality constraints left out: 1",
        "tendons left out: 1",
        "actuators of no joint left out: 1",
        "gravcomp left out: all of its bodies weigh",
    ]


@pytest.mark.parametrize("beside", ['mocap="true"', 'pos="3 0 2"'])
def test_what_stands_beside_it_is_no_part_of_it(tmp_path, beside):
    """It was weighed and measured with the body, which then fitted none of its bodies."""
    path = tmp_path / "robot.xml"
    path.write_text(text())
    alone = adopt(path, "robot").character
    table = f'<body name="table" {beside}><geom type="box" size="1 1 1" mass="50"/></body>'
    path.write_text(text(**{"<worldbody>": f"<worldbody>{table}"}))
    assert adopt(path, "robot").character == alone


def test_a_body_whose_shape_is_left_out_counts_where_it_weighs(tmp_path):
    path = tmp_path / "robot.xml"
    head = '<geom type="sphere" size="0.1" pos="0 0 0.1" mass="4"/>'
    lost = '<geom mesh="m" mass="4"/><inertial pos="0 0 0.1" mass="4" diaginertia="1 1 1"/>'
    asset = '<asset><mesh name="m" file="nowhere.stl"/></asset><worldbody>'
    path.write_text(text(**{head: lost, "<worldbody>": asset}))
    made = adopt(path, "robot")
    assert made.notes[:2] == [
        f"{tmp_path / 'nowhere.stl'}: no such file: left out",
        "shapes that are meshes, left out: 1",
    ]
    assert build(load_with(made.character)).model.mass == pytest.approx(50.0)


def test_a_place_that_is_none_is_refused(tmp_path):
    path = tmp_path / "robot.xml"
    path.write_text(text(**{'pos="0 0 1.2"': 'pos="0 0 nan"'}))
    with pytest.raises(InputError) as refused:
        adopt(path, "robot")
    assert str(refused.value) == f"{path}: body_pos has NaN or infinity among its numbers"


def test_a_limit_at_zero_has_no_sign(tmp_path, capsys):
    path = tmp_path / "robot.xml"
    path.write_text(text(**{'range="-150 2"': 'range="-150 0"'}))
    assert main(["inspect-model", str(path)]) == 0
    assert "  knee             left_knee; 0.00 to 2.62, 80\n" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("changes", "complaint"),
    [
        ({'<joint name="nod" axis="0 1 0" range="-40 40"/>': '<joint name="nod" type="ball"/>'},
         "joint 'nod' is a ball joint; only hinges can be used"),
        ({"<freejoint/>": ""}, "its first joint must be the root's freejoint"),
        ({"left_thigh": "a", "right_thigh": "b", "left_shin": "c", "left_foot": "d"},
         "no body for the left hip"),
    ],
)  # fmt: skip
def test_what_is_no_humanoid(tmp_path, changes, complaint):
    path = tmp_path / "robot.xml"
    path.write_text(text(**changes))
    with pytest.raises(InputError) as error:
        adopt(path, "a")
    assert complaint in str(error.value)


@pytest.mark.parametrize(
    ("more", "complaint"),
    [
        ("<body><geom size='1'/></body>" * 300, "has 313 <body>; at most 300 can be used"),
        ("<body>" + "<joint/>" * 200 + "</body>", "has 216 <joint>; at most 200 can be used"),
        ("<geom size='1'/>" * 2000, "has 2013 <geom>; at most 2000 can be used"),
    ],
    ids=["bodies", "hinges", "shapes"],
)
def test_what_would_take_minutes_and_gigabytes_is_refused_unbuilt(
    tmp_path, monkeypatch, more, complaint
):
    path = tmp_path / "robot.xml"
    path.write_text(text(**{'<body name="head"': f'{more}<body name="head"'}))
    monkeypatch.setattr("rotctl.adopting.solid.compiled", None)
    with pytest.raises(InputError) as error:
        adopt(path, "a")
    assert str(error.value) == f"{path}: {complaint}"


def test_poses_may_name_what_it_has_not(robot):
    made = build(load_with(adopt(robot, "mine").character))
    assert made.model.motors("chest_y", "a pose") == []
    assert len(made.model.motors("knee", "a pose")) == 2
    with pytest.raises(InputError, match="a pose names the unknown joint 'tail'"):
        made.model.motors("tail", "a pose")
    assert not in_memory(made)[1]


def test_a_start_bends_the_waist_by_what_a_chest_would(robot):
    """As a motion does: it began with a straighter back than the motion that it was to follow."""
    model = build(load_with(adopt(robot, "mine").character)).model
    nothing = (0.0, 0.0)
    posture = Posture(0.0, {"waist_y": 0.2, "chest_y": 0.3})
    settings = StartSettings("still", *([nothing] * 6), postures={"left": posture})
    start = draw(settings, model, "left", np.random.default_rng(0))
    assert start.pose[model.joint_names.index("waist_y")] == pytest.approx(0.5)
    assert np.count_nonzero(start.pose) == 1


def by_offsets(model, pose):
    clip = Clip(name="still", roll_about="left", joints={"knee": [0.0] * 12})
    offsets = {joint: [angle] for joint, angle in pose.items()}
    settings = ReferenceSettings(clip="", window=0.0, lead=0.0, offsets=offsets)
    return make_reference_pair(model, clip, settings).start(0.0)


def by_waiting(model, pose):
    return Waiting(pose, model).settled(np.zeros(len(model.joint_names)), 1.0)


def by_keys(model, pose):
    keys = [{"turn": turn, "pose": pose} for turn in (0.0, 0.3, 0.6)]
    made = author(model, checked(Keys, {"name": "a", "roll_about": "left", "keys": keys}), "mine")
    return made.poses(model)[0]


@pytest.mark.parametrize("bent", [by_offsets, by_waiting, by_keys])
def test_whatever_bends_a_chest_bends_the_waist_of_who_has_none(robot, bent):
    """The trunk is then as round as an adult's in the same words, within the joint's range."""
    model = build(load_with(adopt(robot, "mine").character)).model
    waist = model.joint_names.index("waist_y")
    for pose, angle in (
        ({"waist_y": 0.2, "chest_y": 0.3}, 0.5),
        ({"chest_y": 0.3}, 0.3),
        ({"chest_x": 0.3}, 0.0),  # it has no waist_x either
        ({"waist_y": 1.2, "chest_y": 0.3}, np.radians(75.0)),
    ):
        found = bent(model, pose)
        assert found[waist] == pytest.approx(angle, abs=1e-4)
        assert np.count_nonzero(found) == (angle != 0.0)


def test_what_the_joints_have_is_kept(tmp_path):
    """Springs, damping and armature: both models go the same way when they are let go."""
    path = tmp_path / "robot.xml"
    springs = text().replace(
        'name="belly"', 'name="belly" damping="3" armature="0.02" stiffness="40" springref="-20"'
    )
    path.write_text(
        springs.replace('_knee" axis', '_knee" damping="2" armature="0.1" stiffness="5" axis')
    )
    found = adopt(path, "mine")
    joints = {j["name"]: j for b in found.character["bodies"] for j in b.get("joints", ())}
    # The belly's spring is at rest where it is bent forward: its sign is turned with the tree.
    assert joints["waist_y"]["spring"] == pytest.approx([40.0, np.radians(20)], abs=1e-4)
    assert (joints["waist_y"]["damping"], joints["waist_y"]["armature"]) == (3.0, 0.02)
    assert (joints["knee"]["damping"], joints["knee"]["spring"]) == (2.0, [5.0, 0.0])
    ours = build(load_with(found.character)).model.mj
    theirs = mujoco.MjModel.from_xml_path(str(path))
    torques = []
    for model, belly, knee, bent in (
        (ours, "waist_y", "knee_l", 0.3), (theirs, "belly", "left_knee", -0.3)
    ):  # fmt: skip
        data = mujoco.MjData(model)
        data.joint(belly).qpos, data.joint(belly).qvel = bent, 10 * bent
        data.joint(knee).qpos, data.joint(knee).qvel = 0.7, 0.1
        mujoco.mj_forward(model, data)
        way = 1.0 if bent > 0 else -1.0
        torques.append((way * data.joint(belly).qfrc_passive[0], *data.joint(knee).qfrc_passive))
    assert torques[0] == pytest.approx(torques[1], abs=1e-3)


def test_a_giant_has_the_springs_of_its_size(robot):
    made = adopt(robot, "mine").character
    knee = next(j for b in made["bodies"] for j in b.get("joints", ()) if j["name"] == "knee")
    knee |= {"damping": 2.0, "armature": 0.1, "spring": [5.0, 0.3]}
    big = load_with({**made, "height": 4 * made["height"], "mass": 64 * made["mass"]})
    (found,) = (j for b in grown(big.character).bodies for j in b.joints if j.name == "knee")
    assert found.spring == (5.0 * 64 * 4, 0.3)  # torques
    assert found.damping == 2.0 * 64 * 4 * 2  # and by times, which grow by the root of lengths
    assert found.armature == 0.1 * 64 * 4**2


def test_what_is_no_mirror_image_is_told(tmp_path):
    # An abduction of 30 to 60 degrees about +x is one to the outside on the left alone.
    legs = {"left": "-30 60", "right": "-60 30"}
    even = text()
    for side, span in legs.items():
        even = even.replace(
            f'name="{side}_hip_x" axis="1 0 0" range="-30 60"',
            f'name="{side}_hip_x" axis="1 0 0" range="{span}"',
        )
    path = tmp_path / "robot.xml"
    said = []
    for whole in (
        even,
        text(),
        even.replace('name="right_knee" axis="0 -1 0"', 'name="right_knee" axis="0 -1 0.2"'),
        even.replace('right_shin" pos="0 0 -0.4', 'right_shin" pos="0 0 -0.43'),
    ):
        path.write_text(whole)
        said.append([note for note in adopt(path, "mine").notes if "mirror" in note])
    ends = "): it is taken as the left one's mirror image"
    assert said == [
        [],
        [f"the right thigh differs from the left one (the range of right_hip_x{ends}"],
        [f"the right shin differs from the left one (the axis of right_knee{ends}"],
        [f"the right shin differs from the left one (another place{ends}"],
    ]


BRICK = np.array([[x, y, z] for x in (-0.1, 0.3) for y in (-0.05, 0.05) for z in (0.0, 0.06)])
FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6)]


def stl(places):
    corners = [np.array([0, 0, 1, *places[list(face)].ravel()], "<f4") for face in FACES]
    facets = b"".join(each.tobytes() + b"\0\0" for each in corners)
    return b"\0" * 80 + len(FACES).to_bytes(4, "little") + facets


@pytest.mark.parametrize("name", ["foot.stl", "foot.STL", "foot.obj"])
def test_capsules_stand_for_a_mesh(tmp_path, name):
    turned = Rotation.from_euler("y", 30, degrees=True)
    places = 10.0 * turned.apply(BRICK)  # a brick that lies askew in a file of decimetres
    content = stl(places)
    if name.endswith("obj"):
        content = "".join("v {} {} {}\n".format(*p) for p in places).encode() + b"f 1 2 3\n"
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / name).write_bytes(content)
    whole = text().replace(
        '<geom type="box" size="0.1 0.04 0.03" pos="0.05 0 -0.03" mass="1"/>',
        '<geom type="mesh" mesh="foot" pos="0 0 -0.06" euler="0 -30 0" mass="1"/>',
    )
    assets = f'<asset><mesh name="foot" file="{name}" scale="0.1 0.1 0.1"/></asset>'
    whole = whole.replace('angle="degree"', 'angle="degree" meshdir="meshes"')
    path = tmp_path / "robot.xml"
    path.write_text(whole.replace("<worldbody>", assets + "<worldbody>"))
    found = adopt(path, "mine")
    (foot,) = (b for b in found.character["bodies"] if b["name"] == "foot")
    ends = np.array([[g["start"], g["end"]] for g in foot["geoms"]])
    # Two edges of 6 cm: as long and as wide as the brick is with their roundings.
    assert [g["size"] for g in foot["geoms"]] == [pytest.approx(0.03, abs=1e-3)] * 2
    assert ends[..., 0].min() == pytest.approx(-0.07, abs=2e-3)
    assert ends[..., 0].max() == pytest.approx(0.27, abs=2e-3)
    assert np.ptp(ends[..., 1]) == pytest.approx(0.04, abs=2e-3)
    assert ends[..., 2] == pytest.approx(-0.03, abs=2e-3)
    without = adopt(path, "mine", meshes=False)
    assert "shapes that are meshes, left out: 2" in without.notes


def along_the_axes(corners):
    return all(len(np.unique(places.round(9))) == 2 for places in corners.T)


@pytest.mark.parametrize("vector", [(0.3, -0.4, 0.5), (1.0, 1.0, 1.0), (0.5, 1.1, 0.2)])
def test_the_box_of_what_is_as_a_ball_is_along_the_axes(vector):
    """It has no axes of its own but by rounding, here that of the numbers in an STL."""
    octahedron = np.concatenate((np.eye(3), -np.eye(3)))
    places = Rotation.from_rotvec(vector).apply(octahedron).astype(np.float32).astype(float)
    found = box(places)
    assert along_the_axes(found)
    assert found.max(axis=0) == pytest.approx(places.max(axis=0))


@pytest.mark.parametrize("sides", [(0.4, 0.1, 0.06), (0.4, 0.05, 0.05)])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_a_box_is_as_its_points_lie_if_it_is_clearly_smaller_for_it(sides, scale):
    brick = scale * np.array(list(product(*[(-0.5 * side, 0.5 * side) for side in sides])))
    turn, slightly = (Rotation.from_rotvec(v) for v in ([0.3, -0.4, 0.5], [0.0, 0.0, 1e-3]))
    found = turn.inv().apply(box(turn.apply(brick)))
    assert np.ptp(found[:, 0]) == pytest.approx(0.4 * scale, rel=1e-6)
    assert along_the_axes(box(slightly.apply(brick)) / scale)


@pytest.mark.parametrize(
    ("file", "reason"),
    [
        ("../../foot.stl", "/meshes/../../foot.stl: is not below the model's folder"),
        ("none.stl", "/meshes/none.stl: no such file"),
        ("foot.dae", "/meshes/foot.dae: is no .stl or .obj"),
        ("empty.stl", "/meshes/empty.stl: has no vertices that make a shape"),
        ("link.stl", "/meshes/link.stl: is not below the model's folder"),
        ("circle.stl", "/meshes/circle.stl: is not below the model's folder"),
        ("point.stl", "/meshes/point.stl: has no vertices that make a shape"),
        ("nan.stl", "/meshes/nan.stl: has no vertices that make a shape"),
    ],
)
def test_a_mesh_that_cannot_be_read_is_left_out(tmp_path, file, reason):
    robot = tmp_path / "robot"
    (robot / "meshes").mkdir(parents=True)
    (tmp_path / "foot.stl").write_bytes(stl(BRICK))
    (robot / "meshes/foot.dae").write_text("<COLLADA/>")
    (robot / "meshes/empty.stl").write_text("solid nothing\nendsolid\n")
    (robot / "meshes/link.stl").symlink_to(tmp_path / "foot.stl")
    (robot / "meshes/circle.stl").symlink_to(robot / "meshes/circle.stl")
    (robot / "meshes/point.stl").write_bytes(stl(0.0 * BRICK))
    (robot / "meshes/nan.stl").write_bytes(stl(np.nan * BRICK))
    assets = f'<asset><mesh name="foot" file="../meshes/{file}"/></asset>'
    whole = text().replace('angle="degree"', 'angle="degree" meshdir="x/"')
    box = '<geom type="box"'
    whole = whole.replace(box, f'<geom type="mesh" mesh="foot" mass="1"/>{box}')
    (robot / "x").mkdir()
    (robot / "robot.xml").write_text(whole.replace("<worldbody>", assets + "<worldbody>"))
    notes = adopt(robot / "robot.xml", "mine").notes
    assert notes[0].endswith(f"{reason}: left out")
    assert notes[1] == "shapes that are meshes, left out: 2"


def test_what_is_only_looked_at_touches_nothing(tmp_path):
    """A mesh that collides with nothing, by its class, beside a shape that does; and one alone."""
    (tmp_path / "foot.stl").write_bytes(stl(BRICK))
    seen = (
        '<default><default class="seen"><geom type="mesh" contype="0" conaffinity="0"/></default>'
        '</default><asset><mesh name="foot" file="foot.stl"/></asset>'
    )
    box = '<geom type="box" size="0.1 0.04 0.03" pos="0.05 0 -0.03" mass="1"/>'
    mesh = '<geom class="seen" mesh="foot" pos="0 0 -0.06" mass="0.5"/>'
    path, lengths = tmp_path / "robot.xml", []
    for shapes in (box + mesh, mesh):
        path.write_text(text().replace(box, shapes).replace("<worldbody>", seen + "<worldbody>"))
        (foot,) = (b for b in adopt(path, "mine").character["bodies"] if b["name"] == "foot")
        long = [round(g["end"][0] - g["start"][0], 3) for g in foot["geoms"]]
        lengths.append([(g["mass"] > 0, x) for g, x in zip(foot["geoms"], long, strict=True)])
    assert lengths == [
        [(True, 0.14), (True, 0.14), (False, 0.34), (False, 0.34)],
        [(True, 0.34), (True, 0.34)],
    ]
