"""A short real run as a picture, and the words where there is none."""

import os
import subprocess
import sys

import numpy as np
import pytest
from logs import changed
from PIL import Image

from rotctl.config.loading import load
from rotctl.errors import InputError, LogError
from rotctl.log import SCHEMA, RunLog
from rotctl.log.schema import MODEL_PATH
from rotctl.metrics.halts import going
from rotctl.report import filmstrip as module
from rotctl.report import frame, gl, sheet
from rotctl.report.filmstrip import filmstrip
from rotctl.report.happenings import halts, happenings, stall
from rotctl.report.moments import moments
from rotctl.report.rows import window
from rotctl.report.title import verdict
from rotctl.runs.run import LOG_NAME, run


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    result = run(load(["seed=1", "duration=0.5"]), tmp_path_factory.mktemp("runs"))
    return RunLog.open(result.folder / LOG_NAME)


@pytest.fixture
def picture(tmp_path, drawing):
    """Where to draw, on a machine that can; CI must be one unless it says otherwise."""
    return tmp_path / "strip.png"


def size(columns, rows):
    wide, high = sheet.FRAME
    return (
        2 * sheet._MARGIN + columns * (wide + sheet._GAP) - sheet._GAP,
        sheet._HEADER
        + rows * (high + sheet._CAPTION + sheet._GAP)
        + sheet._FOOTER
        + sheet._LINE * (len(sheet._lines(columns * (wide + sheet._GAP), 0.45, False)) - 1),
    )


def frames_of(path, columns, rows):
    """The pixels of each frame."""
    wide, high = sheet.FRAME
    with Image.open(path) as image:
        pixels = np.asarray(image.convert("RGB"), dtype=int)
    step = high + sheet._CAPTION + sheet._GAP
    return [
        pixels[y : y + high, x : x + wide]
        for y in range(sheet._HEADER, sheet._HEADER + rows * step, step)
        for x in range(
            sheet._MARGIN, sheet._MARGIN + columns * (wide + sheet._GAP), wide + sheet._GAP
        )
    ]


def coloured(pixels, colour):
    return int((np.abs(pixels - np.array(colour)).max(axis=-1) <= 12).sum())


def test_frames_show_a_character_that_moves_under_a_sky(log, picture):
    filmstrip(log, picture, frames=4, columns=2)
    with Image.open(picture) as image:
        assert (image.format, image.size) == ("PNG", size(columns=2, rows=2))
    frames = frames_of(picture, columns=2, rows=2)
    for pixels in frames:
        assert pixels[2].min() > 120  # sky, not black
        assert pixels.std() > 25  # and something in front of it
    assert all(np.abs(a - b).mean() > 1.0 for a, b in zip(frames, frames[1:], strict=False))


@pytest.mark.parametrize("columns", range(1, 7))
def test_words_of_the_legend_and_of_the_header_lie_beside_each_other(columns):
    """Of a narrow picture, too: what does not fit goes on in the next line, or is cut."""
    width = columns * (sheet.FRAME[0] + sheet._GAP) - sheet._GAP
    lines = sheet._lines(width, 0.45, pushed=False)
    assert len(lines) == {1: 4, 2: 2}.get(columns, 1)
    assert [text for line in lines for _, _, text in line] == [
        "contact used by the controller",
        "contact left out",
        "ground force (body weight: 0.45 m)",
        "left limbs are darker",
    ]
    font = frame.typeface(15)
    for line in lines:
        ends = [x + sheet._legend_mark(mark) + font.getlength(text) for x, mark, text in line]
        assert all(end < x for end, (x, _, _) in zip(ends, line[1:], strict=False))
        assert ends[-1] <= width
    for text in ("short", "FAILED: " + "long " * 40):
        assert frame.typeface(19).getlength(sheet._cut(text, width, 19)) <= width
    assert sheet._cut("short", width, 19) == "short"
    assert sheet._cut("short", 0.0, 19) == ""


def test_a_force_from_outside_is_an_arrow_and_told(log, picture, tmp_path):
    """It acts 0.3 m above the centre of mass, where its moment is that."""
    wrench = np.zeros((log.steps, 6))
    wrench[:, 0], wrench[:, 4] = -400.0, 0.3 * -400.0
    filmstrip(log, picture, frames=1, start=0.2)
    assert coloured(frames_of(picture, 1, 1)[0], frame.OUTSIDE) == 0
    pushed = changed(log, tmp_path, {"disturbance/wrench": wrench})
    filmstrip(pushed, picture, frames=1, start=0.2)
    assert coloured(frames_of(picture, 1, 1)[0], frame.OUTSIDE) > 120
    (moment,) = moments(pushed, [12])
    assert moment.pushed == pytest.approx(log["trajectory/com"][12] + [0.0, 0.0, 0.3])
    assert moment.push == pytest.approx([-400.0, 0.0, 0.0])
    lines = sheet._lines(2000.0, 0.45, pushed=True)
    told = "force from outside (4 times as long, 0.8 m at most)"
    assert told in [text for _, _, text in lines[0]]


def test_no_time_is_told_twice():
    assert sheet.told_times([0.0, 0.0167, 0.5]) == ["0.00 s", "0.02 s", "0.50 s"]
    assert sheet.told_times([0.0167, 0.0208, 1.0]) == ["0.017 s", "0.021 s", "1.000 s"]


def test_used_contacts_are_marked(log, picture):
    row = next(i for i in range(log.steps) if log["contacts/used"][i].any())
    time = log["trajectory/time"]
    filmstrip(log, picture, frames=1, start=float(time[row]))
    assert coloured(frames_of(picture, 1, 1)[0], frame.USED) > 20


def test_the_same_log_gives_the_same_bytes(log, picture):
    filmstrip(log, picture, frames=2)
    first = picture.read_bytes()
    filmstrip(log, picture, frames=2)
    assert picture.read_bytes() == first
    assert [path.name for path in picture.parent.iterdir()] == [picture.name]


def test_there_are_no_more_frames_than_steps(log, picture):
    filmstrip(log, picture, frames=50, start=0.0, end=0.05, columns=4)
    with Image.open(picture) as image:
        assert image.size == size(columns=4, rows=1)


@pytest.mark.parametrize(
    ("outcome", "colour"),
    [
        ({"success": True, "revolutions": 2.0, "duration": 3.0}, frame.GOOD),
        ({"success": False, "failure_reason": "stalled"}, frame.BAD),
        ({"success": "perhaps"}, frame.SOFT),
    ],
)
def test_the_title_shows_success_and_failure(log, picture, tmp_path, outcome, colour):
    filmstrip(changed(log, tmp_path, outcome=outcome), picture, frames=1)
    with Image.open(picture) as image:
        verdict = np.asarray(image.convert("RGB"), dtype=int)[50 : sheet._HEADER]
    shown = {c: coloured(verdict, c) for c in (frame.GOOD, frame.BAD, frame.SOFT)}
    assert shown[colour] > 20
    assert sum(shown.values()) == shown[colour]


@pytest.mark.parametrize(
    ("outcome", "text"),
    [
        (
            {"success": True, "revolutions": 2.0, "duration": 3.0},
            "success: 2.0 revolutions in 3.0 s",
        ),
        ({"success": True, "revolutions": 10**400}, "success"),
        (
            {"success": True, "revolved": 361.2, "flight_time": 0.64, "duration": 6.0},
            "success: turned 361 deg, 0.64 s in the air",
        ),
        (
            {"success": True, "revolved": 540.0, "entry_angle": 2.31},
            "success: enters 2.3 deg off the vertical",
        ),
        (
            {"success": True, "turned": 178.9, "arrival": 1.72},
            "success: turned 179 deg in 1.7 s",
        ),
        ({"success": True, "turned": None, "arrival": 1.72}, "success"),
        (
            {"success": False, "failure_reason": "stalled for 1.60 s from t = 1.38 s"},
            "FAILED: stalled for 1.60 s from t = 1.38 s",
        ),
        (
            {"success": False, "failure_reason": "a\nb" + "c" * 999},
            "FAILED: a b" + "c" * 134 + "...",
        ),
        ({"success": False, "failure_reason": "c" * 140}, "FAILED: " + "c" * 140),
        ({}, "outcome unknown"),
    ],
)
def test_the_verdict_in_words(outcome, text):
    assert verdict(outcome)[1] == text


def test_a_run_that_broke_down_is_drawn_until_there(log, picture, tmp_path):
    states = log["trajectory/qpos"].copy()
    states[20:, 0] = np.nan
    states[19, 1] = 1e300
    broken = changed(log, tmp_path, {"trajectory/qpos": states})
    filmstrip(broken, picture, frames=2)
    last = log["trajectory/time"][18]
    with pytest.raises(InputError, match=rf"^end \(--to\) is 0.45 s, valid: 0 to {last:g} s$"):
        filmstrip(broken, picture, end=0.45)


@pytest.mark.parametrize("end", [0.5, 0.49])
def test_a_run_may_be_drawn_until_it_is_over(end):
    """Which it is a control step after its last row begins."""
    time = np.arange(30) / 60
    assert window(time, 0.1, end) == (6, 29)
    assert window(time[:1], None, 0.0) == (0, 0)
    with pytest.raises(InputError, match=r"^end \(--to\) is 0.501 s, valid: 0 to 0.483333 s$"):
        window(time, None, 0.501)


def test_a_run_without_a_drawable_step_is_refused(log, picture, tmp_path):
    states = np.full_like(log["trajectory/qpos"], np.nan)
    broken = changed(log, tmp_path, {"trajectory/qpos": states})
    with pytest.raises(LogError) as caught:
        filmstrip(broken, picture)
    assert str(caught.value) == f"{broken.path}: has no step that could be drawn"


def test_by_default_two_turns_after_settling_are_shown_where_they_are_reached():
    time = np.arange(0, 6, 0.1)
    assert module._two_turns(time, time, 2.0) == (20, 40)
    assert module._two_turns(time, -time, 2.0) == (20, 40)
    assert module._two_turns(time, time, 3.5) == (35, 55)
    assert module._two_turns(time, 0.4 * time, 2.0) is None
    assert module._two_turns(time[:10], time[:10], 2.0) is None


def test_a_roll_that_is_pushed_is_shown_from_there(log, tmp_path):
    rows, rate = 600, 60
    turned, wrench = np.zeros((rows, 3)), np.zeros((rows, 6))
    turned[:, 1] = 2 * np.pi * 0.9 * np.arange(rows) / rate
    wrench[300:306, 1] = 400.0
    first = {
        name: np.repeat(log[name][:1], rows, axis=0)
        for name in SCHEMA
        if name != MODEL_PATH and len(log[name]) == log.steps
    }
    own = {
        "trajectory/time": np.arange(rows) / rate,
        "trajectory/angular_excursion": turned,
        "disturbance/wrench": wrench,
    }
    shown = module._rows(changed(log, tmp_path, first | own), 12, None, None)
    assert 268 <= shown[0] <= 272
    assert 300 <= min(row for row in shown if row >= 300) < 306
    wrench[:] = 0.0
    wrench[-1, 0] = 1.0
    own["trajectory/qpos"] = first["trajectory/qpos"].copy()
    own["trajectory/qpos"][590:] = np.nan  # it broke down before it was pushed
    shown = module._rows(changed(log, tmp_path, first | own), 12, None, None)
    assert shown[0] == 120
    assert np.ptp(np.diff(shown)) <= 1


def test_a_roll_that_stalls_is_shown_as_it_comes_to_that(log, tmp_path):
    """At 4 s: half a revolution before and 2 s after, and from what happened before that."""
    rows, rate = 600, 60
    time = np.arange(rows) / rate
    turned, wrench = np.zeros((rows, 3)), np.zeros((rows, 6))
    turned[:, 1] = 2 * np.pi * np.minimum(time, 4.0)
    own = {
        name: np.repeat(log[name][:1], rows, axis=0)
        for name in SCHEMA
        if name != MODEL_PATH and len(log[name]) == log.steps
    } | {"trajectory/time": time, "trajectory/angular_excursion": turned}

    def shown(success):
        outcome = {"success": success, "failure_reason": "stalled"}
        made = changed(log, tmp_path, own | {"disturbance/wrench": wrench}, outcome=outcome)
        found = module._rows(made, 12, None, None)
        return found[0] / rate, found[-1] / rate

    assert shown(True) == pytest.approx((2.0, 4.0), abs=0.05)
    assert shown(False) == pytest.approx((3.5, 6.0), abs=0.11)
    wrench[180:186, 0] = 50.0
    assert shown(False) == pytest.approx((2.5, 6.0), abs=0.11)
    wrench[:] = 0.0
    wrench[420:426, 0] = 50.0  # long after it stalled
    assert shown(False) == pytest.approx((3.5, 6.0), abs=0.11)


def test_a_halt_that_is_told_is_no_stall(log, tmp_path):
    """From 2 to 6 s it stands as it is told to; at 8 s it stalls."""
    time = np.arange(660) / 60
    turns = np.minimum(time, 2.0) + np.clip(time - 6.0, 0.0, 2.0)
    told = np.ones(660, dtype=bool)
    usual = stall(log)
    assert module._failing(time, turns, [], told, usual)[0] == pytest.approx(90, abs=7)
    rolls = going(time, [(2.0, 6.0)])
    assert module._failing(time, turns, [], rolls, usual)[0] == pytest.approx(450, abs=7)
    assert module._failing(time, turns, [], rolls, (0.1, 5.0)) is None
    assert module._failing(time, turns, [], ~told, usual) is None
    config = "behaviour: {pace: {schedule: [[2, 0], [6, 0.5], [9, 0]]}}"
    assert halts(changed(log, tmp_path, config=config)) == [(2.0, 6.0), (9.0, np.inf)]
    assert halts(log) == []


@pytest.mark.parametrize(
    ("criteria", "found"),
    [
        ("criteria: {stall_progress: 0.2, stall_time: 3}", (0.2, 3.0)),
        ("criteria: {roll: {stall_time: 2.5}}", (0.1, 2.5)),
        ("criteria: {stall_time: soon}", (0.1, 1.5)),
        ("criteria: {stall_progress: .nan, stall_time: 0}", (0.1, 1.5)),
        (f"criteria: {{stall_time: 1{400 * '0'}}}", (0.1, 1.5)),
        ("criteria: 3", (0.1, 1.5)),
    ],
)
def test_a_stall_is_what_the_criteria_of_the_run_say(criteria, found, log, tmp_path):
    assert stall(changed(log, tmp_path, config=criteria)) == found


@pytest.mark.parametrize(
    ("overrides", "told"),
    [
        (["disturbance=load", "disturbance.mass=5", "disturbance.time=0.3"], "chest takes up 5 kg"),
        (
            ["disturbance=slippery", "disturbance.friction=0.5", "disturbance.time=0.3"],
            "the ground has 0.5 of its friction",
        ),
        (["behaviour=forward_roll", "behaviour.pace.schedule=[[0.3,0.5]]"], "told 0.5 rev/s"),
        (["behaviour=forward_roll", "behaviour.pace.schedule=[[0.3,0]]"], "told to halt"),
        (
            ["behaviour=forward_roll", "+course=turn", "behaviour.course.schedule=[[0.3,12]]"],
            "told 12 deg/s",
        ),
        (["behaviour=forward_roll", "+finish=stand", "behaviour.finish.after=0.3"], "told to end"),
    ],
)
def test_what_happens_in_a_run_is_told_in_the_next_frame(overrides, told, tmp_path):
    made = run(load([*overrides, "duration=0.6"]), tmp_path)
    done = RunLog.open(made.folder / LOG_NAME)
    ((row, words),) = happenings(done)
    assert (row, words) == (18, f"0.30 s: {told}")
    rows = module._rows(done, 8, None, None)
    assert any(18 <= one < 24 for one in rows)
    first = min(one for one in rows if one >= 18)
    for one, moment in zip(rows, moments(done, rows), strict=True):
        assert moment.happened == ((words,) if one == first else ())
    (later,) = moments(done, [30])
    assert later.happened == ()
    (later,) = moments(done, [30], lasting=0.5)
    assert later.happened == (words,)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"frames": 0}, "frames is 0, valid: 1 to 200"),
        ({"frames": 201}, "frames is 201, valid: 1 to 200"),
        ({"columns": 0}, "columns is 0, valid: 1 to 12, the number of frames"),
        ({"frames": 3, "columns": 4}, "columns is 4, valid: 1 to 3, the number of frames"),
        ({"start": -1.0}, "start (--from) is -1 s, valid: 0 to 0.483333 s"),
        ({"end": 0.6}, "end (--to) is 0.6 s, valid: 0 to 0.483333 s"),
        ({"start": float("nan")}, "start (--from) is nan s, valid: 0 to 0.483333 s"),
        ({"start": 0.3, "end": 0.3}, "start (--from) is 0.3 s, valid: less than end = 0.3 s"),
        ({"start": 0.3, "end": 0.1}, "start (--from) is 0.3 s, valid: less than end = 0.1 s"),
    ],
)
@pytest.mark.usefixtures("drawing")
def test_bad_arguments_are_named_with_their_range(log, tmp_path, arguments, message):
    with pytest.raises(InputError) as caught:
        filmstrip(log, tmp_path / "strip.png", **arguments)
    assert str(caught.value) == message
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_not_there_is_named(log, picture):
    out = picture.parent / "nowhere" / "strip.png"
    with pytest.raises(InputError) as caught:
        filmstrip(log, out, frames=1)
    assert str(caught.value) == f"cannot write {out}: No such file or directory"


def test_a_model_that_names_files_is_refused(log, picture, tmp_path):
    hostile = log.model_xml.replace("<worldbody>", "<worldbody><include file='/etc/passwd'/>")
    with pytest.raises(LogError) as caught:
        filmstrip(changed(log, tmp_path, model_xml=hostile), picture)
    assert str(caught.value) == (
        f"{tmp_path / 'changed.h5'}: model/mjcf has <include>, which a log's model may not have"
    )
    assert not picture.exists()


def test_a_bogus_mujoco_gl_is_one_line(log, tmp_path):
    code = (
        "import sys; from pathlib import Path; from rotctl.errors import InputError\n"
        "from rotctl.log import RunLog; from rotctl.report.filmstrip import filmstrip\n"
        "try: filmstrip(RunLog.open(sys.argv[1]), Path(sys.argv[2]))\n"
        "except InputError as error: print(error)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(log.path), str(tmp_path / "strip.png")],
        env={**os.environ, "MUJOCO_GL": "bogus"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == (
        "MUJOCO_GL=bogus: no such OpenGL; valid: osmesa, egl, glfw, disable; "
        f"unset it to try {', '.join(gl._CANDIDATES)}\n"
    )
