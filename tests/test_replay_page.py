"""The file of a replay: what is in it, what is not, and the words where there is none."""

import base64
import gzip
import hashlib
import json
import re
from pathlib import Path

import mujoco
import numpy as np
import pytest
from logs import changed

from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError, LogError
from rotctl.log import RunLog
from rotctl.report import stored_model
from rotctl.report.pack import pack
from rotctl.report.replay import page, replay
from rotctl.report.replay_data import data
from rotctl.report.rows import at_rate
from rotctl.report.shapes import LEFT_SHADE
from rotctl.runs.run import LOG_NAME, run

STATIC = Path(stored_model.__file__).parent / "static"
EVIL = "<script>alert(1)</script>"


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    result = run(load(["seed=1", "duration=1"]), tmp_path_factory.mktemp("runs"))
    return RunLog.open(result.folder / LOG_NAME)


@pytest.fixture(scope="module")
def html(log):
    return page(log)


def element(html, opening, closing="</script>"):
    return html.split(opening, 1)[1].split(closing, 1)[0]


def sha(text):
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()


# ---------------------------------------------------------------- the page


def test_the_policy_allows_this_style_and_this_script_alone(html):
    policy = element(html, 'Content-Security-Policy" content="', '"')
    style, script = element(html, "<style>", "</style>"), html.rsplit("<script>", 1)[1]
    assert policy == (
        f"default-src 'none'; script-src '{sha(script.split('</script>')[0])}'; "
        f"style-src '{sha(style)}'; base-uri 'none'; form-action 'none'"
    )


def test_nothing_is_loaded_from_anywhere(html):
    assert re.findall(r"https?://[^\s\"'`]+", html) == ["http://www.w3.org/1999/xhtml"]
    assert not re.findall(r"<(?:link|img|iframe|script[^>]+src)", html)


def test_the_same_log_gives_the_same_page(log, html):
    assert page(log) == html


def test_twenty_seconds_stay_under_three_megabytes(log, html):
    block = len(element(html, 'id="bytes">'))
    seconds = log["trajectory/time"][-1]
    assert len(html) - block + 20.0 / seconds * block < 3e6


def test_a_strangers_names_are_text(log, tmp_path):
    outcome = {"behaviour": EVIL, "success": False, "failure_reason": f"{EVIL} & $style"}
    hostile = changed(log, tmp_path, outcome=outcome, run_id=f'"{EVIL}')
    html = page(hostile, hostile)
    assert EVIL not in html
    assert "<h1>&lt;script&gt;alert(1)&lt;/script&gt;</h1>" in html
    assert "FAILED: &lt;script&gt;alert(1)&lt;/script&gt; &amp; $style" in html
    assert html.count("<script") == 3


@pytest.mark.parametrize(
    ("outcome", "verdict"),
    [
        (
            {"success": True, "revolutions": 2.0, "duration": 3.0},
            '<p class="verdict good">success: 2.0 revolutions in 3.0 s</p>',
        ),
        (
            {"success": False, "failure_reason": "stalled"},
            '<p class="verdict bad">FAILED: stalled</p>',
        ),
        ({}, '<p class="verdict ">outcome unknown</p>'),
    ],
)
def test_the_verdict_is_in_the_heading(log, tmp_path, outcome, verdict):
    assert verdict in page(changed(log, tmp_path, outcome=outcome))


def test_the_bundle_was_made_from_the_source():
    source = b"".join(path.read_bytes() for path in sorted((STATIC / "source").glob("*.js")))
    first = (STATIC / "replay.js").read_text(encoding="utf-8").splitlines()[0]
    assert f"source {hashlib.sha256(source).hexdigest()};" in first, "see static/BUILD.md"


def test_the_licence_of_three_is_there():
    assert "The MIT License" in (STATIC / "three.LICENSE").read_text(encoding="utf-8")


# ---------------------------------------------------------------- the data


def test_poses_are_those_of_mujoco(log):
    (run,) = data(log, None)["runs"]
    model, frames = stored_model.load(log), run["frames"]
    state = mujoco.MjData(model)
    for i in (0, 7, len(frames["time"]) - 1):
        row = int(np.abs(log["trajectory/time"] - frames["time"][i]).argmin())
        state.qpos[:] = log["trajectory/qpos"][row]
        mujoco.mj_forward(model, state)
        np.testing.assert_allclose(frames["positions"][i], state.xpos[1:], atol=1e-9)
        np.testing.assert_allclose(frames["quaternions"][i][:, [3, 0, 1, 2]], state.xquat[1:])
        np.testing.assert_allclose(frames["com"][i], log["trajectory/com"][row], atol=1e-6)
        assert frames["ground"][i] == 0.0


def test_left_limbs_are_darker(log):
    (run,) = data(log, None)["runs"]
    model = stored_model.load(log)
    left, right = (run["bodies"][model.body(f"foot_{side}").id - 1] for side in "lr")
    shades = np.array([shape["colour"] for shape in left]) / [shape["colour"] for shape in right]
    np.testing.assert_allclose(shades, LEFT_SHADE, atol=1e-3)


def test_contacts_of_a_frame_are_those_of_its_row(log):
    found = data(log, None)["contacts"]
    model = stored_model.load(log)
    weight = model.body_subtreemass[1] * 9.81
    rows = at_rate(log["trajectory/time"], 30.0)
    i = next(i for i, row in enumerate(rows) if (log["contacts/body"][row] >= 0).sum() >= 2)
    here, filled = slice(*found["start"][i : i + 2]), log["contacts/body"][rows[i]] >= 0
    for name, key in (("realised", "force_realised"), ("predicted", "force_predicted")):
        expected = log[f"contacts/{key}"][rows[i]][filled] / weight
        np.testing.assert_allclose(found[name][here], expected, rtol=1e-5)
    np.testing.assert_array_equal(found["used"][here], log["contacts/used"][rows[i]][filled])


def test_arrows_of_a_small_body_are_as_long_as_in_its_filmstrip(tmp_path):
    """Of an eighth of the weight half as long, for the same number of body weights."""
    result = run(load(["duration=0.1", "character.mass=8.75"]), tmp_path)
    log = RunLog.open(result.folder / LOG_NAME)
    found = data(log, None)["contacts"]
    rows = at_rate(log["trajectory/time"], 30.0)
    i = next(i for i, row in enumerate(rows) if (log["contacts/body"][row] >= 0).any())
    filled = log["contacts/body"][rows[i]] >= 0
    expected = log["contacts/force_realised"][rows[i]][filled] / (8.75 * 9.81) / 2
    here = slice(*found["start"][i : i + 2])
    np.testing.assert_allclose(found["realised"][here], expected, rtol=1e-3)
    assert "body weight = 0.23&nbsp;m" in page(log)


def test_a_run_that_broke_down_is_played_until_there(log, tmp_path):
    states, spin = log["trajectory/qpos"].copy(), log["trajectory/angular_velocity"].copy()
    states[30:] = np.nan
    spin[20:] = np.inf
    broken = changed(
        log, tmp_path, {"trajectory/qpos": states, "trajectory/angular_velocity": spin}
    )
    tree = data(broken, None)
    assert tree["duration"] == pytest.approx(log["trajectory/time"][29])
    json.loads(pack(tree)[0])


def test_two_runs_share_one_clock(log, tmp_path):
    states = log["trajectory/qpos"].copy()
    states[30:] = np.nan
    short = changed(log, tmp_path, {"trajectory/qpos": states})
    tree = data(short, log)
    assert [len(run["frames"]["time"]) for run in tree["runs"]] == [15, 30]
    assert tree["duration"] == log["trajectory/time"][-1]
    assert {line["role"] for panel in tree["panels"] for line in panel["series"]} >= {"ghost"}


def test_rows_at_a_rate_are_even_and_never_twice():
    time = np.arange(60) / 60.0
    assert at_rate(time, 30.0) == list(range(0, 60, 2))
    assert at_rate(time[:1], 30.0) == [0]
    assert at_rate(time, 1000.0) == list(range(60))


def test_packed_arrays_come_back():
    tree = {"a": np.arange(3, dtype=np.int64), "b": [np.array([True, False]), np.nan, "</s"]}
    text, block = pack(tree)
    assert "<" not in text
    packed, content = json.loads(text), gzip.decompress(base64.b64decode(block))
    kind, offset, size = packed["a"]["$array"]
    assert (kind, np.frombuffer(content, "<i4", size, offset).tolist()) == ("i4", [0, 1, 2])
    kind, offset, size = packed["b"][0]["$array"]
    assert (kind, np.frombuffer(content, "u1", size, offset).tolist()) == ("u1", [1, 0])
    assert packed["b"][1:] == [None, "</s"]


def test_floats_are_rounded_to_half_a_millimetre_and_infinity_stays():
    values = np.append(np.random.default_rng(0).normal(0.0, 10.0, 1000), [np.inf, np.nan, 1e38])
    text, block = pack({"a": values})
    kind, offset, size = json.loads(text)["a"]["$array"]
    found = np.frombuffer(gzip.decompress(base64.b64decode(block)), "<f4", size, offset)
    assert 1e-4 < abs(found[:1000] - values[:1000]).max() < 0.25e-3
    np.testing.assert_array_equal(found[1000:], values[1000:].astype("f4"))


# ---------------------------------------------------------------- bad input


def test_a_run_without_a_drawable_step_is_refused(log, tmp_path):
    states = np.full_like(log["trajectory/qpos"], np.nan)
    broken = changed(log, tmp_path, {"trajectory/qpos": states})
    with pytest.raises(LogError) as caught:
        page(broken)
    assert str(caught.value) == f"{broken.path}: has no step that could be drawn"


def test_a_folder_that_is_not_there_is_named(log, tmp_path):
    out = tmp_path / "nowhere" / "replay.html"
    with pytest.raises(InputError) as caught:
        replay(log, out)
    assert str(caught.value) == f"cannot write {out}: No such file or directory"


def test_the_command_writes_beside_the_log_and_complains_in_one_line(log, capsys, monkeypatch):
    assert main(["replay", str(log.path), "--compare", str(log.path)]) == 0
    out = log.path.with_name("replay.html")
    assert capsys.readouterr().out == f"{out}\n"
    assert "compared with forward_roll_1" in out.read_text(encoding="utf-8")
    for arguments, said in (
        (["nothing.h5"], "rotctl: nothing.h5: no such file\n"),
        ([str(log.path), "--compare", "nothing.h5"], "rotctl: nothing.h5: no such file\n"),
        (
            ["."],
            "rotctl: .: is a folder without run.h5; name a run, "
            "its folder or the log in it; rotctl ls . lists them\n",
        ),
    ):
        assert main(["replay", *arguments]) == 2
        assert capsys.readouterr() == ("", said)


# ---------------------------------------------------------------- terrain


def test_height_fields_and_boxes_are_shown_and_stood_on(log, tmp_path):
    slope = " ".join(f"{x / 200:.3f}" for _ in range(2) for x in range(201))
    model = log.model_xml.replace(
        "<asset>",
        f'<asset><hfield name="h" nrow="2" ncol="201" size="10 5 2 1" elevation="{slope}"/>',
    ).replace(
        '<geom name="ground"',
        '<geom type="hfield" hfield="h"/><geom type="box" size=".3 1 .2"/><geom name="ground"',
    )
    (run,) = data(changed(log, tmp_path, model_xml=model), None)["runs"]
    assert [shape["kind"] for shape in run["world"]] == ["hfield", "box", "plane"]
    field = run["world"][0]
    assert (field["rows"], field["columns"]) == (2, 129)
    np.testing.assert_allclose(field["heights"][0, [0, 64, -1]], [0.0, 1.0, 2.0])
    x = run["frames"]["com"][:, 0]
    np.testing.assert_allclose(run["frames"]["ground"], 1.0 + 0.1 * x, atol=1e-6)
