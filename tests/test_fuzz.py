"""A few hostile inputs, and that whoever looks for faults would see one; see `make fuzz`."""

import os
import resource
import signal
import subprocess
import sys
import time
from types import SimpleNamespace

import pytest
from fuzz import child, kinds
from fuzz.giving import given, import_all
from fuzz.samples import make

INPUTS = 24
LITTLE = 2**27  # [bytes] in place of what an input may take, for tests that take it


@pytest.fixture(scope="module")
def samples(tmp_path_factory):
    import_all()
    return make(tmp_path_factory.mktemp("samples"), whole=False)


@pytest.fixture
def place(tmp_path, monkeypatch):
    """Folders for a case, and for what libraries write."""
    for name in ("TMPDIR", "MPLCONFIGDIR"):
        (tmp_path / name).mkdir()
        monkeypatch.setenv(name, str(tmp_path / name))
    monkeypatch.setenv("CANARY", "canary")
    return tmp_path


def test_a_few_inputs_find_nothing(samples, place):
    begin = resource.getrusage(resource.RUSAGE_CHILDREN)
    found = {}
    for number in range(INPUTS):
        became, case = given(samples, 0, number, place / str(number), kinds.CHEAP)
        if became.fault:
            found[number] = became.fault, case.argv, became.details
    assert found == {}
    end = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert end.ru_utime + end.ru_stime - begin.ru_utime - begin.ru_stime > 0.5  # they did run


def test_an_input_can_be_made_again(samples, tmp_path):
    made = []
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        for number in range(30):
            here = tmp_path / folder / str(number)
            here.mkdir()
            case = kinds.make(samples, 7, number, here, kinds.CHEAP)
            files = sorted(p for p in here.rglob("*") if p.is_file() and not p.is_symlink())
            content = [(str(p.relative_to(here)), p.stat().st_size) for p in files]
            made.append((case.argv, content))
    assert made[:30] == made[30:]


# ---------------------------------------------------------------- what would be seen


def trouble(*_):
    raise KeyError("x")


def asks_for_much(*_):
    return len(bytearray(3 * child.MEMORY)) * 0  # what it began with may be paged out meanwhile


def waits(*_):
    time.sleep(1000)


def computes(*_):
    while True:
        pass


def says(*lines, code=2):
    def call():
        print(*lines, sep="\n", file=sys.stderr)
        return code

    return call


def writes(path):
    def call():
        with open(path, "w"):
            return 0

    return call


def removes(path):
    def call():
        os.remove(path)
        return 0

    return call


def follows_no_link(*_):
    try:
        os.open("link", os.O_WRONLY | os.O_CREAT | os.O_NOFOLLOW)
    except OSError:
        return 0
    return 70


def crashes(*_):
    os.kill(os.getpid(), signal.SIGUSR1)


def starts(*_):
    subprocess.run(["true"], check=True)
    return 0


@pytest.mark.parametrize(
    ("command", "fault"),
    [
        (trouble, "KeyError"),
        (asks_for_much, "memory"),
        (computes, "hang"),
        (waits, "hang"),
        (crashes, "killed by SIGUSR1"),
        (starts, "starts true"),
        (says("no reason"), "no reason"),
        (says("rotctl: a", "rotctl: b"), "several reasons"),
        (says("RuntimeWarning: overflow", "rotctl: a"), "noise"),
        (says("rotctl: " + "a" * 9000), "noise"),
        (says("rotctl: the canary sings"), "canary"),
        (says(code=3), "exit code 3"),
        (writes("inside"), ""),
        (writes("../outside"), "open outside: {outside}"),
        (writes("link"), "open outside: {outside}"),
        (removes("../kept"), "os.remove outside: {kept}"),
        (removes("link"), ""),
        (follows_no_link, ""),
        (says("rotctl: one line"), ""),
        (says(code=0), ""),
    ],
)
def test_a_fault_is_seen(tmp_path, monkeypatch, command, fault):
    monkeypatch.setattr(child, "CPU", 1 if command is computes else 20)
    monkeypatch.setattr(child, "MEMORY", LITTLE)
    monkeypatch.setattr(child, "WALL", 0.5 if command is waits else 300.0)
    here = tmp_path / "in"
    here.mkdir()
    (tmp_path / "kept").touch()
    (here / "link").symlink_to(tmp_path / "outside")
    found = child.give(command, here, [here])
    names = SimpleNamespace(outside=tmp_path / "outside", kept=tmp_path / "kept")
    assert found.fault == fault.format(**vars(names))


def test_what_the_parent_holds_is_no_fault_of_the_child(tmp_path, monkeypatch):
    monkeypatch.setattr(child, "MEMORY", LITTLE)
    here = tmp_path / "in"
    here.mkdir()
    held = bytearray(b"x") * child.MEMORY
    found = child.give(says(code=0), here, [here])
    assert (found.fault, len(held)) == ("", child.MEMORY)
