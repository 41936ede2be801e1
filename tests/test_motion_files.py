"""Readers of motion files: positions worked out by hand, and one line for what is malformed."""

import json

import numpy as np
import pytest

from rotctl.errors import InputError
from rotctl.motion.asf_amc import read_amc
from rotctl.motion.bvh import read_bvh
from rotctl.motion.capture import MAX_POSES
from rotctl.motion.deepmimic import read_deepmimic
from rotctl.motion.landmarks import find_landmarks
from rotctl.motion.reading import FORMATS, Wishes, read_capture

# ---------------------------------------------------------------- BVH

BVH = """HIERARCHY
ROOT hips
{
  OFFSET 5 5 5
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT knee
  {
    OFFSET 0 -2 0
    CHANNELS 3 Xrotation Yrotation Zrotation
    JOINT ankle
    {
      OFFSET 0 -1 0
      CHANNELS 3 Zrotation Yrotation Xrotation
      End Site
      {
        OFFSET 0 0 1
      }
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.05
1 2 3 0 0 0 0 0 0 0 0 0
1 2 3 90 90 0 90 0 90 0 0 0
"""


def written(path, text):
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def test_bvh_by_hand(tmp_path):
    capture = read_bvh(written(tmp_path / "a.bvh", BVH))
    assert capture.time.tolist() == [0.0, 0.05]
    joints = capture.joints
    assert [joint.parent for joint in joints.values()] == ["", "hips", "knee"]
    # The file's x, y, z are left, up, forward; a root with channels is not moved by its offset.
    assert joints["hips"].position[0] == pytest.approx([3, 1, 2])
    assert joints["knee"].position[0] == pytest.approx([3, 1, 0])
    assert joints["ankle"].position[0] == pytest.approx([3, 1, -1])
    # Z then X by 90 degrees in the joint's own axes takes -y to (1, 0, 0) Z-turned of -z: the
    # thigh, -2 y, is first turned by X to -2 z, and Z leaves that.
    assert joints["knee"].position[1] == pytest.approx([1, 1, 2])
    # The shin, -y: by Z to x, by X it stays x; the thigh's X leaves it, its Z makes it y.
    assert joints["ankle"].position[1] == pytest.approx([1, 1, 3])


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("HIERARCHY\n", "#!/bin/sh\n", ":1: '#!/bin/sh' makes no sense here"),
        ("ROOT hips\n{", "ROOT hips\nOFFSET", ":3: expected {, found 'OFFSET'"),
        ("    JOINT ankle", "    ROOT ankle",
         ":10: ROOT ankle: there must be one ROOT, first of all"),
        ("ROOT hips", "JOINT hips", ":2: JOINT hips: there must be one ROOT, first of all"),
        ("JOINT ankle", "JOINT knee",
         ":10: knee: a joint needs a name of its own, and 500 are the most"),
        ("        OFFSET 0 0 1\n", "        JOINT toe { OFFSET 0 0 0 }\n",
         ":16: JOINT toe is not in the braces of a joint"),
        ("OFFSET 0 -2 0", "OFFSET 0 -2 zero", ":8: 'zero' is no number"),
        ("OFFSET 0 -2 0", "OFFSET 0 -2 nan", ":8: 'nan' is no number"),
        ("CHANNELS 3 X", "CHANNELS 7 X", ":9: CHANNELS 7, valid: 0 to 6"),
        ("CHANNELS 3 Xrotation", "CHANNELS 3 Xrotate",
         ":9: unknown channel 'Xrotate'; valid: Xposition, Yposition, Zposition, Xrotation, "
         "Yrotation, Zrotation"),
        ("MOTION\n", "", ":21: 'Frames:' makes no sense here"),
        (BVH[BVH.index("MOTION") :], "", ":20: no MOTION"),
        ("}\nMOTION", "MOTION", ":19: the skeleton ends early"),
        ("Frames: 2", "Frames: 3", ":22: Frames: 3, found 2; valid: 2 to 30000"),
        ("Frames: 2", "Frames: two", ":22: 'two' is no number"),
        ("Frame Time: 0.05", "Frame Time: 0", ":23: Frame Time: 0, valid: 0.0001 to 1 s"),
        ("Frame Time: 0.05", "0.05", ":22: MOTION must go on with Frames: and Frame Time:"),
        (" 0 0 0\n1 2", " 0 0\n1 2", ":24: 11 values, 12 expected"),
        ("90 90 0 90", "90 1e9 0 90", ":25: '1e9' is no number"),
        ("90 90 0 90", "90 \xe9 0 90", ":25: 'é' is no number"),
    ],
)  # fmt: skip
def test_malformed_bvh(tmp_path, old, new, complaint):
    assert old in BVH
    path = written(tmp_path / "bad.bvh", BVH.replace(old, new, 1))
    with pytest.raises(InputError) as error:
        read_bvh(path)
    assert str(error.value) == f"{path}{complaint}"


def test_a_small_file_cannot_ask_for_much_memory(tmp_path):
    joints = 499
    nest = "".join(f"JOINT j{i} {{ OFFSET 0 0 0 CHANNELS 0 " for i in range(joints))
    text = f"HIERARCHY\nROOT r {{ CHANNELS 1 Xposition {nest}{'} ' * (joints + 1)}\nMOTION\n"
    path = written(
        tmp_path / "deep.bvh", f"{text}Frames: 20000\nFrame Time: 0.01\n" + "1\n" * 20000
    )
    with pytest.raises(InputError) as error:
        read_bvh(path)
    assert str(error.value) == (
        f"{path}: 500 joints in 20000 frames, at most {MAX_POSES // 500} frames"
    )


# ---------------------------------------------------------------- ASF/AMC

ASF = """:units
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  orientation 0 0 0
:bonedata
  begin
    name thigh
    direction 0 -1 0
    length 2
    axis 0 0 90 XYZ
    dof ry
  end
  begin
    name shin  # with a comment
    direction 0 -1 0
    length 3
    axis 0 0 0 XYZ
    dof rx rz
  end
  begin
    name foot
    direction 0 0 1
    length 1
    axis 0 0 0 XYZ
  end
:hierarchy
  begin
    root thigh
    thigh shin
    shin foot
  end
"""
AMC = """#!OML:ASF
:FULLY-SPECIFIED
1
root 1 2 3 0 0 0
thigh 0
shin -6e-16 0
2
root 1 2 3 0 0 0
thigh 90
shin 0 90
"""


def acclaim(folder, asf=ASF, amc=AMC):
    written(folder / "a.asf", asf)
    return written(folder / "a.amc", amc), folder / "a.asf"


def test_asf_amc_by_hand(tmp_path):
    capture = read_amc(*acclaim(tmp_path))
    assert capture.time.tolist() == [0.0, 1 / 120]
    joints = capture.joints
    assert joints["thigh"].position[0] == pytest.approx([3, 1, 2])  # forward, left, up
    assert joints["shin"].position[0] == pytest.approx([3, 1, 0])
    assert joints["foot"].position[0] == pytest.approx([3, 1, -3])
    # The thigh's own y axis is the file's -x: turned by 90 degrees, -2 y becomes 2 z; the
    # shin, -3 y, is turned about z to 3 x, which the thigh's turn leaves.
    assert joints["shin"].position[1] == pytest.approx([5, 1, 2])
    assert joints["foot"].position[1] == pytest.approx([5, 4, 2])


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("order TX TY TZ RX RY RZ", "order TX TZ TY RX RY RZ",
         ":5: the root's order must be TX TY TZ RX RY RZ"),
        ("orientation 0 0 0", "orientation 0 9 0", ":6: the root's orientation must be 0 0 0"),
        ("angle deg", "angle rad", ":3: angles must be in deg"),
        ("axis 0 0 90 XYZ", "axis 0 0 90 ZYX", ":12: the axis must end with its order, XYZ"),
        ("dof ry", "dof ra", ":13: dof ra, valid: rx ry rz"),
        ("length 3", "length", ":18: 0 values, 1 expected"),
        ("name foot", "name shin",
         ":27: a bone needs a name of its own, and 500 are the most"),
        ("thigh shin", "shin shin",
         ":31: 'shin' under 'shin': each bone must hang once, on the root or a bone before it"),
        ("    shin foot\n", "", ": no hierarchy for: foot"),
    ],
)  # fmt: skip
def test_malformed_asf(tmp_path, old, new, complaint):
    assert old in ASF
    amc, asf = acclaim(tmp_path, asf=ASF.replace(old, new, 1))
    with pytest.raises(InputError) as error:
        read_amc(amc, asf)
    assert str(error.value) == f"{asf}{complaint}"


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("1\nroot", "root", ":3: 'root' before the first frame's number"),
        ("shin 0 90", "shin 0", ":10: 1 values, 2 expected"),
        ("thigh 90", "thigh x", ":9: 'x' is no number"),
        ("thigh 90", "foot 1", ":9: the skeleton has no moving bone 'foot'"),
        ("thigh 0\n", "", ":3: the frame lacks thigh"),
        ("thigh 90\n", "", ":7: the frame lacks thigh"),
        (AMC[AMC.index("2\nroot") :], "", ": 1 frames, at least 2 expected"),
    ],
)
def test_malformed_amc(tmp_path, old, new, complaint):
    assert old in AMC
    amc, asf = acclaim(tmp_path, amc=AMC.replace(old, new, 1))
    with pytest.raises(InputError) as error:
        read_amc(amc, asf)
    assert str(error.value) == f"{amc}{complaint}"


# ---------------------------------------------------------------- DeepMimic

STANDING = [0.5, 1.0, 2.0, 3.0] + [1.0, 0.0, 0.0, 0.0] * 4 + [0.0]
STANDING += [1.0, 0.0, 0.0, 0.0] * 2 + [0.0] + [1.0, 0.0, 0.0, 0.0] + [0.0]
STANDING += [1.0, 0.0, 0.0, 0.0] * 2 + [0.0]
KNEE_R = 20  # its column


def test_deepmimic_by_hand(tmp_path):
    kneeling = list(STANDING)
    kneeling[4:8] = [np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0]  # a quarter turn to the left
    kneeling[KNEE_R] = -np.pi / 2
    frames = {"Loop": "wrap", "Frames": [STANDING, kneeling]}
    capture = read_deepmimic(written(tmp_path / "a.txt", json.dumps(frames)))
    assert capture.time.tolist() == [0.0, 0.5]
    right = [capture.joints[f"right_{name}"].position for name in ("hip", "knee", "ankle")]
    # The file's y is up and its z to the right.
    assert right[0][0] == pytest.approx([1, -3.085, 2])
    assert right[1][0] == pytest.approx([1, -3.085, 2 - 0.422])
    assert right[2][0] == pytest.approx([1, -3.085, 2 - 0.422 - 0.41])
    assert right[0][1] == pytest.approx([1.085, -3, 2])
    assert right[1][1] == pytest.approx([1.085, -3, 2 - 0.422])
    assert right[2][1] == pytest.approx([1.085, -3 - 0.41, 2 - 0.422])  # the shin, back


def damaged(column, value):
    return [STANDING, [*STANDING[:column], value, *STANDING[column + 1 :]], STANDING]


SHORT = ": frame 2: {} values, 44 expected; only humanoid3d is read"


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        ("{\n'Frames': []}",
         ":2: is no JSON: Expecting property name enclosed in double quotes"),
        ("[" * 100_000, ": is no JSON: nested too deeply"),
        ("1" * 5000, ": is no JSON: a number has more than 40 digits"),
        ("[]", ": Frames must be a list of 2 to 30000 frames"),
        ('{"Frames": 3}', ": Frames must be a list of 2 to 30000 frames"),
        (json.dumps({"Frames": [STANDING]}), ": Frames must be a list of 2 to 30000 frames"),
        (json.dumps({"Frames": [STANDING, STANDING[:-1]]}), SHORT.format(43)),
        (json.dumps({"Frames": [STANDING, 3]}), SHORT.format(0)),
        (json.dumps({"Frames": damaged(5, "1")}), ": frame 2: '1' is no number"),
        (json.dumps({"Frames": damaged(5, float("nan"))}), ": is no JSON: NaN is no number"),
        (json.dumps({"Frames": damaged(5, True)}), ": frame 2: True is no number"),
        (json.dumps({"Frames": damaged(0, 0)}), ": frame 2: lasts 0 s, valid: 0.0001 to 1 s"),
        (json.dumps({"Frames": damaged(4, 0.1)}), ": frame 2: root has no unit quaternion"),
    ],
)  # fmt: skip
def test_malformed_deepmimic(tmp_path, content, complaint):
    path = written(tmp_path / "bad.json", content)
    with pytest.raises(InputError) as error:
        read_deepmimic(path)
    assert str(error.value) == f"{path}{complaint}"


# ---------------------------------------------------------------- any file


def test_by_its_ending(tmp_path):
    amc, _ = acclaim(tmp_path)
    assert "thigh" in read_capture(amc).joints  # the .asf of its name
    bvh = written(tmp_path / "A.BVH", BVH)
    assert read_capture(bvh, Wishes(rate=100.0)).time.tolist() == [0.0, 0.01]
    fbx = tmp_path / "a.fbx"
    for path, rate, complaint in (
        (fbx, None, f"{fbx}: unknown kind of file, valid: {FORMATS}"),
        (bvh, 0.0, "--rate=0: valid: 1 to 10000 Hz"),
        (bvh, float("nan"), "--rate=nan: valid: 1 to 10000 Hz"),
        (tmp_path, None, f"{tmp_path}: unknown kind of file, valid: {FORMATS}"),
        (tmp_path / "no.bvh", None, f"{tmp_path / 'no.bvh'}: no such file"),
    ):
        with pytest.raises(InputError) as error:
            read_capture(path, Wishes(rate=rate))
        assert str(error.value) == complaint


def test_no_text(tmp_path):
    path = written(tmp_path / "a.bvh", b"HIERARCHY\nROOT \xff\n")
    with pytest.raises(InputError) as error:
        read_bvh(path)
    assert str(error.value) == f"{path}:2: is no text (UTF-8)"


def test_what_is_no_human(tmp_path):
    path = written(tmp_path / "a.bvh", BVH)
    with pytest.raises(InputError) as error:
        find_landmarks(path, read_bvh(path))
    assert str(error.value) == (
        f"{path}: no joint for the left hip, such as leftupleg; name it with --map left_hip=NAME; "
        "its joints: hips, knee, ankle"
    )
