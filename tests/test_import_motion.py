"""Captured motion to clips: a known roll written as a BVH file comes back as it was."""

import re
from pathlib import Path

import mujoco
import numpy as np
import pytest
from captures import adult, bvh_text, in_order
from PIL import Image
from scipy.spatial.transform import Rotation

from rotctl.choices.config_folders import conf_dir
from rotctl.cli.clip_wording import _clock
from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.motion import load_clip
from rotctl.motion.flight import ADULT_LEG, Flight, flights
from rotctl.motion.glance import require_motion
from rotctl.motion.importing import import_motion
from rotctl.motion.landmarks import find_landmarks
from rotctl.motion.preview import motion_of
from rotctl.motion.reading import read_capture
from rotctl.motion.turning import rotation_between_postures
from rotctl.motion.writing import text
from rotctl.runs.run import in_memory
from rotctl.runs.scenario import build

SHARED = Path(__file__).resolve().parents[1].parent / "shared" / "motions"
LIMBS = ("hip", "knee", "shoulder", "elbow")


def imported(path, text, **settings):
    path.write_text(text)
    return import_motion(adult(), "adult", path, read_capture(path), **settings)


def limbs(clip):
    """Angles of the limbs that directions determine (n, k), and the trunk's sum."""
    model = adult()
    poses = clip.poses(model)
    index = {name: i for i, name in enumerate(model.joint_names)}
    chosen = [i for name, i in index.items() if name.startswith(("knee", "elbow", "hip_y"))]
    return np.c_[poses[:, chosen], poses[:, index["waist_y"]] + poses[:, index["chest_y"]]]


@pytest.mark.parametrize(
    ("name", "order"),
    [
        ("forward_roll", "ZXY"),
        ("backward_roll", "XYZ"),
        ("parkour_roll", "ZYX"),
        ("log_roll", "YZX"),
    ],
)
def test_a_known_roll_comes_back(tmp_path, name, order):
    # Rolled to another direction, starting somewhere in the cycle, in centimetres.
    positions = in_order(name, turns=1.0, heading=0.7, offset=0.1)
    made = imported(tmp_path / "known.bvh", bvh_text(positions, order=order), cycle=(0.0, 99 / 60))
    shipped = load_clip(name)
    assert made.clip.roll_about == shipped.roll_about
    assert np.degrees(np.median(made.error)) < 0.5
    assert made.span == pytest.approx(1.0, abs=0.07)  # not 1: the pelvis turns once, not the body
    assert made.closed.backwards == 0.0
    assert np.abs(made.closed.gap).max() < 0.03
    assert np.abs(limbs(made.clip) - limbs(shipped)).max() < 0.03
    apart = motion_of(adult(), made.clip).pelvis * motion_of(adult(), shipped).pelvis.inv()
    heading = apart.mean()  # the import's is where most of the turning goes, the author's is not
    assert np.linalg.norm(heading.as_rotvec()[:2]) < 0.01
    assert (heading.inv() * apart).magnitude().max() < 0.03


def test_the_phase_is_even_in_the_turn_of_the_whole_body(tmp_path):
    # One roll at an uneven pace, which the clip must not keep.
    pace = np.linspace(0.0, 1.0, 100)
    pace = pace + 0.1 * np.sin(2 * np.pi * pace)
    even = in_order("forward_roll", turns=1.0, frames=2001)
    made = imported(tmp_path / "a.bvh", bvh_text(even[np.round(2000 * pace).astype(int)]))
    turns = rotation_between_postures(adult(), motion_of(adult(), made.clip))[:, 1]
    assert turns.max() / turns.min() < 1.05


def test_the_roll_is_found_between_standing_about(tmp_path):
    roll = in_order("forward_roll", turns=1.0, frames=60)
    stands = [np.repeat(roll[[k]], 30, axis=0) for k in (0, -1)]
    made = imported(tmp_path / "a.bvh", bvh_text(np.concatenate([stands[0], roll, stands[1]])))
    assert made.start == pytest.approx(30 / 60, abs=0.06)
    assert made.end == pytest.approx(89 / 60, abs=0.06)
    assert made.clip.rate == pytest.approx(1.0, abs=0.1)


def test_a_rock_on_the_back_is_no_roll(tmp_path, cli):
    path = tmp_path / "a.bvh"
    path.write_text(bvh_text(in_order("forward_roll", turns=0.5)))
    code, _, error = cli("import-motion", path, "--out", tmp_path / "a.yaml")
    assert code == 2
    assert re.fullmatch(
        r"rotctl: .*a\.bvh: no roll found: the body turns 0\.\d\d rev at most; "
        r"give --cycle START:END \[s\] for less than one\n",
        error,
    )


def test_noise_is_no_motion_and_is_not_fitted(tmp_path, cli, monkeypatch):
    """Postures one after the other that have nothing to do with each other."""
    monkeypatch.setattr("rotctl.motion.importing.retarget", None)
    generator, n = np.random.default_rng(3), 40
    positions = generator.normal(size=(n, adult().mj.nq))
    positions[:, 3:7] /= np.linalg.norm(positions[:, 3:7], axis=1, keepdims=True)
    positions[:, 7:] = generator.uniform(*adult().joint_range.T, (n, adult().mj.nu))
    path = tmp_path / "noise.bvh"
    path.write_text(bvh_text(positions))
    code, _, stderr = cli("import-motion", path, "--out", tmp_path / "a.yaml")
    assert code == 2
    assert re.fullmatch(
        rf"rotctl: {path}: from one frame to the next the points of the body turn by a median of "
        r"(8|9)\d deg about its middle: that is no motion\n",
        stderr,
    )


def test_six_frames_a_revolution_are_a_motion(tmp_path):
    path = tmp_path / "roll.bvh"
    path.write_text(bvh_text(in_order("forward_roll", turns=2.0, frames=13), rate=6.0))
    require_motion(path, find_landmarks(path, read_capture(path)))


def test_the_other_way_round_is_a_mirror_image(tmp_path):
    # Half a turn about the way it rolls, and a log roll has its head on the other side.
    positions = in_order("log_roll", turns=1.0)
    turned = Rotation.from_rotvec([0.0, 0.0, np.pi])
    positions[:, :3] = turned.apply(positions[:, :3])
    quaternions = Rotation.from_quat(positions[:, 3:7], scalar_first=True)
    positions[:, 3:7] = (turned * quaternions).as_quat(scalar_first=True)
    assert not imported(tmp_path / "a.bvh", bvh_text(positions)).mirrored
    made = imported(tmp_path / "b.bvh", bvh_text(positions[::-1]))  # back again
    assert made.mirrored
    assert made.clip.roll_about == "head"
    # Mirrored and backwards, the leg that crosses is the other one.
    assert np.ptp(made.clip.joints["hip_y_r"]) == pytest.approx(
        np.ptp(load_clip("log_roll").joints["hip_y_l"]), abs=0.03
    )


def test_symmetric_is_symmetric_and_between_both(tmp_path):
    text = bvh_text(in_order("parkour_roll", turns=1.0))
    made = imported(tmp_path / "a.bvh", text, symmetrise=True)
    left, right = (made.clip.poses(adult())[:, [i]] for i in _pair("hip_y"))
    assert np.array_equal(left, right)
    assert not made.clip.poses(adult())[:, adult().joint_names.index("waist_z")].any()
    w, x, y, z = np.array(made.clip.pelvis).T
    assert not x.any()
    assert not z.any()


def _pair(joint):
    return [adult().joint_names.index(f"{joint}_{side}") for side in "lr"]


@pytest.mark.parametrize(
    ("clock", "warned"), [(1.0, False), (1.1, False), (2.4, True), (0.5, True)]
)
def test_what_flies_must_fall(tmp_path, cli, clock, warned):
    # A tuck thrown up, turning about its centre of mass: 0.8 s of flight, standing before.
    times = np.arange(-0.3, 1.1, 1 / 60)
    roll = in_order("forward_roll", turns=1.0, frames=2)[0]
    positions = np.repeat(roll[None], len(times), axis=0)
    flying = np.clip(times, 0.0, 0.8)
    positions[:, 2] += 9.81 * flying * (0.8 - flying) / 2
    turn = Rotation.from_rotvec(np.outer(2 * np.pi * flying / 0.8, [0.0, 1.0, 0.0]))
    start = Rotation.from_quat(roll[3:7], scalar_first=True)
    positions[:, 3:7] = (turn * start).as_quat(scalar_first=True)
    offset = _centre(roll) - roll[:3]
    positions[:, :3] += offset - turn.apply(offset)
    path = tmp_path / "flip.bvh"
    path.write_text(bvh_text(positions, rate=60 * clock))
    code, out, error = cli("import-motion", path, "--out", tmp_path / "flip.yaml")
    assert code == 0
    (fall,) = re.findall(r"falls at ([0-9.]+) m/s2", out)
    assert float(fall) == pytest.approx(9.81 * clock**2, rel=0.02)
    assert ("warning: the flight" in error) == warned
    if warned:
        assert f"the file's clock runs {clock:.2f} times as fast" in error


@pytest.mark.parametrize(
    ("first", "last", "found"), [(-0.3, 1.1, 1), (0.3, 1.1, 0), (-0.3, 0.5, 0)]
)
def test_a_flight_takes_off_and_lands(first, last, found):
    """What a capture begins or ends with hangs in the air, as rolls in poor captures do."""
    times = np.arange(first, last, 1 / 60)
    positions = np.repeat(
        in_order("forward_roll", turns=1.0, frames=2)[0][None], len(times), axis=0
    )
    flying = np.clip(times, 0.0, 0.8)
    positions[:, 2] += 9.81 * flying * (0.8 - flying) / 2
    assert len(flights(adult(), times, positions, ADULT_LEG)) == found


def test_who_hardly_falls_is_asked_for_the_rate_too():
    """A .csv of 240 rows a second, read as 30, falls at 0.15 m/s2."""
    told = _clock(Flight(1.0, 3.0, 9.81 / 8**2))
    assert told.endswith("is up up, do the hips move, is the rate right? See --up and --rate")


@pytest.mark.parametrize(("height", "found"), [(0.2, 0), (0.3, 1)])
def test_what_is_lifted_by_other_proportions_is_no_flight(height, found):
    """The roll of a body of 1.55 m, exported and put on the adult, came to 0.21 m."""
    times = np.arange(-0.3, 1.1, 1 / 60)
    roll = in_order("forward_roll", turns=1.0, frames=2)[0]
    positions = np.repeat(roll[None], len(times), axis=0)
    flying = np.clip(times, 0.0, 0.8)
    positions[:, 2] += height * flying * (0.8 - flying) / 0.16
    assert len(flights(adult(), times, positions, ADULT_LEG)) == found


def _centre(position):
    mj = adult().mj
    data = mujoco.MjData(mj)
    data.qpos[:] = position
    mujoco.mj_forward(mj, data)
    return mj.body_mass @ data.xipos / mj.body_mass.sum()


# ---------------------------------------------------------------- the commands


@pytest.fixture(scope="module")
def captured(tmp_path_factory):
    path = tmp_path_factory.mktemp("captured") / "roll.bvh"
    path.write_text(bvh_text(in_order("forward_roll", turns=1.0, frames=60)))
    return path


def test_import_says_what_it_made_of_the_file(captured, tmp_path, cli, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, stdout, stderr = cli("import-motion", captured, "--out", "my roll")
    assert (code, stderr) == (0, "")
    lines = stdout.splitlines()
    assert re.fullmatch(r"forward roll, \d\.\d{3} to \d\.\d{3} s of the file", lines[0])
    assert lines[1:5] == [
        "  up           the file's y; if not, see --up",
        "  trunk        Actor_Hips, Actor_Head, Actor_Head",
        "  left         Actor_LeftUpLeg, Actor_LeftLeg, Actor_LeftFoot, -, Actor_LeftArm, "
        "Actor_LeftForeArm, Actor_LeftHand",
        "  right        Actor_RightUpLeg, Actor_RightLeg, Actor_RightFoot, -, Actor_RightArm, "
        "Actor_RightForeArm, Actor_RightHand",
    ]
    parts = [line.split()[0] for line in lines[6:12]]
    assert parts == ["pelvis"] * 2 + ["chest"] * 2 + ["head"] * 2
    assert re.search(r"turns +0\.\d\d rev in 0\.\d\d s, 1\.0\d rev/s, 2\.\d\d m/s", stdout)
    assert re.search(r"loop gap +0\.\d\d rad rms, 0\.\d\d rad at most \(\w+\), pelvis", stdout)
    assert lines[-1] == "clip       my roll.yaml"
    assert load_clip(str(tmp_path / "my roll.yaml")).name == "roll"


@pytest.mark.usefixtures("drawing")
def test_a_clip_in_a_conf_of_ones_own_is_found(tmp_path, cli, monkeypatch):
    monkeypatch.chdir(tmp_path)
    keys = conf_dir() / "motion" / "keys" / "log_roll.yaml"
    assert cli("author-motion", keys, "--out", "elsewhere/mine.yaml")[0] == 0
    assert not (tmp_path / "elsewhere" / "rotctl.yaml").exists()
    assert cli("author-motion", keys, "--out", "conf/motion/mine.yaml")[0] == 0
    assert cli("preview-motion", "mine", "--out", tmp_path / "a.png", "--frames", 2)[0] == 0


@pytest.mark.parametrize("drawn", [False, True])
def test_a_picture_of_an_older_clip_is_told(tmp_path, cli, monkeypatch, drawn):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("rotctl.cli.commands.clips._draw_clip", refused)
    keys = conf_dir() / "motion" / "keys" / "log_roll.yaml"
    author = ("author-motion", keys, "--out", "mine.yaml", *(["--filmstrip"] if drawn else []))
    why = "rotctl: no filmstrip: no OpenGL\n" if drawn else ""
    assert cli(*author) == (0, "clip       mine.yaml\n", why)
    (tmp_path / "mine.png").write_bytes(b"older")
    older = "rotctl: warning: mine.png: is older than the clip and does not show it\n"
    assert cli(*author) == (0, "clip       mine.yaml\n", why + older)
    assert (tmp_path / "mine.png").read_bytes() == b"older"


def refused(*_):
    raise InputError("no OpenGL")


@pytest.mark.usefixtures("drawing")
def test_import_author_and_preview_draw(captured, tmp_path, cli, monkeypatch):
    monkeypatch.setattr("rotctl.cli.commands.clips.CLIP_FRAMES", 2)
    out = tmp_path / "clip.yaml"
    keys = conf_dir() / "motion" / "keys" / "log_roll.yaml"
    for command, file in (("import-motion", captured), ("author-motion", keys)):
        code, said, error = cli(command, file, "--out", out, "--filmstrip")
        assert (code, error) == (0, "")
        assert said.endswith(f"clip       {out}\nfilmstrip  {out.with_suffix('.png')}\n")
    assert load_clip(str(out)) == load_clip("log_roll")
    mine = tmp_path / "mine"
    (mine / "motion").mkdir(parents=True)
    own = ("--out", mine / "motion" / "log_roll.yaml", "--config-dir", mine)
    assert cli("author-motion", keys, *own) == (
        2,
        "",
        f"rotctl: {own[1]}: there is a motion of that name that comes with rotctl; give yours "
        "another\n",
    )
    picture = tmp_path / "preview.png"
    assert cli("preview-motion", "log_roll", "--out", picture, "--frames", 2) == (
        0,
        f"{picture}\n",
        "",
    )
    drawn = np.asarray(Image.open(picture))
    assert np.array_equal(drawn, np.asarray(Image.open(out.with_suffix(".png"))))
    assert len(np.unique(drawn.reshape(-1, 3), axis=0)) > 1000


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["import-motion", "{roll}", "--out", "{tmp}/a", "--cycle", "0.2:9"],
         "--cycle=0.2:9: valid: 0 to 0.983 s, START before END"),
        (["import-motion", "{roll}", "--out", "{tmp}/a", "--cycle", "0.5:0.2"],
         "--cycle=0.5:0.2: valid: 0 to 0.983 s, START before END"),
        (["import-motion", "{roll}", "--out", "{tmp}/a", "--cycle", "0.5:0.51"],
         "--cycle=0.5:0.51: 1 frames, at least 5"),
        (["import-motion", "{roll}", "--out", "{tmp}/a", "--cycle", "0.1:0.2"],
         "no roll about one axis: the body turns 0.1"),
        (["import-motion", "{roll}", "--out", "{roll}/a"], "cannot write {roll}: File exists"),
        (["import-motion", "{roll}", "--out", "{tmp}/a", "--character", "nobody"],
         "nobody"),
        (["preview-motion", "{roll}", "--out", "{tmp}/a"], "{roll}:"),
        (["preview-motion", "log_roll", "--out", "{tmp}/a", "--frames", "0"],
         "frames is 0, valid: 1 to 200"),
        (["author-motion", "{roll}", "--out", "{tmp}/a"], "{roll}:"),
    ],
)  # fmt: skip
def test_misuse_is_one_line(captured, tmp_path, cli, arguments, complaint):
    names = {"roll": captured, "tmp": tmp_path}
    code, out, error = cli(*(text.format(**names) for text in arguments))
    assert (code, out) == (2, "")
    assert error.startswith("rotctl: ")
    assert complaint.format(**names) in error
    assert error.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_a_cycle_that_is_none(capsys):
    with pytest.raises(SystemExit):
        main(["import-motion", "a.bvh", "--out", "a", "--cycle", "1-2"])
    assert "'1-2': valid: START:END in seconds" in capsys.readouterr().err


# ---------------------------------------------------------------- real captures, where they are


@pytest.mark.parametrize(
    ("file", "kind", "rate", "fall"),
    [
        ("DeepMimic/humanoid3d_roll.txt", "left", (0.5, 1.0), None),
        ("DeepMimic/humanoid3d_backflip.txt", "right", (0.6, 1.7), (5.0, 9.0)),
        ("MASS/MASS_backflip.bvh", "right", (0.9, 3.0), (45.0, 70.0)),
        ("CMU/backflip.amc", "right", (1.0, 3.3), (45.0, 70.0)),
    ],
)
def test_real_captures(file, kind, rate, fall):
    path = SHARED / file
    if not path.exists():
        pytest.skip(f"no {path}")
    made = import_motion(adult(), "adult", path, read_capture(path))
    assert made.clip.roll_about == kind
    assert rate[0] < made.clip.rate < rate[1]
    error = dict(zip(made.segments, np.degrees(np.median(made.error, axis=0)), strict=True))
    assert max(v for name, v in error.items() if not name.startswith("foot")) < 4.0
    if fall is None:
        assert not made.flights
    else:
        assert fall[0] < made.flights[0].fall < fall[1]


def test_the_real_roll_mirror_averaged():
    path = SHARED / "DeepMimic/humanoid3d_roll.txt"
    if not path.exists():
        pytest.skip(f"no {path}")
    made = import_motion(adult(), "adult", path, read_capture(path), symmetrise=True)
    assert made.clip.source.endswith(", mirror average")
    assert made.span == pytest.approx(1.0, abs=0.05)
    assert np.degrees(made.closed.pelvis_gap) < 5.0
    assert "hip_y" in made.clip.joints


def test_the_captured_roll_rolls_on_where_it_is_bent(tmp_path):
    """As captured it stalls in its first revolution."""
    path = SHARED / "DeepMimic/humanoid3d_roll.txt"
    if not path.exists():
        pytest.skip(f"no {path}")
    made = import_motion(adult(), "adult", path, read_capture(path), symmetrise=True)
    clip = tmp_path / "roll.yaml"
    clip.write_text(text(made.clip))

    def revolutions(*overrides):
        config = load(
            [
                "behaviour=reference_roll",
                f"behaviour.reference.clip={clip}",
                "duration=5",
                *overrides,
            ]
        )
        buffer, complaint = in_memory(build(config))
        assert not complaint
        phase = buffer.trajectory.phase
        return (phase[-1] - phase[0]) / (2 * np.pi)

    assert revolutions() < 1.5
    assert sum(revolutions("+reference=humanoid3d_roll", f"seed={s}") > 4.0 for s in range(4)) >= 3
