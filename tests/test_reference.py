"""Clips, and the poses around a phase of theirs."""

import math

import numpy as np
import pytest
import yaml

from rotctl.errors import InputError
from rotctl.motion import Clip, ReferenceSettings, load_clip, make_reference_pair
from rotctl.motion.clip import names
from rotctl.motion.preview import motion_of
from rotctl.motion.turning import pelvis_turn
from rotctl.motion.writing import text

N = 24
WAVE = [1.0 + 0.5 * math.cos(2 * math.pi * k / N) for k in range(N)]


def clip(**joints):
    return Clip(name="wave", roll_about="left", joints=joints or {"knee": WAVE})


def following(window=0.0, lead=0.0, **offsets):
    return ReferenceSettings(clip="", window=window, lead=lead, offsets=offsets)


def column(model, poses, name):
    return poses[:, model.joint_names.index(name)]


def test_poses_ahead_and_behind_at_any_phase(world):
    model = world.model
    pair = make_reference_pair(model, clip(knee_l=WAVE), following(window=0.1, lead=0.05))
    places = 2 * math.pi * np.arange(N + 1) / N
    for phase in (-20.0, -0.001, 0.0, 1.0, 2 * math.pi, 3.3, 1e4):
        found = column(model, pair.at(phase), "knee_l")
        ahead = [phase + 2 * math.pi * (0.05 + side * 0.1) for side in (1, -1)]
        wanted = np.interp(np.mod(ahead, 2 * math.pi), places, [*WAVE, WAVE[0]])
        assert found == pytest.approx(wanted, abs=2e-3)  # the table's half degree
        assert not column(model, pair.at(phase), "knee_r").any()


def test_no_jump_where_the_cycle_closes(world):
    pair = make_reference_pair(world.model, load_clip("forward_roll"), following(0.05, 0.02))
    around = np.array([pair.at(2 * math.pi * k / 3000) for k in range(-1500, 3000)])
    assert np.abs(np.diff(around, axis=0)).max() < 0.03
    assert around[0] == pytest.approx(around[3000], abs=1e-9)


def test_without_a_window_both_are_the_clip(world):
    model = world.model
    shipped = load_clip("forward_roll")
    pair = make_reference_pair(model, shipped, following(window=0.0, lead=0.0))
    for k, pose in enumerate(shipped.poses(model)):
        a, b = pair.at(2 * math.pi * k / shipped.samples)
        assert a == pytest.approx(pose, abs=1e-9)
        assert np.array_equal(a, b)


def test_offsets_are_added_to_the_clip(world):
    """Mean, first and second harmonic, by hand; one side or both, on top of each other."""
    model = world.model
    offsets = {"knee": [0.2, -0.1, 0.3, 0.05, -0.07], "knee_l": [0.1], "waist_x": [0.0, 0.0, 0.2]}
    pair = make_reference_pair(model, clip(knee=WAVE), following(**offsets))
    for k, phase in enumerate(2 * math.pi * np.arange(N) / N):
        added = 0.2 - 0.1 * math.cos(phase) + 0.3 * math.sin(phase)
        added += 0.05 * math.cos(2 * phase) - 0.07 * math.sin(2 * phase)
        pose = pair.at(phase)
        assert column(model, pose, "knee_r") == pytest.approx([WAVE[k] + added] * 2)
        assert column(model, pose, "knee_l") == pytest.approx([WAVE[k] + added + 0.1] * 2)
        assert column(model, pose, "waist_x") == pytest.approx([0.2 * math.sin(phase)] * 2)
        assert not column(model, pose, "hip_y_l").any()
    assert pair.start(0.0) == pytest.approx(pair.at(0.0)[0])


def test_offsets_keep_within_the_joint_ranges(world):
    model = world.model
    pair = make_reference_pair(model, clip(knee=WAVE), following(knee=[9.0]))
    high = model.joint_range[model.joint_names.index("knee_l"), 1]
    assert set(column(model, pair.at(1.0), "knee_l")) == {high}


def test_an_offset_of_no_joint(world):
    with pytest.raises(InputError) as error:
        make_reference_pair(world.model, clip(), following(kne=[0.1]))
    assert str(error.value) == (
        "behaviour.reference.offsets names the unknown joint 'kne'; did you mean knee? "
        "valid: ankle_x, ankle_y, "
        "chest_x, chest_y, chest_z, elbow, hip_x, hip_y, hip_z, knee, neck_x, neck_y, neck_z, "
        "shoulder_x, shoulder_y, shoulder_z, waist_x, waist_y, waist_z, limb joints also with "
        "_l or _r"
    )


def test_clipped_to_the_joint_ranges(world):
    model = world.model
    low, high = model.joint_range[model.joint_names.index("knee_l")]
    poses = clip(knee=[-9.0, 9.0] * 12).poses(model)
    assert set(column(model, poses, "knee_r")) == {low, high}


def test_a_later_name_wins(world):
    poses = clip(knee=WAVE, knee_r=[0.5] * N).poses(world.model)
    assert column(world.model, poses, "knee_l") == pytest.approx(WAVE)
    assert set(column(world.model, poses, "knee_r")) == {0.5}


def test_unknown_joint(world):
    with pytest.raises(InputError) as error:
        clip(kne=WAVE).poses(world.model)
    assert str(error.value) == (
        "clip 'wave' names the unknown joint 'kne'; did you mean knee? "
        "valid: ankle_x, ankle_y, "
        "chest_x, chest_y, chest_z, elbow, hip_x, hip_y, hip_z, knee, neck_x, neck_y, neck_z, "
        "shoulder_x, shoulder_y, shoulder_z, waist_x, waist_y, waist_z, limb joints also with "
        "_l or _r"
    )


def test_unknown_name():
    with pytest.raises(InputError) as error:
        load_clip("cartwheel")
    assert str(error.value) == (
        f"cartwheel: no such clip; valid: {', '.join(names())}, or the path of a .yaml file"
    )


GOOD = {"name": "a", "roll_about": "left", "joints": {"knee": WAVE}}


def saved(path, **changes):
    path.write_text("".join(yaml.safe_dump({k: v}) for k, v in {**GOOD, **changes}.items()))
    return path


def test_a_clip_from_a_path(tmp_path):
    assert load_clip(str(saved(tmp_path / "a.yaml"))).joints == {"knee": pytest.approx(WAVE)}
    assert load_clip(str(saved(tmp_path / "plain"))).samples == N


@pytest.mark.parametrize(
    ("changes", "complaint"),
    [
        ({"roll_about": "up"}, "roll_about=\"up\": must be 'left', 'right' or 'head'"),
        ({"joints": {}}, "joints={}: too few values, at least 1"),
        ({"joints": {"a": WAVE, "b": WAVE[:20]}},
         "joints.b has 20 samples, joints.a has 24"),
        ({"joints": {"knee": [*WAVE[:-1], float("nan")]}},
         "joints.knee.23=nan: must be a finite number"),
        ({"joints": {"knee": [*WAVE[:-1], "1"]}}, 'joints.knee.23="1": must be a valid number'),
        ({"pelvis": [[1.0, 0.0, 0.0, 0.0]]}, "pelvis has 1 samples, joints.knee has 24"),
        ({"pelvis": [[0.0] * 4 for _ in range(N)]}, "pelvis: a quaternion must have length 1"),
        ({"speed": 1.0}, "unknown key 'speed'; valid keys: name, roll_about, joints, pelvis, "
         "character, source, licence, description, rate, loop_gap"),
    ],
)  # fmt: skip
def test_a_bad_clip_is_one_line(tmp_path, changes, complaint):
    path = saved(tmp_path / "bad.yaml", **changes)
    with pytest.raises(InputError) as error:
        load_clip(str(path))
    assert str(error.value) == f"{path}: {complaint}"


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        (b"", ": must be keys with values: name, roll_about, joints, pelvis, character, source, "
         "licence, description, rate, loop_gap"),
        (b"name: a\njoints: [1, 2\n",
         ":3: is no YAML: while parsing a flow sequence, did not find expected ',' or ']'"),
        (b"name: !!python/object/apply:os.system ['true']\n",
         ":1: has a tag; write plain values"),
        (b"a: &x [*x]\n", ":1: has an alias of what it is in, or of nothing"),
        (b"- " * 100_000, ":1: nested more than 12 deep"),
        (b"name: \xff\n", ":1: is no text (UTF-8)"),
        (b"#" * 2_000_001, ": larger than 2 MB"),
    ],
)  # fmt: skip
def test_hostile_yaml(tmp_path, content, complaint):
    path = tmp_path / "bad.yaml"
    path.write_bytes(content)
    with pytest.raises(InputError) as error:
        load_clip(str(path))
    assert str(error.value) == f"{path}{complaint}"


def test_no_file(tmp_path):
    for name, complaint in (("no.yaml", "no such file"), ("", "is a folder")):
        with pytest.raises(InputError) as error:
            load_clip(f"{tmp_path}/{name}")
        assert str(error.value) == f"{tmp_path / name}: {complaint}"


def test_a_clip_without_a_pelvis_turns_evenly_and_can_be_written(world):
    plain = Clip(name="wave", roll_about="right", joints={"knee": WAVE})
    assert yaml.safe_load(text(plain)) == {
        "name": "wave", "roll_about": "right", "joints": {"knee": WAVE}
    }  # fmt: skip
    turned = pelvis_turn(motion_of(world.model, plain).pelvis, "right")
    assert turned == pytest.approx(2 * math.pi * np.arange(N) / N)
