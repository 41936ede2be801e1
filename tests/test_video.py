"""A short run as a video, and the words where there is none."""

import re
import subprocess
import sys

import numpy as np
import pytest

from rotctl.cli.main import main
from rotctl.config.loading import load
from rotctl.errors import InputError
from rotctl.log import RunLog
from rotctl.report import encoder
from rotctl.report.video import FOOTER, FRAME, HEADER, video
from rotctl.runs.run import LOG_NAME, run


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    result = run(load(["seed=1", "duration=0.5"]), tmp_path_factory.mktemp("runs"))
    return RunLog.open(result.folder / LOG_NAME)


@pytest.fixture
def out(tmp_path, drawing):
    """Where to write, on a machine that can draw; CI must be one unless it says otherwise."""
    return tmp_path / "roll.mp4"


def frames_of(path):
    """All frames (n, height, width, 3)."""
    command = [encoder.executable(), "-loglevel", "error", "-i", path]
    command += ["-f", "rawvideo", "-pix_fmt", "rgb24", "pipe:1"]
    raw = subprocess.run(command, capture_output=True, check=True).stdout
    size = (HEADER + FRAME[1] + FOOTER, FRAME[0], 3)
    return np.frombuffer(raw, np.uint8).reshape(-1, *size).astype(int)


def test_it_is_an_mp4_whose_frames_move_under_a_sky(log, out):
    done = []
    video(log, out, progress=lambda i, of: done.append((i, of)))
    assert done == [(i + 1, 15) for i in range(15)]
    assert out.read_bytes()[4:8] == b"ftyp"
    said = subprocess.run([encoder.executable(), "-i", out], capture_output=True, text=True).stderr
    assert re.search(r"Video: h264 .* 640x480.* 30 fps", said)
    frames = frames_of(out)
    assert len(frames) == 15
    assert np.median(frames[:, HEADER + 4]) > 120  # sky, not black; an arrow may cross it
    assert frames[:, :HEADER].min() < 90  # words
    assert np.abs(frames[0] - frames[-1]).mean() > 1.0
    assert [path.name for path in out.parent.iterdir()] == [out.name]


def test_a_window_is_shorter(log, out):
    video(log, out, start=0.1, end=0.2)
    assert len(frames_of(out)) == 4


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"start": -1.0}, "start (--from) is -1 s, valid: 0 to 0.483333 s"),
        ({"end": 9.0}, "end (--to) is 9 s, valid: 0 to 0.483333 s"),
        ({"start": 0.3, "end": 0.2}, "start (--from) is 0.3 s, valid: less than end = 0.2 s"),
    ],
)
def test_bad_times_are_named_with_their_range(log, tmp_path, arguments, message):
    with pytest.raises(InputError) as caught:
        video(log, tmp_path / "roll.mp4", **arguments)
    assert str(caught.value) == message
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_not_there_is_named(log, out):
    wrong = out.parent / "nowhere" / "roll.mp4"
    with pytest.raises(InputError) as caught:
        video(log, wrong)
    assert str(caught.value) == f"cannot write {wrong}: No such file or directory"


def test_without_an_encoder_the_extra_is_named(log, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    monkeypatch.setattr(encoder.shutil, "which", lambda name: None)
    with pytest.raises(InputError) as caught:
        video(log, tmp_path / "roll.mp4")
    assert str(caught.value) == (
        "cannot make a video: no ffmpeg here; "
        "pip install 'rotctl[video]', or on Debian: apt-get install ffmpeg"
    )


def test_what_the_encoder_complains_of_is_said(tmp_path):
    liar = tmp_path / "ffmpeg"
    liar.write_text("#!/bin/sh\necho no room >&2\nexit 3\n")
    liar.chmod(0o755)

    def encode():
        with encoder.encoding(str(liar), tmp_path / "x.mp4", (2, 2), 30.0) as stream:
            for _ in range(100_000):
                stream.write(bytes(12))

    with pytest.raises(InputError) as caught:
        encode()
    assert str(caught.value) == "cannot make a video: ffmpeg says: no room"


def test_render_wants_at_least_one_of_both(log, capsys):
    assert main(["render", str(log.path)]) == 2
    assert capsys.readouterr() == (
        "",
        "rotctl: nothing to draw: give --filmstrip OUT.png, --video OUT.mp4 or both\n",
    )


def test_render_makes_both(log, out, capsys):
    strip = out.with_suffix(".png")
    window = ["--from", "0.1", "--to", "0.2", "--frames", "2"]
    assert (
        main(["render", str(log.path), "--filmstrip", str(strip), "--video", str(out), *window])
        == 0
    )
    assert capsys.readouterr().out == f"{strip}\n{out}\n"
    assert strip.stat().st_size > 10_000
    assert out.stat().st_size > 1000
