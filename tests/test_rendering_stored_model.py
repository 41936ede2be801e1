"""A stranger's model is refused before MuJoCo sees it."""

import subprocess
import sys
from pathlib import Path

import pytest

from rotctl.errors import LogError
from rotctl.report import stored_model

BALL = "<body><freejoint/><geom size='1'/></body>"


def mjcf(inside="", world=""):
    return f"<mujoco>{inside}<worldbody>{BALL}{world}</worldbody></mujoco>"


def nested(depth):
    return mjcf(world="<body>" * depth + "</body>" * depth)


HEIGHTS = "<hfield name='h' nrow='1024' ncol='1024' size='1 1 1 1'/>"
PIXELS = "<texture name='q' type='2d' builtin='flat' width='1024' height='1024' rgb1='1 1 1'/>"
REFUSED = [
    (
        mjcf("<include file='/etc/passwd'/>"),
        "has <include>, which a log's model may not have",
    ),
    (
        mjcf("<asset><mesh name='m' file='/elsewhere/m.obj'/></asset>"),
        "has file='/elsewhere/m.obj' in <mesh>; a log's model stands alone",
    ),
    (
        mjcf("<asset><mesh name='m' builtin='sphere' params='4000'/></asset>"),
        "has a <mesh> of more than its corners",
    ),
    (
        mjcf(f"<asset><mesh name='m' vertex='{'1 ' * 100_001}'/></asset>"),
        "has more than 100000 numbers of corners",
    ),
    (
        mjcf("<extension><plugin plugin='x'/></extension>"),
        "has <extension>, which a log's model may not have",
    ),
    (
        mjcf(world="<replicate count='1000000000'><geom size='1'/></replicate>"),
        "has <replicate>, which a log's model may not have",
    ),
    (
        mjcf("<asset><texture name='t' type='2d' file='/dev/zero'/></asset>"),
        "has file='/dev/zero' in <texture>; a log's model stands alone",
    ),
    (
        mjcf("<asset><texture name='t' type='cube' fileright='a.png'/></asset>"),
        "has fileright='a.png' in <texture>; a log's model stands alone",
    ),
    (
        mjcf("<compiler meshdir='/root'/>"),
        "has meshdir='/root' in <compiler>; a log's model stands alone",
    ),
    (
        mjcf(
            "<asset><texture name='t' type='2d' builtin='flat' width='99999' height='9'/></asset>"
        ),
        "has width='99999' in <texture>, valid: 0 to 1024",
    ),
    (
        mjcf("<asset><hfield name='h' nrow='-1' ncol='9' size='1 1 1 1'/></asset>"),
        "has nrow='-1' in <hfield>, valid: 0 to 1024",
    ),
    (
        '<!DOCTYPE mujoco [<!ENTITY a "b">]><mujoco/>',
        "has a document type; a log's model needs none",
    ),
    # Each size is small; what they make together, and MuJoCo of them, is not.
    (
        mjcf(f"<asset>{HEIGHTS * 400}</asset>"),
        "has more than 1048576 heights and pixels",
    ),
    (
        mjcf(f"<asset>{PIXELS * 800}</asset>"),
        "has more than 1048576 heights and pixels",
    ),
    (
        mjcf("<asset><texture name='c' builtin='flat' width='512' height='1'/></asset>"),
        "has more than 1048576 heights and pixels",  # a cube's six faces
    ),
    (
        mjcf(world="<body><freejoint/><geom size='1'/></body>" * 170),
        "has more than 1000 degrees of freedom",
    ),
    (
        mjcf(world="<body><joint type='ball'/><geom size='1'/></body>" * 340),
        "has more than 1000 degrees of freedom",
    ),
    (mjcf(world="<body/>" * 2000), "has more than 2000 bodies"),
    (
        mjcf(world="<geom " + "".join(f"a{i}='' " for i in range(60)) + "/>"),
        "has more than 50 attributes in <geom>",
    ),
    ("<a/>" * 4_000_000, "has more than 20000 elements"),
    (nested(200), "is nested more than 100 deep"),
    (mjcf(world="<site/>" * 20_001), "has more than 20000 elements"),
    ("<mujoco>", "is not XML: no element found: line 1, column 8"),
    ("", "is not XML: no element found: line 1, column 0"),
]


@pytest.mark.parametrize(("text", "message"), REFUSED)
def test_what_a_log_has_no_use_for_is_refused(text, message):
    with pytest.raises(LogError) as caught:
        stored_model.checked(text)
    assert str(caught.value) == message


def test_mujoco_reads_only_what_was_checked():
    assert "include" not in stored_model.checked(mjcf("<!-- <include file='x'/> -->"))


class Stored:
    """As much of a log as `load` uses."""

    path = "run.h5"

    def __init__(self, text, nq):
        self.model_xml = text
        self.sizes = {"nq": nq, "nv": nq // 7 * 6}  # of free bodies


@pytest.mark.parametrize(
    ("text", "nq", "message"),
    [
        (
            mjcf("<include file='x'/>"),
            7,
            "has <include>, which a log's model may not have",
        ),
        (mjcf(), 8, "has nq = 7, the trajectory 8"),
        ("<mujoco/>", 0, "has nothing that moves"),
        (
            mjcf(world="<geom size='x'/>"),
            7,
            "does not compile: XML Error: bad format in attribute 'size' Element 'geom', line 1",
        ),
        (
            mjcf(world="<geom size='1' pos='nan 0 0'/>"),
            7,
            "does not compile cleanly: XML contains a 'NaN'. Please check it carefully.",
        ),
    ],
)
def test_a_model_that_does_not_fit_its_log_is_refused(text, nq, message):
    with pytest.raises(LogError) as caught:
        stored_model.load(Stored(text, nq))
    assert str(caught.value) == f"run.h5: model/mjcf {message}"


def test_mujoco_leaves_no_file_of_its_warnings(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(LogError):
        stored_model.load(Stored(mjcf(world="<geom type='box' size='nan 1 1' pos='nan 0 0'/>"), 7))
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr() == ("", "")


def test_the_largest_that_is_let_through_takes_less_than_a_gigabyte(tmp_path):
    """In a process of its own, whose memory is its own: getrusage tells the parent's, if larger."""
    heights = HEIGHTS.replace("1024", "1000")
    bodies = "<body><freejoint/><geom size='1'/></body>" * 160 + "<geom size='1'/>" * 19_000
    (tmp_path / "a.xml").write_text(mjcf(f"<asset>{heights}</asset>", bodies))
    script = (
        "import sys, headless, mujoco\n"
        "from test_rendering_stored_model import Stored\n"
        "from rotctl.report import stored_model\n"
        "model = stored_model.load(Stored(open(sys.argv[1]).read(), 1127))\n"
        "mujoco.MjData(model)\n"
        "held = [line for line in open('/proc/self/status') if line.startswith('VmHWM')]\n"
        "print(int(held[0].split()[1]) * 1024)"
    )
    command = [sys.executable, "-c", script, tmp_path / "a.xml"]
    finished = subprocess.run(command, capture_output=True, text=True, cwd=Path(__file__).parent)
    assert finished.stderr == ""
    assert int(finished.stdout) < 2**30


def test_velocities_must_fit_too():
    stored = Stored(mjcf(), 7)
    stored.sizes["nv"] = 7
    with pytest.raises(LogError, match=r"has nv = 6, the trajectory 7$"):
        stored_model.load(stored)


def test_a_sound_model_is_compiled():
    assert stored_model.load(Stored(mjcf(), 7)).ngeom == 1
