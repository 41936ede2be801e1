"""A log in the formats of others, read back by other code than wrote it."""

import json
import struct
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest
from captures import adult
from scipy.spatial.transform import Rotation

from rotctl.cli.main import main
from rotctl.export.mjcf import mjcf
from rotctl.export.movement import movement
from rotctl.log import RunLog
from rotctl.motion.landmarks import find_landmarks
from rotctl.motion.reading import Wishes, read_capture
from rotctl.motion.retarget import retarget

FILE = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])  # x left, y up, z forward


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    out = tmp_path_factory.mktemp("export") / "a"
    assert (
        main(
            [
                "run",
                "behaviour=forward_roll_1_on_head",
                "duration=1",
                "seed=2001",
                "--out",
                str(out),
            ]
        )
        == 0
    )
    return RunLog.open(next(out.glob("*/run.h5")))


@pytest.fixture
def exported(log, tmp_path):
    def call(to, ending):
        path = tmp_path / f"a{ending}"
        assert main(["export", str(log.path), "--to", to, "--out", str(path)]) == 0
        return path

    return call


def test_the_bodies_of_a_bvh_are_where_they_were(log, exported):
    """Read as the format's description says, by a reader of a dozen lines."""
    skeleton, motion = exported("bvh", ".bvh").read_text().split("MOTION\n")
    rows = np.array([line.split() for line in motion.splitlines()[2:]], dtype=float)
    run = movement(log)
    places, stack, column, name = {}, [], 0, ""
    for line in skeleton.splitlines():
        word, *rest = line.split()
        if word in ("ROOT", "JOINT"):
            name = rest[0]
        elif word == "End":
            name = ""
        elif word == "OFFSET":
            offset = np.array(rest, dtype=float)
        elif word == "CHANNELS":
            at = rows[:, column : column + 3] if len(rest) == 7 else offset
            column += 3 if len(rest) == 7 else 0
            turn = Rotation.from_euler("ZXY", rows[:, column : column + 3], degrees=True)
            column += 3
            if stack:
                above, place = stack[-1]
                at, turn = (
                    place + above.apply(np.broadcast_to(at, place.shape).copy()),
                    above * turn,
                )
            stack.append((turn, at))
            places[name] = at
        elif word == "}" and name:
            stack.pop()
        elif word == "}":
            name = "of a joint"
    assert column == rows.shape[1]
    for body in run.character:
        there = run.place[:, body] @ FILE.T * 100
        assert np.abs(places[run.name(body)] - there).max() < 1e-3  # [cm]


def test_our_importer_reads_a_bvh_back(log, exported):
    path = exported("bvh", ".bvh")
    capture = read_capture(path)
    fitted = retarget(adult(), find_landmarks(path, capture))
    error = np.degrees(fitted.error)  # simulated joints give way beyond their ranges
    assert np.median(error, axis=0).max() < 1.0
    assert np.percentile(error, 95) < 3.0
    names = adult().joint_names
    chosen = [i for i, name in enumerate(names) if name.startswith(("knee", "elbow", "hip_y"))]
    angles = log["trajectory/qpos"][:, 7:]
    assert np.abs(fitted.motion.poses - angles)[:, chosen].max() < 0.06
    root = fitted.root - log["trajectory/qpos"][:, :3] * fitted.leg / 0.8595
    assert np.abs(root - root.mean(axis=0)).max() < 0.02


def test_our_importer_reads_tables_back(log, exported, tmp_path):
    robot = exported("mjcf", ".xml")
    run = movement(log)
    for path in (exported("csv", ".csv"), exported("npz", ".npz")):
        rate = 60.0 if path.suffix == ".csv" else None
        capture = read_capture(path, Wishes(model=robot, rate=rate))
        assert capture.time == pytest.approx(log["trajectory/time"])
        for body in run.character:
            assert np.abs(capture.joints[run.name(body)].position - run.place[:, body]).max() < 1e-6


def test_the_velocities_of_an_npz_are_those_of_its_places(log, exported):
    arrays = np.load(exported("npz", ".npz"), allow_pickle=False)
    # The velocity at a row is to the next, as MuJoCo integrates, but for four steps between.
    there = np.diff(arrays["body_pos_w"], axis=0) * arrays["fps"]
    mean = 0.5 * (arrays["body_lin_vel_w"][1:] + arrays["body_lin_vel_w"][:-1])
    assert np.corrcoef(there.ravel(), mean.ravel())[0, 1] > 0.99
    turned = Rotation.from_quat(arrays["body_quat_w"].reshape(-1, 4), scalar_first=True)
    shape = arrays["body_quat_w"].shape[:2]
    steps = [
        (turned[i * shape[1] + k] * turned[(i - 1) * shape[1] + k].inv()).as_rotvec()
        for i in range(1, shape[0])
        for k in (0, 5)
    ]
    mean = 0.5 * (arrays["body_ang_vel_w"][1:] + arrays["body_ang_vel_w"][:-1])[:, [0, 5]]
    there = np.array(steps).ravel() * arrays["fps"]
    assert np.corrcoef(there, mean.ravel())[0, 1] > 0.99
    assert arrays["joint_names"].tolist() == list(adult().joint_names)
    assert np.array_equal(arrays["qpos"], log["trajectory/qpos"])


def opened(path):
    """JSON and arrays of a .glb."""
    content = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", content)
    assert (magic, version, length) == (b"glTF", 2, len(content))
    size, kind = struct.unpack_from("<I4s", content, 12)
    tree = json.loads(content[20 : 20 + size])
    assert kind == b"JSON"
    binary = content[20 + size + 8 :]
    assert struct.unpack_from("<I4s", content, 20 + size) == (len(binary), b"BIN\0")

    def array(number):
        accessor = tree["accessors"][number]
        view = tree["bufferViews"][accessor["bufferView"]]
        kind = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        start, end = view["byteOffset"], view["byteOffset"] + view["byteLength"]
        return np.frombuffer(binary[start:end], kind).reshape(accessor["count"], width)

    return tree, array


def test_a_gltf_moves_as_the_run_did(log, exported):
    tree, array = opened(exported("gltf", ".glb"))
    run, frame = movement(log), 40
    (animation,) = tree["animations"]
    moved = {}
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        assert array(sampler["input"])[:, 0] == pytest.approx(log["trajectory/time"], abs=1e-5)
        target = channel["target"]
        moved[target["node"], target["path"]] = array(sampler["output"])[frame]
    waiting = [(0, Rotation.identity(), np.zeros(3))]
    while waiting:
        number, above, place = waiting.pop()
        node = tree["nodes"][number]
        at = moved.get((number, "translation"), node.get("translation", [0, 0, 0]))
        turn = moved.get((number, "rotation"), node.get("rotation", [0, 0, 0, 1]))
        place, above = place + above.apply(at), above * Rotation.from_quat(turn)
        waiting += [(child, above, place) for child in node.get("children", [])]
        x, y, z = run.place[frame, number]
        assert place == pytest.approx([x, z, -y], abs=1e-5)
        if "mesh" in node and number:
            (shape,) = tree["meshes"][node["mesh"]]["primitives"]
            points = array(shape["attributes"]["POSITION"])
            assert array(shape["indices"]).max() < len(points)
            assert np.linalg.norm(array(shape["attributes"]["NORMAL"]), axis=1) == pytest.approx(1)
            assert np.abs(points).max() < 0.5


@pytest.mark.parametrize("terrain", ["stairs_up", "uneven", "obstacles"])
def test_the_triangles_of_a_gltf_face_outward(tmp_path, terrain):
    from rotctl.config.loading import load
    from rotctl.export.meshes import mesh_of
    from rotctl.runs.scenario import model_of

    mj = model_of(load([f"terrain={terrain}"])).mj
    for geom in range(mj.ngeom):
        mesh = mesh_of(mj, geom)
        a, b, c = mesh.vertices[mesh.corners].transpose(1, 0, 2)
        out = np.cross(b - a, c - a)
        normals = mesh.normals[mesh.corners].mean(axis=1)
        wide = np.linalg.norm(out, axis=1) > 1e-9  # the pole of a sphere has triangles without
        assert ((out * normals).sum(axis=1)[wide] > 0).all()


def test_the_model_for_others_moves_bit_by_bit_as_ours(log, exported):
    text = exported("mjcf", ".xml").read_text()
    states = []
    for model in (log.model_xml, text):
        mj = mujoco.MjModel.from_xml_string(model)
        data = mujoco.MjData(mj)
        data.qpos[:], data.qvel[:] = log["trajectory/qpos"][0], log["trajectory/qvel"][0]
        for torques in log["trajectory/ctrl"][:30]:
            data.ctrl[:] = torques
            mujoco.mj_step(mj, data, nstep=4)
        states.append(data.qpos.copy())
    assert np.array_equal(*states)
    root = ElementTree.fromstring(text)
    assert not list(root.iter("general"))
    assert len(list(root.iter("motor"))) == 29
    assert "autoreset" not in text
    hinges = [joint for joint in root.iter("joint") if joint.get("type") == "hinge"]
    assert len(hinges) == 29
    for joint in hinges:
        assert joint.get("axis")
        assert joint.get("solreflimit") == "0.03 1"
        assert len(joint.get("actuatorfrcrange").split()) == 2


def test_a_model_that_is_none_is_not_exported():
    from rotctl.errors import LogError

    with pytest.raises(LogError, match="has <include>"):
        mjcf("<mujoco><include file='/etc/passwd'/></mujoco>")


def test_a_table_without_a_rate_is_told_with_it(log, tmp_path, capsys):
    path = tmp_path / "a.csv"
    for to, out in (("csv", path), ("bvh", tmp_path / "a.bvh")):
        assert main(["export", str(log.path), "--to", to, "--out", str(out)]) == 0
        said = capsys.readouterr()
        assert said.out == f"{out}\n"
        told = "rotctl: 60 rows a second, which a .csv does not say; import-motion --rate 60\n"
        assert said.err == (told if to == "csv" else "")


def test_an_ending_must_be_right(log, tmp_path, capsys):
    out = tmp_path / "a.txt"
    assert main(["export", str(log.path), "--to", "gltf", "--out", str(out)]) == 2
    assert capsys.readouterr().err == f"rotctl: {out}: valid endings: .glb\n"
    assert not out.exists()


def test_equal_runs_give_equal_files(log, exported):
    for to, ending in (("bvh", ".bvh"), ("npz", ".npz"), ("gltf", ".glb")):
        assert exported(to, ending).read_bytes() == exported(to, ending).read_bytes()
