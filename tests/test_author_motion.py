"""Clips of key poses, and the ones that come with rotctl."""

from pathlib import Path

import mujoco
import numpy as np
import pytest
import yaml
from captures import adult
from scipy.spatial.transform import Rotation

from rotctl.choices.config_folders import conf_dir
from rotctl.errors import InputError
from rotctl.motion import load_clip
from rotctl.motion.author import author, load_keys
from rotctl.motion.clip import names
from rotctl.motion.cycle import at_places
from rotctl.motion.preview import motion_of, preview
from rotctl.motion.turning import pelvis_turn, rotation_between_postures
from rotctl.motion.writing import text

SHIPPED = {
    "forward_roll": "left",
    "parkour_roll": "left",
    "backward_roll": "right",
    "log_roll": "head",
}
FOUND_BY_SEARCH = dict.fromkeys(
    ("forward_roll_2", "forward_roll_hands", "shoulder_roll", "terrain_roll"),
    "left",
)
LOWERED = np.eye(adult().mj.nq)[2] * 1e-3  # by a millimetre, so that what rests there touches
KEYS = {
    "name": "a",
    "roll_about": "left",
    "keys": [
        {"turn": 0.0, "pose": {"knee": 1.0}},
        {"turn": 0.3, "pose": {"knee": 2.0, "elbow_l": 1.0}},
        {"turn": 0.6, "pose": {"knee": 0.5}},
    ],
}


def saved(path, **changes):
    path.write_text("".join(yaml.safe_dump({k: v}) for k, v in {**KEYS, **changes}.items()))
    return path


def test_all_of_them_are_here():
    found = {name: load_clip(name).roll_about for name in names()}
    assert found == SHIPPED | FOUND_BY_SEARCH


def test_a_body_that_is_straight_all_the_way_is_a_clip(tmp_path):
    """As a log rolls: no joint has an angle, and the file says how long it is all the same."""
    keys = [{"turn": turn, "pose": {}} for turn in (0.0, 0.3, 0.6)]
    path = saved(tmp_path / "keys.yaml", roll_about="head", keys=keys)
    made = author(adult(), load_keys(path), "adult")
    assert made.samples == len(made.pelvis)
    assert not made.poses(adult()).any()


@pytest.mark.parametrize("name", SHIPPED)
def test_the_shipped_clips_are_those_of_their_keys(name):
    folder = conf_dir() / "motion"
    made = author(adult(), load_keys(folder / "keys" / f"{name}.yaml"), "adult")
    there = load_clip(name)
    assert text(made).partition("joints:")[0] == text(there).partition("joints:")[0]
    assert np.abs(made.poses(adult()) - there.poses(adult())).max() < 2e-3
    assert np.abs(np.array(made.pelvis) - np.array(there.pelvis)).max() < 2e-3
    assert made.description
    assert made.source
    assert made.licence == "Apache-2.0"


@pytest.mark.parametrize("name", SHIPPED)
def test_the_phase_is_the_turn_of_the_whole_body(name):
    clip = load_clip(name)
    motion = motion_of(adult(), clip)
    closed = at_places(motion, np.arange(clip.samples + 1) / clip.samples)
    # By the bodies one by one: what I_c^-1 H makes of finite differences of their places.
    turns = np.array([_turn(a, b) for a, b in _pairs(closed)])
    assert turns[:, 1].max() / turns[:, 1].min() < 1.05
    assert turns[:, 1].sum() / (2 * np.pi) == pytest.approx(1.0, abs=0.06)
    assert np.abs(turns - rotation_between_postures(adult(), closed)).max() < 2e-3
    at_zero = pelvis_turn(motion.pelvis[:1], clip.roll_about)
    assert np.degrees(at_zero) == pytest.approx(0.0, abs=1.0)


def _pairs(motion):
    places = [_bodies(pose, turn) for pose, turn in zip(motion.poses, motion.pelvis, strict=True)]
    return zip(places[:-1], places[1:], strict=True)


def _bodies(pose, pelvis):
    """Place (k, 3) and axes (k, 3, 3) of the bodies' inertia, about the centre of mass."""
    mj = adult().mj
    data = mujoco.MjData(mj)
    data.qpos[3:7], data.qpos[7:] = pelvis.as_quat(scalar_first=True), pose
    mujoco.mj_kinematics(mj, data)
    mass = mj.body_mass[1:]
    place = data.xipos[1:] - mass @ data.xipos[1:] / mass.sum()
    return place, data.ximat[1:].reshape(-1, 3, 3)


def _turn(before, after):
    mj = adult().mj
    mass, own = mj.body_mass[1:], mj.body_inertia[1:]
    place, moved = 0.5 * (before[0] + after[0]), after[0] - before[0]
    spun = Rotation.from_matrix(after[1] @ before[1].transpose(0, 2, 1)).as_rotvec()
    inertia = np.einsum("kij,kj,klj->kil", before[1], own, before[1])
    momentum = mass @ np.cross(place, moved) + np.einsum("kij,kj->i", inertia, spun)
    arms = np.einsum("k,kij->ij", mass, (place**2).sum(axis=1)[:, None, None] * np.eye(3))
    whole = inertia.sum(axis=0) + arms - np.einsum("k,ki,kj->ij", mass, place, place)
    return np.linalg.solve(whole, momentum)


@pytest.mark.parametrize("name", SHIPPED)
def test_it_rolls_over_the_ground_to_where_it_should(name):
    positions, phases = preview(adult(), load_clip(name), 24)
    assert phases.tolist() == pytest.approx(np.arange(24) / 24)
    way = positions[-1, :2] - positions[0, :2]
    assert 1.0 < np.linalg.norm(way) < 2.6
    if SHIPPED[name] != "head":  # that is drawn from its side
        assert way[0] > 4 * abs(way[1])
    mj = adult().mj
    data = mujoco.MjData(mj)
    for position in positions:
        data.qpos[:] = position - LOWERED
        mujoco.mj_forward(mj, data)
        touching = [c.dist for c in data.contact if 0 in mj.geom_bodyid[c.geom]]
        assert min(touching) == pytest.approx(-1e-3, abs=1e-5)


def test_the_shoulder_roll_crosses_the_back_from_the_right_shoulder_to_the_left_hip():
    mj = adult().mj
    data = mujoco.MjData(mj)
    lowest = []
    for position in preview(adult(), load_clip("parkour_roll"), 48)[0]:
        data.qpos[:] = position - LOWERED
        mujoco.mj_forward(mj, data)
        contact = min(
            (c for c in data.contact if 0 in mj.geom_bodyid[c.geom]), key=lambda c: c.dist
        )
        body = int(mj.geom_bodyid[contact.geom].max())
        side = data.xmat[body].reshape(3, 3).T @ (contact.pos - data.xpos[body])
        lowest.append((mj.body(body).name, float(side[1])))
    trunk = [i for i, (body, _) in enumerate(lowest) if body in ("chest", "waist", "pelvis")]
    assert trunk == list(range(trunk[0], trunk[-1] + 1))
    assert lowest[trunk[0] - 1][0] in ("upper_arm_r", "forearm_r", "chest")
    assert [lowest[i][0] for i in (trunk[0], trunk[-1])] == ["chest", "pelvis"]
    assert lowest[trunk[0]][1] < -0.05  # to the right
    assert lowest[trunk[-1]][1] > 0.05  # to the left


def test_symmetric_clips_name_no_side():
    for name in ("forward_roll", "backward_roll"):
        assert not any(joint.endswith(("_l", "_r", "_x", "_z")) for joint in load_clip(name).joints
                       if joint not in ("hip_x", "shoulder_x"))  # fmt: skip


def test_between_keys_no_angle_overshoots(tmp_path):
    clip = author(adult(), load_keys(saved(tmp_path / "a.yaml")), "adult")
    assert set(clip.joints) == {"knee", "elbow_l"}
    assert max(clip.joints["knee"]) == pytest.approx(2.0, abs=0.01)
    assert min(clip.joints["knee"]) == pytest.approx(0.5, abs=0.01)
    assert min(clip.joints["elbow_l"]) == 0.0


@pytest.mark.parametrize(
    ("changes", "complaint"),
    [
        ({"keys": KEYS["keys"][:2]}, "keys: too few values, at least 3"),
        ({"keys": [*KEYS["keys"], {"turn": 0.6, "pose": {}}]},
         "keys: turn 0.6 must come after 0.6"),
        ({"keys": [*KEYS["keys"], {"turn": 1.0, "pose": {}}]},
         "keys.3.turn=1.0: must be less than 1"),
        ({"keys": [*KEYS["keys"], {"turn": 0.7, "pose": {}, "at": 0}]},
         "unknown key 'keys.3.at'; valid keys under keys.3: turn, pose, tilt"),
        ({"speed": 3}, "unknown key 'speed'; valid keys: name, roll_about, keys, description, "
         "source, licence"),
    ],
)  # fmt: skip
def test_bad_keys_are_one_line(tmp_path, changes, complaint):
    path = saved(tmp_path / "bad.yaml", **changes)
    with pytest.raises(InputError) as error:
        load_keys(path)
    assert str(error.value) == f"{path}: {complaint}"


@pytest.mark.parametrize(
    ("pose", "complaint"),
    [
        ({"knee": 3.0}, "the key at turn 0.7 has knee=3, valid: -0.02 to 2.7"),
        ({"kne": 1.0}, "the key at turn 0.7 names the unknown joint 'kne'; did you mean "
         "knee? valid: ankle_x, "),
    ],
)  # fmt: skip
def test_keys_that_the_character_cannot_take(tmp_path, pose, complaint):
    keys = [*KEYS["keys"], {"turn": 0.7, "pose": pose}]
    with pytest.raises(InputError) as error:
        author(adult(), load_keys(saved(tmp_path / "a.yaml", keys=keys)), "adult")
    assert str(error.value).startswith(complaint)


def test_keys_from_nowhere():
    with pytest.raises(InputError) as error:
        load_keys(Path("no/keys.yaml"))
    assert str(error.value) == "no/keys.yaml: no such file"


@pytest.mark.parametrize("name", SHIPPED)
def test_limbs_are_not_inside_one_another(name):
    # The physics would keep them out, and the pose could never be reached.
    mj = adult().mj
    data = mujoco.MjData(mj)
    for position in preview(adult(), load_clip(name), 48)[0]:
        data.qpos[:] = position
        mujoco.mj_forward(mj, data)
        deep = [
            (contact.dist, [mj.geom(int(geom)).name for geom in contact.geom])
            for contact in data.contact
            if 0 not in mj.geom_bodyid[contact.geom] and contact.dist < -0.05
        ]
        assert not deep
